/* The cost of sleep: how long a sleeping worker takes from the fork of a task to its body, and what
 * an idle program uses of a core after the time that its workers spin. */
#include "bench/tasks/tasks.h"

#include <stdlib.h>
#include <time.h>

enum { SETTLE_MS = 20 }; /* idle for so long, every worker sleeps */

static void plan(struct measure *measure, const struct bench_options *options)
{
    unsigned threads = options->threads;
    const struct measure_series *wake =
        measure_series(measure, tasks_ours(threads), "wake times=%d threads=%u scheduler=%s",
                       options->quick ? 2 : 11, threads, options->scheduler);
    const struct measure_series *idle =
        measure_series(measure, tasks_ours(threads), "idle milliseconds=%d threads=%u scheduler=%s",
                       options->quick ? 50 : 200, threads, options->scheduler);
    measure_value(measure, wake, 1e6, "us", "wake_us");
    measure_value(measure, idle, 1, "of_a_core", "idle_cpu_fraction");
}

static void pause_for(unsigned milliseconds)
{
    struct timespec time = {milliseconds / 1000, (long)(milliseconds % 1000) * 1000000};
    nanosleep(&time, NULL);
}

static int wake_up(const duite_call *call)
{
    struct tasks_session *session = call->context;
    session->began = serve_seconds();
    atomic_fetch_add_explicit(&session->woken, 1, memory_order_release);
    return 0;
}

const duite_kernel tasks_wake_up = {.name = "wake_up", .body = wake_up};

/* The main thread looks on and takes no part. */
static int wake_once(struct tasks_session *session, double *seconds)
{
    uint64_t before = atomic_load(&session->woken);
    pause_for(SETTLE_MS);
    double start = serve_seconds();
    if (duite_fork(session->rt, &tasks_wake_up, NULL, 0, NULL))
        return tasks_code(1);
    while (atomic_load_explicit(&session->woken, memory_order_acquire) == before)
        if (serve_seconds() - start > 20)
            return serve_fail("no worker woke up for a task");
    *seconds = session->began - start;
    return tasks_code(duite_wait(session->rt));
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int wake(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    size_t times = serve_number(request, "times");
    double *seconds = calloc(times + 1, sizeof *seconds);
    int code = seconds ? tasks_ready(session, request) : serve_no_memory();
    for (size_t i = 0; i < times && !code; i++)
        code = wake_once(session, &seconds[i]);
    if (!code) {
        qsort(seconds, times, sizeof *seconds, by_size);
        *value = seconds[times / 2];
    }
    free(seconds);
    return code;
}

static double cpu_seconds(void)
{
    struct timespec used;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

static int idle(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    unsigned milliseconds = (unsigned)serve_number(request, "milliseconds");
    int code = tasks_ready(session, request);
    double ignored;
    if (!code)
        code = wake_once(session, &ignored); /* idle after work, not from the start */
    if (code)
        return code;
    pause_for(SETTLE_MS);
    double start = serve_seconds(), used = cpu_seconds();
    pause_for(milliseconds);
    *value = (cpu_seconds() - used) / (serve_seconds() - start);
    return 0;
}

static const struct serve_run RUNS[] = {{"wake", wake}, {"idle", idle}, {0}};

const struct bench_case tasks_wake = {
    "wake", "waking a worker that sleeps; what an idle program uses", plan, RUNS, 0};
