/* A scheduler is told of each task what its fork said and which worker has its data warm. Some also
 * know paths to the end of a graph, or distances in the machine. Those that break the rules are
 * named. */
#include "tests/negative/misuse.h"
#include "tests/runtime/passive.h"
#include "tests/support/unit.h"

#include <duite_policy.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

enum { TASKS = 30 };

static int order[TASKS], n_ran; /* the tasks' numbers as they ran */

KERNEL(NOTE, "note", .access = {DUITE_W}, .args_size = sizeof(int))
{
    order[n_ran++] = *(const int *)call->args;
    return 0;
}

/* As long as data need to be worth staying with. */
KERNEL(LONG, "long", .access = {DUITE_W})
{
    struct timespec begin, now;
    (void)call;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    do
        clock_gettime(CLOCK_MONOTONIC, &now);
    while ((double)(now.tv_sec - begin.tv_sec) + 1e-9 * (double)(now.tv_nsec - begin.tv_nsec) <
           1e-5);
    return 0;
}

static duite *start(const struct duite_scheduler *scheduler, unsigned threads)
{
    static const duite_kernel *const KERNELS[] = {&NOTE, &LONG, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    n_ran = 0;
    options.kernels = KERNELS;
    options.scheduler = scheduler;
    options.threads = threads;
    duite *rt = misuse_start_with(&options);
    ck_assert_ptr_nonnull(rt);
    return rt;
}

/* ---- What one is told ---- */

/* It keeps the last of it. */
static duite_ready told[8];
static unsigned n_told;

static unsigned listen(void *state, const duite_ready *task)
{
    (void)state;
    told[n_told++ % 8] = *task;
    return 0;
}

static const duite_scheduler LISTENING = {.size = sizeof(duite_scheduler),
                                          .name = "listening",
                                          .summary = "for tests",
                                          .place = listen,
                                          .serve = passive_serve,
                                          .victim = passive_victim,
                                          .chain = passive_chain};

/* Four forks that say more and more of themselves. */
static int build_told(duite *rt, void *context)
{
    const duite_object *a = context;
    const int here = 0;

    duite_fork(rt, &NOTE, &here, 1, a);
    duite_fork_with(rt, NULL, &NOTE, &here, 1, a);
    duite_fork_with(rt, &(duite_task_options){.priority = -7, .cost = -1}, &NOTE, &here, 1, a);
    duite_fork_with(rt, &(duite_task_options){.at = &here, .priority = INT32_MAX, .cost = 2.5},
                    &NOTE, &here, 1, a);
    return 0;
}

static void check_told(const duite_ready *ready)
{
    static const int32_t PRIORITY[] = {0, 0, -7, INT32_MAX};
    static const double COST[] = {0, 0, 0, 2.5};

    for (int i = 0; i < 4; i++) {
        ck_assert_str_eq(ready[i].kernel, "note");
        ck_assert_int_eq(ready[i].priority, PRIORITY[i]);
        ck_assert_double_eq(ready[i].cost, COST[i]);
    }
}

UNIT_TEST(what_is_said)
{
    duite *rt = start(&LISTENING, 1);
    int32_t value;
    duite_object a = misuse_new(rt, 1);
    duite_graph graph;

    n_told = 0;
    ck_assert_int_eq(build_told(rt, &a), 0);
    ck_assert_int_eq(duite_get(rt, a, &value), DUITE_OK);
    ck_assert_uint_eq(n_told, 5);
    check_told(told);
    ck_assert_str_eq(told[4].kernel, "duite_get");
    for (int i = 0; i < 5; i++)
        ck_assert_uint_eq(told[i].affinity, 0);
    ck_assert_int_eq(told[4].priority, INT32_MAX);
    ck_assert_double_eq(told[4].cost, 0);
    n_told = 0;
    ck_assert_int_eq(duite_graph_new(rt, build_told, &a, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 1), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_uint_eq(n_told, 5);
    ck_assert_str_eq(told[0].kernel, "duite_replay");
    check_told(told + 1);
    duite_free(rt, a);
    duite_graph_free(rt, graph);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

static int build_warm(duite *rt, void *context)
{
    return duite_fork(rt, &LONG, NULL, 1, context);
}

UNIT_TEST(what_is_warm)
{
    duite *rt = start(&LISTENING, 1);
    duite_object a = misuse_new(rt, 1);
    duite_graph graph;

    n_told = 0;
    ck_assert_int_eq(duite_graph_new(rt, build_warm, &a, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 3), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_uint_eq(n_told, 4);
    for (unsigned i = 0; i < n_told; i++)
        ck_assert_uint_eq(told[i].affinity, i > 1); /* after the first round, worker 0 */
    duite_free(rt, a);
    duite_graph_free(rt, graph);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* ---- The longest path ---- */

/* Twenty short tasks, then a chain of three; a task that costs more than the first two of the chain
 * together, but less than all of it; and one that says nothing and counts as the mean. */
static int build_chain(duite *rt, void *context)
{
    const duite_object *object = context;

    for (int i = 0; i < 20; i++)
        duite_fork_with(rt, &(duite_task_options){.cost = 1}, &NOTE, &i, 1, &object[i]);
    for (int i = 20; i < 23; i++)
        duite_fork_with(rt, &(duite_task_options){.cost = 10}, &NOTE, &i, 1, &object[20]);
    duite_fork_with(rt, &(duite_task_options){.cost = 25}, &NOTE, &(int){23}, 1, &object[21]);
    return duite_fork(rt, &NOTE, &(int){24}, 1, &object[22]);
}

/* Under `priority` one worker takes the chain first, though it was forked last. */
UNIT_TEST(longest_path_first)
{
    static const int EXPECTED[] = {20, 23, 21, 22, 24, 0, 1, 2};
    duite *rt = start(duite_scheduler_find("priority"), 1);
    duite_object object[23];
    duite_graph graph;

    for (int i = 0; i < 23; i++)
        object[i] = misuse_new(rt, 1);
    ck_assert_int_eq(duite_graph_new(rt, build_chain, object, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 1), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(n_ran, 25);
    for (int i = 0; i < 8; i++)
        ck_assert_int_eq(order[i], EXPECTED[i]);
    for (int i = 0; i < 23; i++)
        duite_free(rt, object[i]);
    duite_graph_free(rt, graph);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* ---- Distances ---- */

/* The first ring is tried before the second, each from a random one on. */
UNIT_TEST(nearest_first)
{
    static const unsigned WORKER[] = {2, 4, 5, 0, 1}, DISTANCE[] = {1, 1, 1, 3, 3};
    const struct duite_scheduler *s = duite_scheduler_find("locality");
    void *state = calloc(1, s->state_size);
    unsigned firsts = 0;

    s->start(state, 3, 6, 1);
    s->locate(state, &(duite_near){5, WORKER, DISTANCE});
    for (int round = 0; round < 50; round++) {
        unsigned seen = 0, victim = 0;

        for (unsigned attempt = 0; attempt < 5; attempt++) {
            victim = s->victim(state, attempt);
            ck_assert_uint_eq(victim == 0 || victim == 1, attempt >= 3);
            ck_assert_uint_eq(seen & 1u << victim, 0);
            seen |= 1u << victim;
            firsts |= attempt ? 0 : 1u << victim;
        }
        ck_assert_uint_eq(s->victim(state, 5), DUITE_NO_QUEUE);
    }
    ck_assert_uint_eq(firsts, 1u << 2 | 1u << 4 | 1u << 5);
    free(state);
}

/* ---- Schedulers that do not keep to the rules ---- */

static unsigned nowhere(void *state, const duite_ready *task)
{
    (void)state;
    return 77 + (unsigned)task->number;
}

static duite_end no_end(void *state)
{
    (void)state;
    return (duite_end)99;
}

static unsigned always(void *state, unsigned attempt)
{
    (void)state;
    return attempt % 2;
}

/* Queues that there are not, and rounds that do not end: all tasks run once, and the wait names who
 * it was. */
UNIT_TEST(misbehaving)
{
    static const duite_scheduler WRONG = {.size = sizeof(duite_scheduler),
                                          .name = "wrong",
                                          .summary = "for tests",
                                          .place = nowhere,
                                          .serve = no_end,
                                          .victim = always,
                                          .chain = passive_chain};
    duite *rt = start(&WRONG, 2);
    duite_object a = misuse_new(rt, 1);

    for (int i = 0; i < TASKS; i++)
        ck_assert_int_eq(duite_fork(rt, &NOTE, &i, 1, &a), DUITE_OK);
    int32_t value;
    ck_assert_int_eq(duite_get(rt, a, &value), DUITE_OK);
    ck_assert_int_eq(n_ran, TASKS);
    int code = DUITE_OK;
    while (!code) /* until a worker ran out of tasks */
        code = duite_wait(rt);
    ck_assert_int_eq(code, DUITE_E_ARGUMENT);
    ck_assert_str_eq(
        duite_message(),
        "scheduler wrong names victims without an end (seen on rank 0): its victim has "
        "to return DUITE_NO_QUEUE at last");
    duite_free(rt, a);
    ck_assert_int_eq(duite_stop(&rt), DUITE_E_ARGUMENT);
}
