/* Bodies that wait on top of one another, on stacks of a megabyte: many tasks that wait beside each
 * other do not fill it; tasks that nest more deeply than it allows end in an error. */
#include "tests/support/kernel.h"
#include "tests/support/unit.h"

#include <duite.h>

#include <pthread.h>
#include <sys/resource.h>

/* ThreadSanitizer keeps much of its own there. */
#if defined(__SANITIZE_THREAD__)
enum { MANY = 3000, STACK_BYTES = 4 << 20 };
#else
enum { MANY = 3000, STACK_BYTES = 1 << 20 };
#endif

KERNEL(INCREASE, "increase", .access = {DUITE_RW})
{
    *duite_out(call, 0, int64_t) += 1;
    return 0;
}

/* Adds what it was lent to a sum. */
KERNEL(LOOK, "look", .access = {DUITE_RP, DUITE_CW})
{
    int64_t value = 0;
    const int code = duite_get(call->rt, call->param[0].object, &value);

    *duite_out(call, 1, int64_t) += value;
    return code;
}

/* n levels: 1 and what the child gives. */
KERNEL(DEEPER, "deeper", .access = {DUITE_W}, .args_size = sizeof(int32_t))
{
    const int32_t left = *(const int32_t *)call->args - 1;
    duite_object child;
    int64_t value = 0;
    int code = DUITE_OK;

    if (left) {
        duite_new(call->rt, DUITE_I64, 1, &child);
        DUITE_FORK(call->rt, &DEEPER, &left, child);
        code = duite_get(call->rt, child, &value);
    }
    *duite_out(call, 0, int64_t) = 1 + value;
    return code;
}

/* ---- A program of that many threads ---- */

static duite *rt;
static duite_object value, sum;

static void begin(unsigned threads)
{
    const struct rlimit limit = {STACK_BYTES, STACK_BYTES};
    duite_options options = duite_options_default();
    pthread_attr_t attributes;

    ck_assert_int_eq(setrlimit(RLIMIT_STACK, &limit), 0);
    ck_assert_int_eq(pthread_attr_init(&attributes), 0);
    ck_assert_int_eq(pthread_attr_setstacksize(&attributes, STACK_BYTES), 0);
    ck_assert_int_eq(pthread_setattr_default_np(&attributes), 0);
    pthread_attr_destroy(&attributes);
    options.kernels = (const duite_kernel *const[]){&INCREASE, &LOOK, &DEEPER, NULL};
    options.threads = threads;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    duite_new(rt, DUITE_I64, 1, &value);
    duite_new(rt, DUITE_I64, 1, &sum);
}

static void end(int64_t expected)
{
    int64_t result = 0;

    ck_assert_int_eq(duite_get(rt, sum, &result), DUITE_OK);
    ck_assert_int_eq(result, expected);
    duite_free(rt, value);
    duite_free(rt, sum);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* ---- Tests; the number is that of threads ---- */

UNIT_LOOP(all_wait_for_one_task, 1, 4)
{
    begin((unsigned)_i);
    DUITE_FORK(rt, &INCREASE, NULL, value);
    for (int i = 0; i < MANY; i++)
        DUITE_FORK(rt, &LOOK, NULL, value, sum);
    end(MANY);
}

UNIT_LOOP(each_waits_for_its_own, 1, 4)
{
    begin((unsigned)_i);
    for (int i = 0; i < MANY; i++) {
        DUITE_FORK(rt, &INCREASE, NULL, value);
        DUITE_FORK(rt, &LOOK, NULL, value, sum);
    }
    end((int64_t)MANY * (MANY + 1) / 2);
}

/* The chain of writers is longer than what runs inline in one go. */
UNIT_LOOP(all_wait_for_a_chain, 1, 4)
{
    begin((unsigned)_i);
    for (int i = 0; i < MANY; i++)
        DUITE_FORK(rt, &INCREASE, NULL, value);
    for (int i = 0; i < MANY; i++)
        DUITE_FORK(rt, &LOOK, NULL, value, sum);
    end((int64_t)MANY * MANY);
}

static int64_t nest(int32_t levels, int *code)
{
    int64_t result = 0;

    DUITE_FORK(rt, &DEEPER, &levels, value);
    *code = duite_get(rt, value, &result);
    return result;
}

UNIT_LOOP(nesting_ends_where_the_stack_does, 1, 4)
{
    int code;

    begin((unsigned)_i);
    ck_assert_int_eq(nest(100, &code), 100);
    nest(2 * MANY, &code);
    ck_assert_int_eq(code, DUITE_E_DEPTH);
    unit_says(duite_message(), "bodies wait on top of one another");
    unit_says(duite_message(), "ulimit -s");
    ck_assert_int_eq(duite_wait(rt), DUITE_E_DEPTH);
    ck_assert_int_eq(nest(100, &code), 100);
    end(0);
}
