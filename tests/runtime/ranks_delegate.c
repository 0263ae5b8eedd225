/* Tasks that run on other ranks than their own: which of them may, what comes back, failures, waits
 * inside, and who asks how often. All objects of a case live on one rank. */

#include "tests/negative/misuse.h"
#include "tests/runtime/delegation.h"
#include "tests/support/ranks.h"

#include <stdatomic.h>
#include <string.h>
#include <time.h>

enum { MOST = 50 };

static atomic_int ran[4]; /* on this rank: plain, pinned, stays, files */

KERNEL(PLAIN, "plain", .access = {DUITE_RW}, .args_size = sizeof(int32_t))
{
    atomic_fetch_add(&ran[*(const int32_t *)call->args], 1);
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}
static const duite_kernel STAYS = {.name = "stays",
                                   .body = PLAIN_body,
                                   .access = {DUITE_RW},
                                   .args_size = sizeof(int32_t),
                                   .fixed = 1};
static const duite_kernel FILES = {.name = "files",
                                   .body = PLAIN_body,
                                   .access = {DUITE_RW},
                                   .args_size = sizeof(int32_t),
                                   .side_effects = 1};

KERNEL(SHRINK, "shrink", .access = {DUITE_W})
{
    return duite_resize(call, 0, duite_count(call, 0) == MOST ? 0 : 1);
}

/* Forks children of its own, waits for them, and tells what they left. */
KERNEL(PARENT, "parent", .access = {DUITE_RW})
{
    duite_object own;
    int32_t value = 0;

    duite_new(call->rt, DUITE_I32, 1, &own);
    for (int32_t i = 0; i < 3; i++)
        DUITE_FORK(call->rt, &PLAIN, DUITE_ARGS(int32_t, 0), own);
    const int code = duite_get(call->rt, own, &value);

    duite_out(call, 0, int32_t)[0] += value;
    return code;
}

/* Its child fails, which it does not care about. */
KERNEL(CARELESS, "careless", .access = {DUITE_RW})
{
    duite_object own;

    duite_new(call->rt, DUITE_I32, 1, &own);
    DUITE_FORK(call->rt, &FAIL, DUITE_ARGS(int32_t, 23), own);
    duite_out(call, 0, int32_t)[0] = 5;
    return 0;
}

/* A tree: the first leaf forked fails with 31, a later one with 32. */
KERNEL(TREE, "tree", .access = {DUITE_RWP})
{
    const duite_object lent = call->param[0].object;

    DUITE_FORK(call->rt, &PLAIN, DUITE_ARGS(int32_t, 0), lent);
    DUITE_FORK(call->rt, &FAIL, DUITE_ARGS(int32_t, 31), lent);
    const int told = duite_wait(call->rt);
    duite_set(call->rt, lent, &(int32_t){told});
    DUITE_FORK(call->rt, &FAIL, DUITE_ARGS(int32_t, 32), lent);
    return 0;
}

KERNEL(DOZE, "doze", .access = {DUITE_CW})
{
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

static const duite_kernel *const LIST[] = {&MIX,    &PLAIN, &STAYS,  &FILES,    &GROW,
                                           &SHRINK, &FAIL,  &PARENT, &CARELESS, &TREE,
                                           &DOZE,   &SET,   &COPY,   NULL};

static duite *start(const char *balance)
{
    for (int i = 0; i < 4; i++)
        atomic_store(&ran[i], 0);
    return delegation_start(LIST, balance);
}

static void mix_and_parent(duite *rt, int32_t number, const duite_object object[4])
{
    duite_fork(rt, &MIX, &number, 4, object);
    DUITE_FORK(rt, &PARENT, NULL, object[1]);
}

static void values(const char *balance)
{
    duite *rt = start(balance);
    delegation_values(rt, balance, &(struct delegation_values){mix_and_parent, 7 + 3, 1, 1, NULL});
    delegation_say(balance, "stop", duite_stop(&rt) == DUITE_OK);
}

/* Tasks that must not move do not. */
static void pinned(void)
{
    duite *rt = start("scatter");
    duite_object object = misuse_new(rt, 1);
    const int here = duite_home(rt, object) == rank;

    for (int i = 0; i < TASKS; i++) {
        duite_fork_at(rt, duite_home(rt, object), &PLAIN, &(int32_t){1}, 1, &object);
        DUITE_FORK(rt, &STAYS, DUITE_ARGS(int32_t, 2), object);
        DUITE_FORK(rt, &FILES, DUITE_ARGS(int32_t, 3), object);
    }
    tap_case(delegation_value(rt, object) == 3 * TASKS, "all ran");
    tap_case((atomic_load(&ran[1]) > 0) == here, "tasks whose fork names a rank run there");
    tap_case((atomic_load(&ran[2]) > 0) == here, "a kernel that stays stays");
    tap_case((atomic_load(&ran[3]) > 0) == here, "and one with side effects");
    tap_case(delegation_count(rt) == 0, "and nothing is counted");
    duite_free(rt, object);
    duite_stop(&rt);
}

static void sizes(void)
{
    duite *rt = start("scatter");
    duite_object object;
    int32_t value[MOST];
    size_t count = 0;

    duite_new_sized(rt, DUITE_I32, 0, MOST, &object);
    for (int i = 0; i < TASKS; i++)
        DUITE_FORK(rt, &GROW, NULL, object);
    int code = duite_get_count(rt, object, &count);
    tap_case(!code && count == TASKS && !duite_get(rt, object, value) && value[TASKS - 1] == TASKS,
             "sizes come home");
    DUITE_FORK(rt, &SHRINK, NULL, object);
    tap_case(!duite_get_count(rt, object, &count) && count == 0, "nothing, too");
    for (int i = 0; i < MOST + 2; i++)
        DUITE_FORK(rt, &GROW, NULL, object);
    tap_case(duite_get(rt, object, value) == DUITE_E_SIZE, "too large a size is an error");
    duite_free(rt, object);
    duite_wait(rt);
    duite_stop(&rt);
}

/* Poisoned tasks of the main program. */
static void poison(void)
{
    duite *rt = start("scatter");
    duite_object a = misuse_new(rt, 1), b = delegation_beside(rt, a);

    for (int32_t i = 0; i < TASKS; i++) {
        DUITE_FORK(rt, &FAIL, DUITE_ARGS(int32_t, 10 + i), a);
        DUITE_FORK(rt, &PLAIN, DUITE_ARGS(int32_t, 0), a);
        DUITE_FORK(rt, &COPY, NULL, a, b);
        DUITE_FORK(rt, &PLAIN, DUITE_ARGS(int32_t, 0), b);
    }
    tap_case(duite_get(rt, b, &(int32_t){0}) == 10, "poison comes home");
    tap_case(strstr(duite_message(), "task 1 (kernel fail)") &&
                 strstr(duite_message(), "sentence 10 of a body"),
             "with its sentence");
    tap_case(duite_wait(rt) == 10, "a wait tells the first failure");
    DUITE_FORK(rt, &SET, &(int32_t){4}, a);
    tap_case(delegation_value(rt, a) == 4, "a w clears it");
    duite_free(rt, a);
    duite_free(rt, b);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop after failures");
}

/* The same of children, of guests and of tasks that stay. */
static void children(void)
{
    duite *rt = start("scatter");
    duite_object a = misuse_new(rt, 1);
    int right = 1;

    for (int i = 0; i < TASKS; i++)
        DUITE_FORK(rt, &CARELESS, NULL, a);
    tap_case(delegation_value(rt, a) == 5, "a child's failure is not its parent's");
    tap_case(duite_wait(rt) == 23 && strstr(duite_message(), "task 1.1 (kernel fail)"),
             "but a wait tells it, with its place");
    tap_case(duite_wait(rt) == DUITE_OK, "once");
    for (int i = 0; i < TASKS; i++) {
        duite_set(rt, a, NULL);
        DUITE_FORK(rt, &TREE, NULL, a);
        right &= duite_wait(rt) == 31;
        right &= duite_get(rt, a, &(int32_t){0}) == 32;
    }
    tap_case(right, "in a tree the first is told, and each to who asks for it");
    DUITE_FORK(rt, &SET, &(int32_t){4}, a);
    duite_free(rt, a);
    duite_stop(&rt);
}

/* One rank has pinned work for 0.2 s, all others have nothing to do. */
static uint64_t messages_of_idling(const char *balance)
{
    duite *rt = start(balance);
    duite_object object = misuse_new(rt, 1);
    duite_counters counters = {0};

    for (int i = 0; i < 100; i++)
        duite_fork_at(rt, duite_home(rt, object), &DOZE, NULL, 1, &object);
    duite_wait(rt);
    duite_count_all(rt, &counters);
    duite_free(rt, object);
    duite_stop(&rt);
    return counters.messages;
}

/* Leaves of 2 ms on one rank: others take some of them. On a busy machine they may all ask too
 * late, so there are rounds of leaves until one was taken. */
static void given(void)
{
    enum { ROUNDS = 50, LEAVES = 100 };
    duite *rt = start("delegate");
    duite_object object = misuse_new(rt, 1);
    const int others = duite_ranks(rt) > 1;
    int right = 1, taken = 0;

    for (int round = 1; round == 1 || (others && !taken && round <= ROUNDS); round++) {
        for (int i = 0; i < LEAVES; i++)
            DUITE_FORK(rt, &DOZE, NULL, object);
        right &= delegation_value(rt, object) == round * LEAVES;
        taken = delegation_count(rt) > 0;
    }
    tap_case(right, "delegate: all ran");
    tap_case(taken == others, "delegate: idle ranks got some");
    duite_free(rt, object);
    duite_stop(&rt);
}

/* The ranks go different ways while tasks are away. */
static void different(void)
{
    duite *rt = start("scatter");
    duite_object a = misuse_new(rt, 1), b = delegation_beside(rt, a);
    const int alone = duite_ranks(rt) == 1;

    for (int32_t i = 0; i < TASKS; i++)
        DUITE_FORK(rt, &MIX, &i, a, b, misuse_new(rt, 1), misuse_new(rt, 1));
    if (rank == 0)
        DUITE_FORK(rt, &PLAIN, DUITE_ARGS(int32_t, 0), a);
    tap_case(alone || duite_wait(rt) == DUITE_E_DIFFERENT, "different programs are found");
    tap_case((duite_stop(&rt) != DUITE_OK) && !rt, "and stop ends");
}

RANKS_CASE(delegate)
{
    misuse_mpi();
    values("none");
    values("scatter");
    pinned();
    sizes();
    poison();
    children();
    tap_case(messages_of_idling("none") == 0, "without a balancer nobody asks");
    tap_case(messages_of_idling("delegate") <= 2000, "idle ranks ask ever less often");
    given();
    different();
    return tap_done();
}
