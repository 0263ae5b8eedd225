/* Schedulers of which a function does not return until it was named: the watchdog names it at
 * doubling times, the function goes on, and the run ends as if nothing had been. */
#include "runtime/base/monitor.h"
#include "runtime/base/report.h"
#include "tests/negative/misuse.h"
#include "tests/support/said.h"
#include "tests/support/unit.h"

#include <dirent.h>
#include <duite_policy.h>
#include <fcntl.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { TASKS = 40, TIMES = 3, MOST_WAITS = 120000 };

#define SECONDS 0.2

static const char *const FUNCTION[] = {"place", "serve", "victim", "chain", "start", "locate"};
enum { AT_WORK = 4, ALL = 6 };

static void pause_for(double seconds)
{
    nanosleep(&(struct timespec){.tv_sec = (time_t)seconds,
                                 .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))},
              NULL);
}

/* ---- A scheduler that hangs once ---- */

static _Atomic(const char *) hangs; /* the function that does; NULL: none does any more */
static _Atomic int inside;

static int told(const char *function, double seconds)
{
    char wanted[100];
    snprintf(wanted, sizeof wanted, "its %s has not returned for %g s (rank 0, worker ", function,
             seconds);
    return said_lines("duite: scheduler hanging: ", wanted);
}

/* Returns when it was told three times: or, of what is broken, after some minutes. */
static void may_hang(const char *function)
{
    const char *name = atomic_load(&hangs);

    if (!name || strcmp(name, function) != 0 ||
        !atomic_compare_exchange_strong(&hangs, &name, NULL))
        return;
    atomic_store(&inside, 1);
    for (int i = 0; i < MOST_WAITS && !told(function, SECONDS * (1 << (TIMES - 1))); i++)
        pause_for(1e-3);
}

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    (void)n_workers;
    (void)seed;
    may_hang("start");
    *(unsigned *)state = worker;
}

static void locate(void *state, const duite_near *near)
{
    (void)state;
    (void)near;
    may_hang("locate");
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
                                        .locate = locate,
                                        .place = place,
                                        .serve = serve,
                                        .victim = victim,
                                        .chain = chain};

static duite *start_with(const duite_scheduler *scheduler, double seconds)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = NULL;

    misuse_mpi();
    options.scheduler = scheduler;
    options.policy_seconds = seconds;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_OK);
    return rt;
}

/* At 1, 2 and 4 times the limit, and not at 3; none twice, and the last for certain. An earlier one
 * was once missing under a sanitizer, on a busy machine; why is not known. */
static void check_told(const char *function)
{
    for (int i = 0; i < TIMES; i++)
        ck_assert_msg(told(function, SECONDS * (1 << i)) <= 1, "%s, %g s: told %d times", function,
                      SECONDS * (1 << i), told(function, SECONDS * (1 << i)));
    ck_assert_int_eq(told(function, SECONDS * (1 << (TIMES - 1))), 1);
    ck_assert_int_eq(told(function, 3 * SECONDS), 0);
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
    ck_assert_int_eq(duite_get(rt, chained, &length), DUITE_OK);
    ck_assert_int_eq(length, TASKS);
    duite_free(rt, chained);
}

START_TEST(at_work)
{
    const int32_t zero = 0;
    int32_t value = 0, added = 0;

    said_begin();
    duite *rt = start_with(&HANGING, SECONDS);
    duite_object sum = misuse_new(rt, 1);
    duite_set(rt, sum, &zero);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    atomic_store(&hangs, FUNCTION[_i]);
    do { /* until it was called, by an idle worker maybe, or by none yet */
        duite_object chained = misuse_new(rt, 1);
        duite_set(rt, chained, &zero);
        fork_all(rt, sum, chained);
        ck_assert_int_eq(duite_wait(rt), DUITE_OK);
        added += TASKS;
    } while (!atomic_load(&inside));
    ck_assert_int_eq(duite_get(rt, sum, &value), DUITE_OK);
    ck_assert_int_eq(value, added);
    duite_free(rt, sum);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK); /* not before the function has returned */
    check_told(FUNCTION[_i]);
    said_end();
}
END_TEST

START_TEST(at_start)
{
    said_begin();
    atomic_store(&hangs, FUNCTION[_i]);
    duite *rt = start_with(&HANGING, SECONDS);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    check_told(FUNCTION[_i]);
    said_end();
}
END_TEST

/* ---- Nothing is told ---- */

static void work_for(duite *rt, double seconds)
{
    const double begin = MPI_Wtime();

    while (MPI_Wtime() - begin < seconds) {
        ck_assert_int_eq(duite_fork(rt, &EMPTY, NULL, 0, NULL), DUITE_OK);
        ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    }
}

static unsigned place_slowly(void *state, const duite_ready *task)
{
    (void)task;
    pause_for(2e-3);
    return *(unsigned *)state;
}

/* Nearly always in a function, but never for long in one call. */
START_TEST(many_calls)
{
    duite_scheduler slow = HANGING;

    slow.place = place_slowly;
    said_begin();
    duite *rt = start_with(&slow, 1);
    work_for(rt, 2.5);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    ck_assert_int_eq(said_lines("duite: scheduler", ""), 0);
    said_end();
}
END_TEST

static void start_late(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    start(state, worker, n_workers, seed);
    pause_for(0.1);
}

START_TEST(no_watchdog)
{
    duite_scheduler slow = HANGING;
    duite_options options = misuse_options(MPI_COMM_WORLD);

    slow.start = start_late;
    said_begin();
    duite *rt = start_with(&slow, 0);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
    ck_assert_int_eq(said_lines("duite: ", ""), 0);
    options.policy_seconds = -1;
    ck_assert_int_eq(duite_start(&rt, &options), DUITE_E_ARGUMENT);
    said_end();
}
END_TEST

/* ---- The monitor ---- */

struct looked {
    _Atomic int times;
    int refuses; /* so many looks could not be made */
};

static bool count(void *context)
{
    struct looked *looked = context;
    atomic_fetch_add(&looked->times, 1);
    return looked->refuses-- <= 0;
}

static void await(const struct looked *looked, int times)
{
    for (int i = 0; i < MOST_WAITS && atomic_load(&looked->times) < times; i++)
        pause_for(1e-3);
    ck_assert_int_ge(atomic_load(&looked->times), times);
}

static int threads(void)
{
    int n = 0;
    DIR *folder = opendir("/proc/self/task");
    for (const struct dirent *entry; (entry = readdir(folder));)
        n += entry->d_name[0] != '.';
    closedir(folder);
    return n;
}

/* A thread that was joined is still listed for a moment. */
static void await_threads(int n)
{
    for (int i = 0; i < MOST_WAITS && threads() != n; i++)
        pause_for(1e-3);
    ck_assert_int_eq(threads(), n);
}

static void *nothing(void *context)
{
    return context;
}

/* How many threads there are, that which a sanitizer starts beside the first one of ours among
 * them. */
static int threads_before(void)
{
    pthread_t first;
    ck_assert_int_eq(pthread_create(&first, NULL, nothing, NULL), 0);
    ck_assert_int_eq(pthread_join(first, NULL), 0);
    int n = threads(), again = 0;
    for (int same = 0; same < 50; same = again == n ? same + 1 : 0, n = again) {
        pause_for(1e-3);
        again = threads();
    }
    return n;
}

/* One thread, from the first look on until the last one is removed. */
START_TEST(looks)
{
    struct base_monitor monitor = {0};
    struct looked often = {0}, seldom = {0}, later = {0}, refused = {.refuses = 5};
    struct base_look a = {.look = count, .context = &often, .seconds = 1e-3},
                     b = {.look = count, .context = &seldom, .seconds = 3600},
                     c = {.look = count, .context = &later, .seconds = 3600},
                     d = {.look = count, .context = &refused, .seconds = 0.01};
    struct base_look *const all[] = {&a, &b, &c, &d};
    const int before = threads_before();

    base_monitor_remove(&monitor, &a); /* was not added */
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 4; i++)
            ck_assert_int_eq(base_monitor_add(&monitor, all[i]), DUITE_OK);
        await_threads(before + 1);
        await(&often, 20);
        await(&refused, 6);
        ck_assert_int_eq(seldom.times, 0);
        base_monitor_set_period(&monitor, &c, 1e-3);
        await(&later, 3);
        base_monitor_remove(&monitor, &a);
        atomic_store(&often.times, 0);
        atomic_store(&later.times, 0);
        await(&later, 20);
        ck_assert_int_eq(often.times, 0);
        for (int i = 1; i < 4; i++)
            base_monitor_remove(&monitor, all[i]);
        await_threads(before);
        ck_assert_ptr_null(monitor.looks);
        c.seconds = 3600;
    }
}
END_TEST

/* A report returns although nobody reads standard error, a pipe or a socket; and comes whole where
 * somebody does. */
START_TEST(blocked_report)
{
    char text[200] = "";
    int end[2], before = dup(STDERR_FILENO);
    ck_assert(!(_i ? socketpair(AF_UNIX, SOCK_STREAM, 0, end) : pipe(end)));
    dup2(end[1], STDERR_FILENO);
    base_report("all of it");
    ck_assert_int_eq(read(end[0], text, sizeof text), 9);
    fcntl(end[1], F_SETFL, O_NONBLOCK);
    while (write(end[1], text, sizeof text) > 0)
        ;
    while (write(end[1], text, 1) > 0)
        ;
    fcntl(end[1], F_SETFL, 0);
    base_report("nobody reads this");
    const int flags = fcntl(end[1], F_GETFL);
    dup2(before, STDERR_FILENO);
    ck_assert(!(flags & O_NONBLOCK));
    ck_assert_str_eq(text, "all of it");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("the watchdog of policies");
    TCase *test = tcase_create("watched");

    tcase_add_loop_test(test, at_work, 0, AT_WORK);
    tcase_add_loop_test(test, at_start, AT_WORK, ALL);
    tcase_add_test(test, many_calls);
    tcase_add_test(test, no_watchdog);
    tcase_add_test(test, looks);
    tcase_add_loop_test(test, blocked_report, 0, 2);
    suite_add_tcase(suite, test);
    return unit_run(suite);
}
