/* Memory of the program's own: a round takes an array, runs a task that changes some of it, and
 * gives it back. Adopted, nothing is copied; otherwise it is set and got. Each round is asked for
 * its answer. */
#include "bench/tasks/tasks.h"

#include <stdlib.h>

enum { STRIDE = 1 << 17, ROUNDS = 5 }; /* elements between two that the task changes: 1 MiB */

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const NAMES[] = {"adopt", "copy"};
    const unsigned megabytes = options->quick ? 10 : 100, threads = options->threads;
    struct measure_series *series[2];
    for (int i = 0; i < 2; i++)
        series[i] =
            measure_series(measure, tasks_ours(threads), "%s megabytes=%u threads=%u scheduler=%s",
                           NAMES[i], megabytes, threads, options->scheduler);
    measure_ratio(measure, series[0], series[1], "adopt_vs_copy");
    for (int i = 0; i < 2; i++)
        measure_value(measure, series[i], 1e6 / ROUNDS, "us", "%s_round_us", NAMES[i]);
}

static int change(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i += STRIDE)
        duite_out(call, 0, double)[i] += 1;
    return 0;
}

const duite_kernel tasks_adopt_change = {
    .name = "adopt_change", .body = change, .access = {DUITE_RW}};

static int round_adopted(duite *rt, size_t n, double *values)
{
    duite_object object;
    if (duite_adopt(rt, 0, DUITE_F64, n, values, NULL, NULL, &object) ||
        duite_fork(rt, &tasks_adopt_change, NULL, 1, &object) || duite_free(rt, object))
        return tasks_code(1);
    return tasks_code(duite_wait(rt));
}

static int round_copied(duite *rt, size_t n, double *values)
{
    duite_object object;
    if (duite_new(rt, DUITE_F64, n, &object) || duite_set(rt, object, values) ||
        duite_fork(rt, &tasks_adopt_change, NULL, 1, &object) || duite_get(rt, object, values) ||
        duite_free(rt, object))
        return tasks_code(1);
    return tasks_code(duite_wait(rt));
}

static int rounds(struct tasks_session *session, struct serve_request *request,
                  int (*one)(duite *rt, size_t n, double *values), double *seconds)
{
    const size_t n = serve_number(request, "megabytes") * 1000000 / sizeof(double);
    int code = tasks_ready(session, request);
    double *values = code ? NULL : calloc(n, sizeof *values);
    if (!code && !values)
        code = serve_no_memory();
    for (size_t i = 0; i < n && !code; i++) /* its pages are there */
        values[i] = (double)i;
    if (!code)
        code = one(session->rt, n, values); /* as are those of the runtime's */
    const double start = serve_seconds();
    for (int i = 0; i < ROUNDS && !code; i++)
        code = one(session->rt, n, values);
    *seconds = serve_seconds() - start;
    for (size_t i = 0; i < n && !code; i++)
        if (values[i] != (double)i + (i % STRIDE ? 0 : ROUNDS + 1))
            code = serve_fail("wrong answer");
    free(values);
    return code;
}

static int adopted(void *context, struct serve_request *request, double *value)
{
    return rounds(context, request, round_adopted, value);
}

static int copied(void *context, struct serve_request *request, double *value)
{
    return rounds(context, request, round_copied, value);
}

static const struct serve_run RUNS[] = {{"adopt", adopted}, {"copy", copied}, {0}};

const struct bench_case tasks_adopt = {
    "adopt", "a task on an array of the program's, adopted or copied", plan, RUNS, 0};
