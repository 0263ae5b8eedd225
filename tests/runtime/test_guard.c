/* Schedulers of which a function never returns: it is named, and all tasks are run. */
#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <duite_policy.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { TASKS = 40 };

#define SECONDS 0.2

static const char *const FUNCTION[] = {"place", "serve", "victim", "chain", "start", "look"};
enum { AT_WORK = 4, ALL = 6 };

static _Atomic(const char *) hung; /* the function that never returns */
static _Atomic int inside, forever = 1;

static void may_hang(const char *function)
{
    const char *name = atomic_load(&hung);

    if (!name || strcmp(name, function))
        return;
    atomic_fetch_add(&inside, 1);
    while (atomic_load(&forever))
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    (void)n_workers;
    (void)seed;
    may_hang("start");
    *(unsigned *)state = worker;
}

static void look(void *state, const duite_near *near)
{
    (void)state;
    (void)near;
    may_hang("look");
}

static unsigned place(void *state, const duite_ready *task)
{
    (void)task;
    may_hang("place");
    return *(unsigned *)state;
}

static duite_end serve(void *state)
{
    (void)state;
    may_hang("serve");
    return DUITE_NEWEST;
}

static unsigned victim(void *state, unsigned attempt)
{
    if (*(unsigned *)state)
        may_hang("victim");
    return attempt ? DUITE_NO_QUEUE : 1 - *(unsigned *)state;
}

static int chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    may_hang("chain");
    return 1;
}

static const duite_scheduler HANGING = {.name = "hanging",
                                        .summary = "for tests",
                                        .state_size = sizeof(unsigned),
                                        .start = start,
                                        .look = look,
                                        .place = place,
                                        .serve = serve,
                                        .victim = victim,
                                        .chain = chain};

static int try_start(duite **rt, double seconds)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.scheduler = &HANGING;
    options.policy_seconds = seconds;
    return duite_start(rt, &options);
}

static void check_sentence(const char *function)
{
    char wanted[100];

    snprintf(wanted, sizeof wanted,
             "scheduler hanging: its %s did not return for 0.2 s (rank 0, worker ", function);
    ck_assert_msg(!strncmp(duite_message(), wanted, strlen(wanted)), "'%s' is not '%s'",
                  duite_message(), wanted);
}

/* A chain of tasks, and as many that may run at once. */
static void fork_all(duite *rt, duite_object sum, duite_object chained)
{
    for (int i = 0; i < TASKS; i++) {
        ck_assert_int_eq(duite_fork(rt, &ADD, NULL, 1, &sum), DUITE_OK);
        duite_object next = misuse_new(rt, 1);
        ck_assert_int_eq(duite_fork(rt, &COPY, NULL, 2, (duite_object[]){chained, next}), DUITE_OK);
        duite_free(rt, chained);
        chained = next;
    }
    int32_t length;
    duite_get(rt, chained, &length);
    ck_assert_int_eq(length, TASKS);
    duite_free(rt, chained);
}

/* In the middle of work, of which nothing is lost. */
START_TEST(at_work)
{
    const int32_t zero = 0;
    int32_t value = 0;
    duite *rt;

    ck_assert_int_eq(try_start(&rt, SECONDS), DUITE_OK);
    duite_object sum = misuse_new(rt, 1), chained = misuse_new(rt, 1);
    duite_set(rt, sum, &zero);
    duite_set(rt, chained, &zero);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    atomic_store(&hung, FUNCTION[_i]);
    fork_all(rt, sum, chained); /* whose get may be the first to tell */
    int code = strstr(duite_message(), "hanging") ? DUITE_E_ARGUMENT : DUITE_OK;
    while (!code)
        code = duite_wait(rt);
    ck_assert_int_eq(code, DUITE_E_ARGUMENT);
    check_sentence(FUNCTION[_i]);
    ck_assert_int_eq(duite_get(rt, sum, &value), DUITE_OK); /* it is told once */
    ck_assert_int_eq(value, TASKS);
    duite_free(rt, sum);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}
END_TEST

START_TEST(at_start)
{
    duite *rt;

    atomic_store(&hung, FUNCTION[_i]);
    ck_assert_int_eq(try_start(&rt, SECONDS), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    check_sentence(FUNCTION[_i]);
}
END_TEST

/* An idle worker hangs, and nothing is left to be done but to stop. */
START_TEST(at_the_end)
{
    duite *rt;

    ck_assert_int_eq(try_start(&rt, SECONDS), DUITE_OK);
    atomic_store(&hung, "victim");
    ck_assert_int_eq(duite_fork(rt, &EMPTY, NULL, 0, NULL), DUITE_OK); /* wakes it, if it sleeps */
    while (!atomic_load(&inside))
        sched_yield();
    ck_assert_int_eq(duite_stop(&rt), DUITE_E_ARGUMENT);
    ck_assert_ptr_null(rt);
    check_sentence("victim");
}
END_TEST

static void urgent(int number)
{
    (void)number;
}

/* The program's own handler, and its mask, are what they were. */
START_TEST(signals_of_the_program)
{
    struct sigaction own = {.sa_handler = urgent}, now;
    sigset_t only, mask;
    duite *rt;

    sigemptyset(&only);
    sigaddset(&only, SIGURG);
    sigaction(SIGURG, &own, NULL);
    pthread_sigmask(SIG_BLOCK, &only, NULL);
    atomic_store(&hung, "start");
    ck_assert_int_eq(try_start(&rt, SECONDS), DUITE_E_ARGUMENT);
    sigaction(SIGURG, NULL, &now);
    pthread_sigmask(SIG_BLOCK, NULL, &mask);
    ck_assert(now.sa_handler == urgent && sigismember(&mask, SIGURG));
}
END_TEST

static void wait_a_little(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    const struct timespec moment = {.tv_nsec = 100000000};

    (void)state;
    (void)worker;
    (void)n_workers;
    (void)seed;
    nanosleep(&moment, NULL);
}

/* One that returns late, and nobody who minds. */
START_TEST(no_guard)
{
    duite_scheduler slow = HANGING;
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;

    misuse_mpi();
    slow.start = wait_a_little;
    options.scheduler = &slow;
    options.policy_seconds = 0;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    options.policy_seconds = -1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("policies that do not return");
    TCase *test = tcase_create("guarded");

    tcase_add_loop_test(test, at_work, 0, AT_WORK);
    tcase_add_loop_test(test, at_start, AT_WORK, ALL);
    tcase_add_test(test, at_the_end);
    tcase_add_test(test, signals_of_the_program);
    tcase_add_test(test, no_guard);
    suite_add_tcase(suite, test);
    return unit_run(suite);
}
