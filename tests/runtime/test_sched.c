/* The schedulers' decisions, seen where they are asked and where tasks run. */
#include "runtime/balance/balance.h"
#include "runtime/sched/sched.h"
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <duite_policy.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { TASKS = 30, BLOCKS = 7, STEPS = 40 };

/* Where tasks ran, and in which order. */
static int order[TASKS * 2], n_ran;
static unsigned worker_of[BLOCKS][STEPS];

#define URGENCY(i) ((i)*7 % 5 - 2) /* of a task, by its number */

KERNEL(NOTE, "note", .access = {DUITE_W}, .args_size = sizeof(int))
{
    order[n_ran++] = *(const int *)call->args;
    return 0;
}

KERNEL(STEP, "step", .access = {DUITE_RW, DUITE_R}, .args_size = 2 * sizeof(int))
{
    const int *where = call->args;

    for (volatile int i = 0; i < 2000; i++)
        ;
    worker_of[where[0]][where[1]] = call->worker;
    duite_out(call, 0, int32_t)[0] += duite_in(call, 1, int32_t)[0] + 1;
    return 0;
}

static duite *start(const char *scheduler, unsigned threads)
{
    static const duite_kernel *const KERNELS[] = {&NOTE, &STEP, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.scheduler = duite_scheduler_find(scheduler);
    options.threads = threads;
    duite *rt = misuse_start_with(&options);
    ck_assert_ptr_nonnull(rt);
    return rt;
}

/* Forks TASKS tasks that may run at once before one worker gets to any of them. */
static void run_ready(const char *scheduler)
{
    duite *rt = start(scheduler, 1);
    duite_object object[TASKS];

    n_ran = 0;
    for (int i = 0; i < TASKS; i++)
        object[i] = misuse_new(rt, 1);
    for (int i = 0; i < TASKS; i++)
        ck_assert_int_eq(duite_fork(rt, &NOTE, &i, 1, &object[i]), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    for (int i = 0; i < TASKS; i++)
        duite_free(rt, object[i]);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    ck_assert_int_eq(n_ran, TASKS);
}

UNIT_TEST(one_worker)
{
    static const char *const OLDEST_FIRST[] = {"fifo", "static"},
                             *NEWEST_FIRST[] = {"lifo", "steal"};

    for (int k = 0; k < 2; k++) {
        run_ready(OLDEST_FIRST[k]);
        for (int i = 0; i < TASKS; i++)
            ck_assert_int_eq(order[i], i);
        run_ready(NEWEST_FIRST[k]);
        for (int i = 0; i < TASKS; i++)
            ck_assert_int_eq(order[i], TASKS - 1 - i);
    }
}

/* By priority, and in fork order among equals. */
static void check_order(const int *seen)
{
    for (int i = 1; i < TASKS; i++) {
        const int now = URGENCY(seen[i]), before = URGENCY(seen[i - 1]);

        ck_assert_int_le(now, before);
        if (now == before)
            ck_assert_int_lt(seen[i - 1], seen[i]);
    }
}

static int build_urgent(duite *rt, void *context)
{
    const duite_object *object = context;

    for (int i = 0; i < TASKS; i++)
        duite_fork_with(rt, &(duite_task_options){.priority = URGENCY(i)}, &NOTE, &i, 1,
                        &object[i]);
    return 0;
}

/* Forked and replayed, one worker runs them in their order. */
UNIT_TEST(by_priority)
{
    duite *rt = start("priority", 1);
    duite_object object[TASKS];
    duite_graph graph;

    n_ran = 0;
    for (int i = 0; i < TASKS; i++)
        object[i] = misuse_new(rt, 1);
    ck_assert_int_eq(build_urgent(rt, object), 0);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_graph_new(rt, build_urgent, object, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 1), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(n_ran, 2 * TASKS);
    check_order(order);
    check_order(order + TASKS);
    for (int i = 0; i < TASKS; i++)
        duite_free(rt, object[i]);
    duite_graph_free(rt, graph);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* Steps of a ring of blocks with two objects each, the second of which follows the first: returns
 * what is left in block 0, and fills worker_of. */
static int32_t run_ring(const char *scheduler, unsigned threads, duite_counters *counters)
{
    duite *rt = start(scheduler, threads);
    duite_object a[BLOCKS], b[BLOCKS];
    int32_t value;

    for (int i = 0; i < BLOCKS; i++) {
        a[i] = misuse_new(rt, 1);
        b[i] = misuse_new(rt, 1);
        duite_colocate(rt, b[i], a[i]);
    }
    for (int s = 0; s < STEPS; s++)
        for (int i = 0; i < BLOCKS; i++) {
            const int where[] = {i, s};
            const duite_object own = s % 2 ? b[i] : a[i],
                               other = s % 2 ? a[i] : b[(i + 1) % BLOCKS];

            ck_assert_int_eq(DUITE_FORK(rt, &STEP, where, own, other), DUITE_OK);
        }
    ck_assert_int_eq(duite_get(rt, b[0], &value), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_count_all(rt, counters), DUITE_OK);
    for (int i = 0; i < BLOCKS; i++) {
        duite_free(rt, a[i]);
        duite_free(rt, b[i]);
    }
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    return value;
}

/* The worker of a block is its number modulo the workers, whatever object of it is written. */
UNIT_TEST(fixed_workers)
{
    for (unsigned threads = 1; threads <= 3; threads++) {
        duite_counters counters;

        run_ring("static", threads, &counters);
        ck_assert_uint_eq(counters.stolen, 0);
        for (unsigned i = 0; i < BLOCKS; i++)
            for (int s = 0; s < STEPS; s++)
                ck_assert_uint_eq(worker_of[i][s], i % threads);
    }
}

/* True if there is a built-in one of each name, which calls itself so and is, or is not, for tests.
 */
static bool are_rows(const char *const *names, bool for_tests)
{
    bool fine = *names != NULL;
    for (; *names; names++) {
        const duite_scheduler *s = duite_scheduler_find(*names);
        const duite_balancer *b = s ? NULL : duite_balancer_find(*names);
        const duite_mapping *m = s || b ? NULL : duite_mapping_find(*names);
        const char *name = s ? s->name : b ? b->name : m ? m->name : "";
        const char *summary = s ? s->summary : b ? b->summary : m ? m->summary : "";
        fine = fine && !strcmp(name, *names) && !strstr(summary, "for tests") == !for_tests;
    }
    return fine;
}

UNIT_TEST(rows)
{
    ck_assert(are_rows(duite_scheduler_names(), false));
    ck_assert(are_rows(duite_mapping_names(), false));
    ck_assert(are_rows(duite_balancer_names(), false));
    ck_assert(are_rows(sched_test_names(), true));
    ck_assert(are_rows(balance_test_names(), true));
}

UNIT_TEST(same_results)
{
    duite_counters counters;
    const int32_t first = run_ring("fifo", 1, &counters);

    for (const char *const *name = duite_scheduler_names(); *name; name++)
        for (unsigned threads = 1; threads <= 4; threads++)
            ck_assert_int_eq(run_ring(*name, threads, &counters), first);
}

/* Asked for one of several workers: one queue or the own one, an end, and whom to steal from. */
UNIT_TEST(decisions)
{
    static const struct {
        const char *name;
        unsigned queue, victims;
        duite_end end;
        int chains;
    } CASES[] = {{"fifo", DUITE_SHARED_QUEUE, 0, DUITE_OLDEST, 0},
                 {"lifo", DUITE_SHARED_QUEUE, 0, DUITE_NEWEST, 0},
                 {"priority", DUITE_SHARED_QUEUE, 0, DUITE_HIGHEST, 0},
                 {"static", 5 % 4, 0, DUITE_OLDEST, 0},
                 {"steal", 2, 3, DUITE_NEWEST, 1}};
    const duite_ready task = {.kernel = "note", .number = 6, .block = 5};

    for (unsigned c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const struct duite_scheduler *s = duite_scheduler_find(CASES[c].name);
        void *state = calloc(1, s->state_size + 1);
        unsigned victims = 0;

        if (s->start)
            s->start(state, 2, 4, 1);
        ck_assert_uint_eq(s->place(state, &task), CASES[c].queue);
        ck_assert_int_eq(s->serve(state), CASES[c].end);
        ck_assert_int_eq(s->chain(state, &task), CASES[c].chains);
        while (victims < 10 && s->victim(state, victims) != DUITE_NO_QUEUE)
            victims++;
        ck_assert_uint_eq(victims, CASES[c].victims);
        ck_assert_str_eq(s->name, CASES[c].name);
        ck_assert_ptr_nonnull(s->summary);
        free(state);
    }
}

UNIT_TEST(chains_at_home)
{
    const struct duite_scheduler *s = duite_scheduler_find("static");
    void *state = calloc(1, s->state_size);

    s->start(state, 2, 4, 1);
    ck_assert_int_eq(s->chain(state, &(duite_ready){.kernel = "note", .block = 6}), 1);
    ck_assert_int_eq(s->chain(state, &(duite_ready){.kernel = "note", .block = 7}), 0);
    free(state);
}

/* The tasks that worker 2, or 3, ran in a replay. */
UNIT_TEST(stays_warm)
{
    static const char *const NAMES[] = {"steal", "locality"};
    for (int i = 0; i < 2; i++) {
        const struct duite_scheduler *s = duite_scheduler_find(NAMES[i]);
        void *state = calloc(1, s->state_size);
        const duite_ready own = {.kernel = "note", .affinity = 1 + 2};
        const duite_ready other = {.kernel = "note", .affinity = 1 + 3};

        s->start(state, 2, 4, 1);
        ck_assert_uint_eq(s->place(state, &own), 2);
        ck_assert_int_eq(s->chain(state, &own), 1);
        ck_assert_uint_eq(s->place(state, &other), 3);
        ck_assert_int_eq(s->chain(state, &other), 0);
        free(state);
    }
}
