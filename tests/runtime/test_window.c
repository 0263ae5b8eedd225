/* A window: whenever a fork returns, no more tasks than that are unfinished. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <stdatomic.h>
#include <stdint.h>

enum { TASKS = 400, OBJECTS = 5, RECORDED = 10 };

static atomic_int n_over; /* bodies */

KERNEL(STEP, "step", .access = {DUITE_RW, DUITE_R})
{
    for (volatile int i = 0; i < 500; i++)
        ;
    duite_out(call, 0, uint32_t)[0] += duite_in(call, 1, uint32_t)[0] + 1; /* wraps around */
    atomic_fetch_add(&n_over, 1);
    return 0;
}

KERNEL(ADD_ONE, "add", .access = {DUITE_CW})
{
    duite_out(call, 0, int32_t)[0] += 1;
    atomic_fetch_add(&n_over, 1);
    return 0;
}

static duite *start(size_t window, unsigned threads)
{
    static const duite_kernel *const KERNELS[] = {&STEP, &ADD_ONE, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.threads = threads;
    options.window = window;
    atomic_store(&n_over, 0);
    duite *rt = misuse_start_with(&options);
    ck_assert_ptr_nonnull(rt);
    return rt;
}

static int get(duite *rt, duite_object object)
{
    int32_t value = -1;

    ck_assert_int_eq(duite_get(rt, object, &value), DUITE_OK);
    return value;
}

static void run_steps(size_t window, unsigned threads)
{
    duite *rt = start(window, threads);
    duite_object object[OBJECTS];
    int32_t value[OBJECTS] = {0};

    for (int i = 0; i < OBJECTS; i++)
        object[i] = misuse_new(rt, 1);
    for (int i = 0; i < TASKS; i++) {
        const int to = i * i % OBJECTS, from = (to + 1 + i % (OBJECTS - 1)) % OBJECTS;

        ck_assert_int_eq(DUITE_FORK(rt, &STEP, NULL, object[to], object[from]), DUITE_OK);
        ck_assert_int_le(i + 1 - atomic_load(&n_over), (int)window);
        value[to] = (int32_t)((uint32_t)value[to] + (uint32_t)value[from] + 1);
    }
    for (int i = 0; i < OBJECTS; i++)
        ck_assert_int_eq(get(rt, object[i]), value[i]);
    for (int i = 0; i < OBJECTS; i++)
        duite_free(rt, object[i]);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

UNIT_TEST(forks_are_throttled)
{
    for (unsigned threads = 1; threads <= 4; threads++)
        for (size_t window = 1; window <= 16; window *= 4)
            run_steps(window, threads);
}

UNIT_TEST(forks_go_ahead_without_a_window)
{
    duite *rt = start(0, 1);
    const duite_object a = misuse_new(rt, 1), b = misuse_new(rt, 1);

    for (int i = 0; i < TASKS; i++)
        ck_assert_int_eq(DUITE_FORK(rt, &STEP, NULL, a, b), DUITE_OK);
    ck_assert_int_eq(atomic_load(&n_over), 0);
    ck_assert_int_eq(get(rt, a), TASKS);
    duite_free(rt, a);
    duite_free(rt, b);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* The combining task is forked by the access that comes after them. */
UNIT_TEST(contributions_do_not_wait_to_be_combined)
{
    for (unsigned threads = 1; threads <= 3; threads++) {
        duite *rt = start(1, threads);
        const duite_object sum = misuse_new(rt, 1), other = misuse_new(rt, 1);

        for (int i = 0; i < TASKS; i++) {
            ck_assert_int_eq(DUITE_FORK(rt, &ADD_ONE, NULL, sum), DUITE_OK);
            ck_assert_int_le(i + 1 - atomic_load(&n_over), 1);
        }
        ck_assert_int_eq(DUITE_FORK(rt, &STEP, NULL, other, sum), DUITE_OK);
        ck_assert_int_eq(get(rt, other), TASKS + 1);
        duite_free(rt, sum);
        duite_free(rt, other);
        ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    }
}

static int build(duite *rt, void *context)
{
    const duite_object *object = context;
    int code = 0;

    for (int i = 0; i < RECORDED && !code; i++)
        code = DUITE_FORK(rt, &STEP, NULL, object[i % 2], object[1 - i % 2]);
    ck_assert_int_eq(atomic_load(&n_over), 0);
    return code;
}

UNIT_TEST(recording_is_not_throttled)
{
    duite *rt = start(1, 2);
    duite_object object[2] = {misuse_new(rt, 1), misuse_new(rt, 1)};
    duite_graph graph;
    uint32_t value[2] = {0, 0};

    ck_assert_int_eq(duite_graph_new(rt, build, object, &graph), DUITE_OK);
    for (int i = 0; i < 5; i++) {
        ck_assert_int_eq(duite_replay(rt, graph, 3), DUITE_OK);
        ck_assert_int_eq(DUITE_FORK(rt, &STEP, NULL, object[1], object[0]), DUITE_OK);
        for (int k = 0; k < 3 * RECORDED; k++)
            value[k % 2] += value[1 - k % 2] + 1;
        value[1] += value[0] + 1;
    }
    ck_assert_int_eq(get(rt, object[0]), (int32_t)value[0]);
    ck_assert_int_eq(get(rt, object[1]), (int32_t)value[1]);
    duite_graph_free(rt, graph);
    duite_free(rt, object[0]);
    duite_free(rt, object[1]);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}
