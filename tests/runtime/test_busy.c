/* The time in bodies, however a worker runs its tasks: that of bodies on top of one that waits
 * counts once. On one worker it is no more than has passed, and no less than one body took. */
#include "tests/support/kernel.h"
#include "tests/support/unit.h"

#include <duite.h>

#include <stdio.h>
#include <time.h>

enum { DEPTH = 6 };
#define LEAF_SECONDS 0.02

static const struct {
    const char *scheduler, *trace;
} WAYS[] = {{"steal", NULL}, {"fifo", NULL}, {"steal", "test_busy.trace"}};

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Waits for a child as deep as `args` says; the last one takes its time. */
KERNEL(NEST, "nest", .access = {DUITE_W}, .args_size = sizeof(int32_t))
{
    const int32_t left = *(const int32_t *)call->args - 1;
    const double since = seconds_now();
    duite_object child;
    *duite_out(call, 0, int32_t) = left;
    while (!left && seconds_now() - since < LEAF_SECONDS)
        ;
    if (!left)
        return DUITE_OK;
    int code = duite_new(call->rt, DUITE_I32, 1, &child);
    if (!code)
        code = DUITE_FORK(call->rt, &NEST, &left, child);
    return code ? code : duite_get(call->rt, child, duite_out(call, 0, int32_t));
}

static const duite_kernel *const KERNELS[] = {&NEST, NULL};

UNIT_LOOP(once, 0, (int)(sizeof WAYS / sizeof *WAYS))
{
    duite_options options = duite_options_default();
    duite_counters counters;
    duite_object object;
    duite *rt;
    options.kernels = KERNELS;
    options.threads = 1;
    options.scheduler = duite_scheduler_find(WAYS[_i].scheduler);
    options.trace = WAYS[_i].trace;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &object), DUITE_OK);
    const double since = seconds_now();
    const int32_t depth = DEPTH;
    ck_assert_int_eq(DUITE_FORK(rt, &NEST, &depth, object), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    const double passed = seconds_now() - since;
    ck_assert_int_eq(duite_count_all(rt, &counters), DUITE_OK);
    ck_assert_uint_eq(counters.tasks, DEPTH);
    ck_assert_double_gt(counters.busy, 0.9 * LEAF_SECONDS);
    ck_assert_double_lt(counters.busy, 1.1 * passed); /* clocks may differ a little */
    duite_free(rt, object);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    if (options.trace)
        remove(options.trace);
}
