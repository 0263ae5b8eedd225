/* The cost of a task when the main program is far ahead: all other workers are held by gates while
 * it forks a batch, then the gates open and all wait for the end. The same number of tasks in
 * batches of 1,000 and in one. */
#include "bench/tasks/tasks.h"

#include <stdlib.h>

static void plan(struct measure *measure, const struct bench_options *options)
{
    unsigned ahead[2] = {1000, 1000000}, threads = options->threads;
    struct measure_series *series[2];
    if (options->quick)
        ahead[0] = 100, ahead[1] = 2000;
    for (int i = 0; i < 2; i++) {
        series[i] = measure_series(measure, tasks_ours(threads),
                                   "growth tasks=%u batch=%u threads=%u scheduler=%s", ahead[1],
                                   ahead[i], threads, options->scheduler);
        series[i]->work = ahead[1];
    }
    measure_ratio(measure, series[1], series[0], "independent_growth");
    for (int i = 0; i < 2; i++)
        measure_value(measure, series[i], 1e9 / series[i]->work, "ns",
                      "independent_%s_ahead_ns_per_task", i ? "far" : "little");
}

/* All workers but this one are in a gate. */
static int close_gates(struct tasks_session *session)
{
    atomic_store(&session->gate, 0);
    atomic_store(&session->waiting, 0);
    for (unsigned i = 1; i < session->threads; i++)
        if (duite_fork(session->rt, &tasks_gate, NULL, 0, NULL))
            return tasks_code(1);
    double start = serve_seconds();
    while (atomic_load(&session->waiting) + 1 < session->threads)
        if (serve_seconds() - start > 20) {
            atomic_store(&session->gate, 1);
            return serve_fail("the workers do not take the tasks that hold them");
        }
    return 0;
}

static int batch(struct tasks_session *session, uint64_t first, uint64_t n, double *value)
{
    int code = close_gates(session);
    if (code)
        return code;
    double start = serve_seconds();
    for (uint64_t i = first; i < first + n; i++)
        duite_fork(session->rt, &tasks_independent_mark, &i, 0, NULL);
    atomic_store_explicit(&session->gate, 1, memory_order_release);
    code = duite_wait(session->rt);
    *value += serve_seconds() - start;
    return tasks_code(code);
}

static int growth(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    uint64_t n = serve_number(request, "tasks"), size = serve_number(request, "batch");
    int code = tasks_ready(session, request);
    if (code || !size)
        return code ? code : serve_fail("batches of no size");
    session->mark = calloc(n, sizeof *session->mark);
    if (!session->mark)
        return serve_no_memory();
    *value = 0;
    for (uint64_t first = 0; first + size <= n && !code; first += size)
        code = batch(session, first, size, value);
    if (!code && problem_marks_wrong(session->mark, n))
        code = serve_fail("wrong answer");
    free(session->mark);
    return code;
}

static const struct serve_run RUNS[] = {{"growth", growth}, {0}};

const struct bench_case tasks_growth = {
    "growth", "independent tasks, 1,000,000 ahead against 1,000", plan, RUNS, 0};
