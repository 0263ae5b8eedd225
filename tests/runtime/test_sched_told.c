/* What a scheduler is told of a task: what the fork said, and which worker has its data warm. The
 * scheduler of these tests keeps the last of it. */
#include "tests/negative/misuse.h"
#include "tests/runtime/passive.h"
#include "tests/support/unit.h"

#include <duite_policy.h>
#include <stdint.h>
#include <time.h>

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

/* As long as data need to be worth staying with. */
static int last_long(const duite_call *call)
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

static const duite_kernel LONG = {.name = "long", .body = last_long, .access = {DUITE_W}};
static const duite_kernel NOTE = {
    .name = "note", .body = nothing, .access = {DUITE_W}, .args_size = sizeof(int)};

static duite_ready told[8];
static unsigned n_told;

static unsigned listen(void *state, const duite_ready *task)
{
    (void)state;
    told[n_told++ % 8] = *task;
    return 0;
}

static duite *start(void)
{
    static const duite_scheduler LISTENING = {.name = "listening",
                                              .summary = "for tests",
                                              .place = listen,
                                              .serve = passive_serve,
                                              .victim = passive_victim,
                                              .chain = passive_chain};
    static const duite_kernel *const KERNELS[] = {&NOTE, &LONG, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = NULL;

    misuse_mpi();
    options.kernels = KERNELS;
    options.scheduler = &LISTENING;
    options.threads = 1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    return rt;
}

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
    duite *rt = start();
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
    duite *rt = start();
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
