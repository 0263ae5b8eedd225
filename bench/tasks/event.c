/* The time to end tasks that wait for a thread of the program: their bodies are over, and it
 * completes their events one after the other, while the main program waits for all of them. */
#include "bench/tasks/tasks.h"

#include <pthread.h>
#include <stdlib.h>

struct held {
    duite *rt;
    size_t n;
    _Atomic size_t made;
    duite_event *event;
    double start;
    int code;
};

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned tasks = options->quick ? 200 : 100000;
    const struct measure_series *event = measure_series(
        measure, tasks_ours(1), "event tasks=%u threads=1 scheduler=%s", tasks, options->scheduler);
    measure_value(measure, event, 1e9 / tasks, "ns", "event_ns");
}

static int hold(const duite_call *call)
{
    struct held *held = ((const struct tasks_session *)call->context)->held;
    const size_t i = atomic_load_explicit(&held->made, memory_order_relaxed);
    const int code = duite_event_new(call, &held->event[i]);
    atomic_store_explicit(&held->made, i + 1, memory_order_release); /* one worker makes them */
    return code;
}

const duite_kernel tasks_event_hold = {.name = "event_hold", .body = hold, .events = 1};

static void *complete(void *context)
{
    struct held *held = context;
    while (atomic_load_explicit(&held->made, memory_order_acquire) < held->n)
        ;
    held->start = serve_seconds();
    for (size_t i = 0; i < held->n; i++)
        held->code |= duite_complete(held->rt, held->event[i], 0);
    return NULL;
}

static int time_events(struct held *held, double *value)
{
    pthread_t thread;
    int code = 0;
    for (size_t i = 0; i < held->n; i++)
        code |= duite_fork(held->rt, &tasks_event_hold, NULL, 0, NULL);
    if (code || pthread_create(&thread, NULL, complete, held))
        return tasks_code(code ? code : 1);
    code = duite_wait(held->rt);
    *value = serve_seconds();
    pthread_join(thread, NULL);
    *value -= held->start;
    return tasks_code(code | held->code);
}

static int run(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    struct held held = {.n = (size_t)serve_number(request, "tasks")};
    held.event = calloc(held.n + 1, sizeof *held.event);
    int code = held.event ? tasks_ready(session, request) : serve_no_memory();
    held.rt = session->rt;
    session->held = &held;
    for (int warm = 0; warm < 2 && !code; warm++) {
        atomic_store(&held.made, 0);
        code = time_events(&held, value);
    }
    free(held.event);
    return code;
}

static const struct serve_run RUNS[] = {{"event", run}, {0}};

const struct bench_case tasks_event = {
    "event", "ending tasks whose events another thread completes", plan, RUNS, 0};
