/* Calls from other threads are refused with DUITE_E_STATE and change nothing, and so are a body's
 * that are for the main program alone. */

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <pthread.h>
#include <stdint.h>

enum { CALLS = 12 };

struct attempt {
    duite *rt;
    duite_object object;
    const duite_kernel *kernel;
    int code[CALLS];
};

/* Every call that changes something or waits. */
static void try_all(struct attempt *attempt)
{
    duite *rt = attempt->rt;
    const duite_object object = attempt->object;
    duite_object made;
    duite_counters counters;
    int32_t value = 0;
    int *code = attempt->code;

    *code++ = duite_fork(rt, attempt->kernel, NULL, 1, &object);
    *code++ = duite_fork_at(rt, 0, attempt->kernel, NULL, 1, &object);
    *code++ = duite_fork_with(rt, NULL, attempt->kernel, NULL, 1, &object);
    *code++ = duite_new(rt, DUITE_I32, 1, &made);
    *code++ = duite_free(rt, object);
    *code++ = duite_set(rt, object, &value);
    *code++ = duite_get(rt, object, &value);
    *code++ = duite_get_at(rt, object, 0, &value);
    *code++ = duite_hint(rt, object, 1, 0, NULL, NULL);
    *code++ = duite_colocate(rt, object, object);
    *code++ = duite_wait(rt);
    *code++ = duite_count_all(rt, &counters);
}

KERNEL(TRYING, "trying", .access = {DUITE_RW})
{
    try_all(call->context);
    duite_out(call, 0, int32_t)[0] += 1;
    return 0;
}

static void *trying_thread(void *context)
{
    try_all(context);
    return NULL;
}

static void start(struct attempt *attempt, unsigned threads)
{
    const duite_kernel *list[] = {&TRYING, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.kernels = list;
    options.threads = threads;
    options.context = attempt;
    ck_assert_int_eq(duite_start(&attempt->rt, &options), DUITE_OK);
    attempt->kernel = &TRYING;
    attempt->object = misuse_new(attempt->rt, 1);
}

/* Bodies may fork, on what is theirs. */
static const int IN_A_BODY[CALLS] = {DUITE_E_RIGHT, DUITE_E_STATE, DUITE_E_RIGHT, DUITE_OK,
                                     DUITE_E_RIGHT, DUITE_E_RIGHT, DUITE_E_RIGHT, DUITE_E_STATE,
                                     DUITE_E_STATE, DUITE_E_STATE, DUITE_OK,      DUITE_E_STATE};

/* All were refused (codes NULL: with DUITE_E_STATE), nothing comes back later, and only the main
 * program's task has written. */
static void finish(struct attempt *attempt, const int *codes, int32_t expected)
{
    int32_t value = -1;

    for (int i = 0; i < CALLS; i++)
        ck_assert_msg(attempt->code[i] == (codes ? codes[i] : DUITE_E_STATE), "call %d returned %d",
                      i, attempt->code[i]);
    ck_assert_int_eq(duite_get(attempt->rt, attempt->object, &value), DUITE_OK);
    ck_assert_int_eq(value, expected);
    ck_assert_int_eq(duite_free(attempt->rt, attempt->object), DUITE_OK);
    ck_assert_int_eq(duite_stop(&attempt->rt), DUITE_OK);
}

UNIT_LOOP(from_a_body, 0, 3)
{
    struct attempt attempt;

    start(&attempt, 1 + (unsigned)_i);
    ck_assert_int_eq(DUITE_FORK(attempt.rt, &TRYING, NULL, attempt.object), DUITE_OK);
    ck_assert_int_eq(duite_wait(attempt.rt), DUITE_OK);
    finish(&attempt, IN_A_BODY, 1);
}

UNIT_TEST(from_another_thread)
{
    struct attempt attempt;
    pthread_t thread;

    start(&attempt, 2);
    ck_assert_int_eq(pthread_create(&thread, NULL, trying_thread, &attempt), 0);
    pthread_join(thread, NULL);
    finish(&attempt, NULL, 0);
}

UNIT_TEST(between_begin_and_end_of_mpi)
{
    struct attempt attempt;

    start(&attempt, 2);
    ck_assert_int_eq(duite_mpi_end(attempt.rt), DUITE_E_STATE);
    ck_assert_int_eq(duite_mpi_begin(attempt.rt), DUITE_OK);
    try_all(&attempt);
    ck_assert_int_eq(duite_mpi_begin(attempt.rt), DUITE_E_STATE);
    ck_assert_int_eq(duite_stop(&attempt.rt), DUITE_E_STATE);
    ck_assert_ptr_nonnull(attempt.rt);
    ck_assert_int_eq(duite_mpi_end(attempt.rt), DUITE_OK);
    ck_assert_int_eq(duite_wait(attempt.rt), DUITE_E_STATE); /* told once */
    finish(&attempt, NULL, 0);
}

static void *stopping_thread(void *context)
{
    struct attempt *attempt = context;
    duite *rt = attempt->rt;

    attempt->code[0] = duite_stop(&rt);
    return NULL;
}

UNIT_TEST(stop_from_another_thread)
{
    struct attempt attempt;
    pthread_t thread;

    start(&attempt, 2);
    ck_assert_int_eq(pthread_create(&thread, NULL, stopping_thread, &attempt), 0);
    pthread_join(thread, NULL);
    ck_assert_int_eq(attempt.code[0], DUITE_E_STATE);
    for (int i = 0; i < CALLS; i++)
        attempt.code[i] = DUITE_E_STATE;
    finish(&attempt, NULL, 0);
}
