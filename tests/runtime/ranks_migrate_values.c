/* Objects that move between replays have the values, contributions and failures that they would
 * have if they stayed. */

#include "tests/runtime/delegation.h"
#include "tests/runtime/moving.h"
#include "tests/support/ranks.h"

#include <string.h>

/* Contributions that are open when their object moves combine as if it had not. */
static void contributions(void)
{
    duite *rt = moving_start(&TOLD);
    const duite_graph nothing = moving_begin(rt);
    duite_object object[2];
    float value[2] = {1, 2};

    for (int i = 0; i < 2; i++)
        duite_new(rt, DUITE_F32, 1, &object[i]);
    for (int i = 0; i < 2; i++) { /* the first moves in between */
        for (int32_t k = 3; k < 20; k++) {
            duite_fork_at(rt, k % ranks, &THIRD, &k, 1, &object[i]);
            if (!i && k % 5 == 0)
                moving(rt, nothing, NEXT);
        }
        duite_get(rt, object[i], &value[i]);
    }
    tap_case(!memcmp(&value[0], &value[1], sizeof value[0]), "open contributions");
    duite_free(rt, object[0]);
    duite_free(rt, object[1]);
    moving_end(rt, nothing, "stops");
}

/* Poison, sizes, zeros. */
static void values(void)
{
    duite *rt = moving_start(&TOLD);
    const duite_graph nothing = moving_begin(rt);
    duite_object poisoned = misuse_new(rt, 1), fresh = misuse_new(rt, 1), sized;
    size_t count = 0;

    duite_new_sized(rt, DUITE_I32, 0, 10, &sized);
    DUITE_FORK(rt, &FAIL, DUITE_ARGS(int32_t, 17), poisoned);
    for (int i = 0; i < 4; i++) {
        DUITE_FORK(rt, &GROW, NULL, sized);
        tap_case(value_of(rt, fresh) == 0, "what nobody has written");
        moving(rt, nothing, NEXT);
    }
    tap_case(!duite_get_count(rt, sized, &count) && count == 4, "sizes");
    tap_case(duite_get(rt, poisoned, &(int32_t){0}) == 17, "poison");
    tap_case(duite_wait(rt) == 17, "whose failure is told");
    moving(rt, nothing, NEXT);
    tap_case(duite_wait(rt) == DUITE_OK && duite_get(rt, poisoned, &(int32_t){0}) == 17,
             "once, while the poison stays");
    duite_free(rt, poisoned);
    duite_free(rt, fresh);
    duite_free(rt, sized);
    moving_end(rt, nothing, "stops");
}

/* Replays with a flag, of which the flag moves, too. */
static void flags(void)
{
    duite *rt = moving_start(&TOLD);
    duite_object flag = misuse_new(rt, 1);
    const duite_graph graph = moving_record(
        rt, (struct things){{flag}, .kernel = &COUNTDOWN, .at = -1, .n = 1, .tasks = 1});
    uint64_t rounds = 0;
    int right = 1;

    for (int32_t i = 3; i < 9; i++) {
        DUITE_FORK(rt, &SET, &i, flag);
        wanted = NEXT;
        duite_replay_while(rt, graph, flag, 100);
        right &= !duite_graph_rounds(rt, graph, &rounds) && rounds == (uint64_t)i;
    }
    tap_case(right, "flags");
    tap_case(migrated(rt) == (ranks > 1) * 5, "which move at each replay but the first");
    duite_free(rt, flag);
    moving_end(rt, graph, "stops");
}

RANKS_CASE(migrate_values)
{
    misuse_mpi();
    contributions();
    values();
    flags();
    return tap_done();
}
