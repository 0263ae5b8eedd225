/* Tasks that fork: depth, the memory of a body that forks for ever, and where failures are said to
 * be. Random programs check values, sizes and contributions, also in replays. */

#include "tests/support/kernel.h"
#include "tests/support/unit.h"

#include <duite.h>

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>

struct args {
    int32_t n, code;
};

static duite *rt;
static duite_object object;
static int waited;     /* what a body's wait or get returned */
static char said[300]; /* and said */
static size_t grown;   /* bytes that a body's forks left */

/* ---- Kernels ---- */

#define ARGS .args_size = sizeof(struct args)

static const struct args *args_of(const duite_call *call)
{
    return call->args;
}

static void remember_told(int code)
{
    waited = code;
    strncpy(said, code ? duite_message() : "", sizeof said - 1);
}

KERNEL(PUT, "put", .access = {DUITE_W}, ARGS)
{
    duite_out(call, 0, int32_t)[0] = args_of(call)->n;
    return 0;
}

/* As a digit. */
KERNEL(APPEND, "append", .access = {DUITE_RW}, ARGS)
{
    int32_t *value = duite_out(call, 0, int32_t);

    value[0] = value[0] % 100000000 * 10 + args_of(call)->n;
    return 0;
}

KERNEL(COPY, "copy", .access = {DUITE_R, DUITE_W})
{
    duite_out(call, 1, int32_t)[0] = duite_in(call, 0, int32_t)[0];
    return 0;
}

KERNEL(FAILS, "fails", .access = {DUITE_RW}, ARGS)
{
    return duite_fail(call, args_of(call)->code, "on purpose");
}

KERNEL(DEEPER, "deeper", .access = {DUITE_WP}, ARGS)
{
    struct args less = *args_of(call);

    if (!less.n--)
        return DUITE_FORK(call->rt, &PUT, DUITE_ARGS(struct args, .n = 7), call->param[0].object);
    return DUITE_FORK(call->rt, &DEEPER, &less, call->param[0].object);
}

KERNEL(DEEPER_WAITING, "deeper, waiting", .access = {DUITE_RWP}, ARGS)
{
    struct args less = *args_of(call);
    const duite_object own = call->param[0].object;

    if (!less.n--)
        return DUITE_FORK(call->rt, &PUT, DUITE_ARGS(struct args, .n = 0), own);
    DUITE_FORK(call->rt, &DEEPER_WAITING, &less, own);
    const int code = duite_wait(call->rt);

    DUITE_FORK(call->rt, &APPEND, DUITE_ARGS(struct args, .n = 1), own);
    return code;
}

/* The second child writes the first object, so it may run long before the first one. */
KERNEL(FAIL_ALL, "fail all", .access = {DUITE_RWP, DUITE_RWP}, ARGS)
{
    DUITE_FORK(call->rt, &FAILS, DUITE_ARGS(struct args, .code = 21), call->param[1].object);
    DUITE_FORK(call->rt, &FAILS, DUITE_ARGS(struct args, .code = 22), call->param[0].object);
    if (args_of(call)->n)
        remember_told(duite_wait(call->rt));
    return 0;
}

KERNEL(FOR_EVER, "for ever", .access = {DUITE_RWP}, ARGS)
{
    const int32_t n = args_of(call)->n;
    size_t before = 0;
    duite_object made;
    int code = 0;

    for (int32_t i = 0; i < n && !code; i++) {
        duite_new(call->rt, DUITE_I32, 1, &made);
        DUITE_FORK(call->rt, &PUT, DUITE_ARGS(struct args, .n = i), made);
        DUITE_FORK(call->rt, &COPY, NULL, made, call->param[0].object);
        code = duite_free(call->rt, made);
        if (!code && i % 50 == 49)
            code = duite_wait(call->rt);
        if (i == n / 4)
            before = mallinfo2().uordblks;
    }
    grown = mallinfo2().uordblks - before;
    return code;
}

KERNEL(NOTHING, "nothing", .access = {DUITE_WP})
{
    (void)call;
    return 0;
}

/* ---- Cases ---- */

static void start(unsigned threads)
{
    static const duite_kernel *const KERNELS[] = {
        &PUT,      &APPEND,   &COPY,    &FAILS, &DEEPER, &DEEPER_WAITING,
        &FAIL_ALL, &FOR_EVER, &NOTHING, NULL};
    duite_options options = duite_options_default();

    options.kernels = KERNELS;
    options.threads = threads;
    options.bind = 0;
    ck_assert_msg(duite_start(&rt, &options) == DUITE_OK, "%s", duite_message());
    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &object), DUITE_OK);
}

static void begin(void)
{
    start(2);
}

static void end(void)
{
    duite_free(rt, object);
    ck_assert_msg(duite_stop(&rt) == DUITE_OK, "%s", duite_message());
}

static void holds(duite_object what, int32_t expected)
{
    int32_t value = -1;

    ck_assert_msg(duite_get(rt, what, &value) == DUITE_OK, "%s", duite_message());
    ck_assert_int_eq(value, expected);
}

UNIT_FIXTURE(begin, end)

UNIT_TEST(depth)
{
    DUITE_FORK(rt, &DEEPER, DUITE_ARGS(struct args, .n = 20000), object);
    holds(object, 7);
    DUITE_FORK(rt, &DEEPER_WAITING, DUITE_ARGS(struct args, .n = 9), object);
    holds(object, 111111111);
    DUITE_FORK(rt, &DEEPER_WAITING, DUITE_ARGS(struct args, .n = 300), object);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
}

/* As many tasks as one likes, and the memory of fifty. */
UNIT_LOOP(memory, 0, 3)
{
    const struct args args = {.n = unit_quick() ? 20000 : 500000};

    end();
    start(1 + (unsigned)_i);
    DUITE_FORK(rt, &FOR_EVER, &args, object);
    holds(object, args.n - 1);
    ck_assert_msg((int64_t)grown < 1 << 20, "%zu bytes", grown);
}

/* The first in the reference order is told, with its place in the tree, by all who wait. */
UNIT_TEST(failures)
{
    duite_object other;
    int32_t value;

    duite_new(rt, DUITE_I32, 1, &other);
    DUITE_FORK(rt, &FAIL_ALL, DUITE_ARGS(struct args, .n = 1), object, other);
    ck_assert_int_eq(duite_wait(rt), 21);
    unit_says(duite_message(), "task 1.1 (kernel fails) failed on rank 0 with code 21: on purpose");
    ck_assert_int_eq(waited, 21);
    unit_says(said, "task 1.1 (kernel fails)");
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_get(rt, object, &value), 22);
    ck_assert_int_eq(duite_get(rt, other, &value), 21);
    DUITE_FORK(rt, &NOTHING, NULL, other); /* a w that nobody does leaves zeros */
    holds(other, 0);
    DUITE_FORK(rt, &FAILS, DUITE_ARGS(struct args, .code = 23), other);
    ck_assert_int_eq(duite_wait(rt), 23);
    duite_set(rt, object, NULL);
    holds(object, 0);
    DUITE_FORK(rt, &DEEPER, DUITE_ARGS(struct args, .n = 3), other); /* heals */
    holds(other, 7);
    duite_free(rt, other);
}
