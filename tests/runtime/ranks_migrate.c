/* Objects that move between replays: what a balancer is shown of them, what moves and what stays.
 */

#include "tests/runtime/moving.h"
#include "tests/support/ranks.h"

#include <stdlib.h>
#include <string.h>

enum { LARGE = 1 << 18, N_LARGE = 20 };

/* ---- What it is shown ---- */

struct ring {
    duite_object lead[16], follower[16];
};

static int build_ring(duite *rt, void *context)
{
    const duite_object *lead = ((struct ring *)context)->lead;

    for (int i = 0; i < 2 * ranks; i++)
        DUITE_FORK(rt, &DOZE, NULL, lead[i], lead[(i + 1) % (2 * ranks)]);
    return 0;
}

/* A loaded machine takes any time. */
static int took(double seconds, int bodies)
{
    return seconds > 0.0019 * bodies && seconds < 2 * bodies;
}

/* A replay of three rounds, and a task by hand for the last block and one at the last rank. */
static int is_right(void)
{
    const int n = 2 * ranks;

    if (seen.blocks.graph.n != (size_t)n || seen.blocks.n_ranks != ranks ||
        seen.blocks.replays != 1 || seen.blocks.since != 1 || seen.blocks.seconds <= 0 ||
        seen.blocks.byte_seconds <= 0 || !took(seen.other[ranks - 1], 1) ||
        (ranks > 2 && seen.other[1] > 0) || strcmp(seen.blocks.mapping->name, "cyclic") != 0)
        return 0;
    for (int i = 0; i < n; i++) {
        const int next = (i + 1) % n, before = (i + n - 1) % n;
        if (!took(seen.weight[i], i == n - 1 ? 4 : 3) || seen.bytes[i] != 4 * (100 + 7) ||
            seen.home[i] != i % ranks || seen.fixed[i] != (i == 1))
            return 0;
        for (int k = 0; k < n; k++)
            if (seen.edge[i][k] != (k == next || k == before) * 3 * 400.0)
                return 0;
    }
    return 1;
}

static void shown(void)
{
    duite *rt = moving_start(&TOLD);
    struct ring ring;
    const int n = 2 * ranks;
    duite_graph graph, unused;

    for (int i = 0; i < n; i++)
        ring.lead[i] = misuse_new(rt, 100);
    for (int i = 0; i < n; i++) {
        ring.follower[i] = misuse_new(rt, 7);
        duite_colocate(rt, ring.follower[i], ring.lead[i]);
    }
    duite_object gone = misuse_new(rt, 1000), alone = misuse_new(rt, 1000);

    duite_colocate(rt, gone, ring.lead[0]);
    duite_graph_new(rt, build_ring, &ring, &graph);
    duite_graph_new(rt, build_ring, &ring, &unused); /* what is not replayed carries nothing */
    seen.calls = 0;
    duite_replay(rt, graph, 3);
    DUITE_FORK(rt, &STAYS, NULL, ring.follower[1], ring.follower[2 % n]);
    DUITE_FORK(rt, &PARENT, NULL, ring.follower[n - 1], ring.follower[0]);
    duite_fork_at(rt, ranks - 1, &DOZE, NULL, 1, &ring.follower[0]);
    duite_free(rt, gone);
    duite_free(rt, alone);
    duite_replay(rt, unused, 1);
    tap_case(rank != 0 || seen.calls == (ranks > 1), "the second replay asks");
    tap_case(rank != 0 || ranks == 1 || is_right(), "it shows what was measured of each block");
    for (int i = 0; i < n; i++) {
        duite_free(rt, ring.lead[i]);
        duite_free(rt, ring.follower[i]);
    }
    duite_graph_free(rt, graph);
    moving_end(rt, unused, "stops");
}

/* ---- What moves ---- */

/* Objects that are only read from now on. */
static void memory(void)
{
    duite *rt = moving_start(&TOLD);
    const duite_graph nothing = moving_begin(rt);
    const double all = 4e-6 * LARGE * N_LARGE;
    duite_object large[N_LARGE];

    duite_wait(rt);
    const double before = misuse_megabytes();

    for (int i = 0; i < N_LARGE; i++) {
        large[i] = misuse_new(rt, LARGE);
        duite_colocate(rt, large[i], large[0]);
        duite_fork(rt, &SET, &(int32_t){i}, 1, &large[i]);
    }
    duite_wait(rt);
    const int home = duite_home(rt, large[0]), next = (home + 1) % ranks;

    tap_case(rank != home || before <= 0 || misuse_megabytes() - before > 0.9 * all,
             "a home has them");
    moving(rt, nothing, next);
    duite_wait(rt);
    const double now = misuse_megabytes() - before;
    int right = 1;

    tap_case(duite_home(rt, large[N_LARGE - 1]) == next, "they have moved with their leader");
    tap_case(rank != next || before <= 0 || now > 0.9 * all, "the new home has them");
    tap_case(rank == next || now < 0.1 * all, "and the old one has not");
    tap_case(rank == next || duite_is_local(rt, large[3]) == 0, "and is not touched by them");
    for (int i = 0; i < N_LARGE; i++) {
        int32_t *values = calloc(LARGE, sizeof *values);

        right &= !duite_get_at(rt, large[i], 0, values);
        for (int k = 0; k < LARGE && rank == 0; k++)
            right &= values[k] == i;
        free(values);
    }
    tap_case(right, "their values are the same");
    tap_case(migrated(rt) == (ranks > 1) * N_LARGE, "they are counted");
    for (int i = 0; i < N_LARGE; i++)
        duite_free(rt, large[i]);
    moving_end(rt, nothing, "nothing is left");
}

/* Tasks run where their object lives now; those that name a rank, there. */
static void owners(void)
{
    duite *rt = moving_start(&TOLD);
    const duite_graph nothing = moving_begin(rt);
    struct things things = {.kernel = &STEP, .at = -1, .n = 2, .tasks = 3};

    for (int i = 0; i < 2; i++)
        things.object[i] = misuse_new(rt, 1);
    const duite_graph free_graph = moving_record(rt, things);

    things.at = 0;
    const duite_graph pinned = moving_record(rt, things);
    int right = 1, expected = 0, steps = 0;

    for (int turn = 0; turn < 3 * ranks; turn++) {
        moving(rt, nothing, NEXT);
        const int home = duite_home(rt, things.object[0]);

        duite_replay(rt, free_graph, 2);
        duite_fork(rt, &STEP, NULL, 2, things.object);
        duite_replay(rt, pinned, 1);
        expected += (rank == home) * 7 + (rank == 0) * 3;
        steps += 10;
        if (turn % 2)
            right &= value_of(rt, things.object[0]) == steps;
    }
    duite_wait(rt);
    tap_case(atomic_load(&ran) == expected, "tasks run where their objects have moved to");
    tap_case(right && value_of(rt, things.object[0]) == steps, "and do the same there");
    duite_free(rt, things.object[0]);
    duite_free(rt, things.object[1]);
    duite_graph_free(rt, free_graph);
    duite_graph_free(rt, pinned);
    moving_end(rt, nothing, "stops");
}

/* Objects of tasks that must stay do so: forked, recorded, or bound. */
static void staying(void)
{
    duite *rt = moving_start(&TOLD);
    const duite_graph nothing = moving_begin(rt);
    struct things things = {.kernel = &STAYS, .at = -1, .n = 2, .tasks = 1};
    duite_object object[6];
    int home[6], right = 1;

    for (int i = 0; i < 6; i++)
        object[i] = misuse_new(rt, 1);
    for (int i = 0; i < 6; i++)
        home[i] = duite_home(rt, object[i]);
    duite_fork(rt, &STAYS, NULL, 2, object);
    things.object[0] = object[2];
    things.object[1] = object[3];
    const duite_graph graph = moving_record(rt, things);

    duite_graph_bind(rt, graph, object[2], object[4]);
    moving(rt, nothing, NEXT);
    for (int i = 0; i < 6; i++)
        right &= duite_home(rt, object[i]) == (i % 2 ? (home[i] + 1) % ranks : home[i]);
    tap_case(right, "what must stay is not moved");
    tap_case(moving(rt, nothing, FORCED) == (ranks > 1 ? DUITE_E_ARGUMENT : DUITE_OK),
             "a balancer cannot make it");
    tap_case(duite_wait(rt) == (ranks > 1 ? DUITE_E_ARGUMENT : DUITE_OK),
             "which is told once more");
    tap_case(moving(rt, nothing, WRONG) == (ranks > 1 ? DUITE_E_ARGUMENT : DUITE_OK),
             "nor move anything to no rank");
    duite_wait(rt);
    tap_case(duite_home(rt, object[1]) == (home[1] + 1) % ranks, "then nothing moves");
    for (int i = 0; i < 6; i++)
        duite_free(rt, object[i]);
    duite_graph_free(rt, graph);
    moving_end(rt, nothing, "stops");
}

/* ---- The balancer itself ---- */

/* All that takes time belongs to objects of rank 0. */
static void balanced(void)
{
    enum { OBJECTS = 8, LEAST = 20, MOST = 1500 }; /* on a busy machine looks are dear, and rare */
    duite *rt = moving_start(duite_balancer_find("migrate"));
    struct things things = {.kernel = &DOZE, .at = -1, .n = 1, .tasks = 1};
    duite_object object[OBJECTS * 16];
    duite_graph graph[OBJECTS];
    int moved = 0, right = 1, replays = 0;

    for (int i = 0; i < OBJECTS * ranks; i++)
        object[i] = misuse_new(rt, 1);
    for (int i = 0; i < OBJECTS; i++) {
        things.object[0] = object[i * ranks];
        right &= duite_home(rt, things.object[0]) == 0;
        graph[i] = moving_record(rt, things);
    }
    for (; replays < LEAST || (ranks > 1 && !moved && replays < MOST); replays++)
        for (int i = 0; i < OBJECTS; i++) {
            duite_replay(rt, graph[i], 1);
            moved += duite_home(rt, object[i * ranks]) != 0;
        }
    for (int i = 0; i < OBJECTS; i++)
        right &= value_of(rt, object[i * ranks]) == replays;
    tap_case(right, "work that moves is done");
    tap_case(ranks == 1 ? !moved : moved > 0 && migrated(rt) > 0, "and does move");
    for (int i = 0; i < OBJECTS * ranks; i++)
        duite_free(rt, object[i]);
    for (int i = 1; i < OBJECTS; i++)
        duite_graph_free(rt, graph[i]);
    moving_end(rt, graph[0], "stops");
}

RANKS_CASE(migrate)
{
    misuse_mpi();
    shown();
    memory();
    owners();
    staying();
    balanced();
    return tap_done();
}
