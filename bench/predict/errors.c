/* The sheet, run and foretold: all predictions start from one trace of one rank, and the runs are
 * of other threads, ranks, schedulers and mappings, each traced, so that both times are from the
 * first event of the steps to the last. And what it costs to be traced. */
#include "bench/predict/predict.h"

#include "runtime/predict/predict.h"
#include "runtime/trace/sums.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 150, GRAIN = 1000, STEPS = 10, ITERATIONS = 30, QUICK_SIDE = 30, QUICK_GRAIN = 100 };

/* What is run; the first one is traced. A rank has the host's memory between it and another one:
 * latency and bandwidth are those of messages there. */
static const struct config {
    unsigned ranks, threads;
    const char *scheduler, *mapping;
} CONFIGS[] = {{1, 2, "steal", "metis"},  {1, 1, "steal", "metis"},  {1, 2, "fifo", "metis"},
               {1, 2, "static", "metis"}, {1, 2, "owner", "metis"},  {1, 1, "fifo", "metis"},
               {2, 1, "steal", "metis"},  {2, 1, "steal", "cyclic"}, {2, 1, "steal", "random"}};
enum { N_CONFIGS = sizeof CONFIGS / sizeof *CONFIGS };
#define LATENCY   1e-6
#define BANDWIDTH 5e9

/* Of the sheet as it is planned: what the runs are foretold to take; < 0: not yet, NAN: it failed.
 */
static double foretold[N_CONFIGS];

static struct measure_series *add(struct measure *measure, const struct bench_options *options,
                                  const struct config *config, const char *trace)
{
    const bool many = config->ranks > 1;
    return measure_series(
        measure, (struct subject_shape){"duite", many ? config->ranks : 0, config->threads},
        "sheet side=%d grain=%d threads=%u scheduler=%s mapping=%s trace=%s",
        options->quick ? QUICK_SIDE : SIDE, options->quick ? QUICK_GRAIN : GRAIN, config->threads,
        config->scheduler, config->mapping, trace);
}

/* ---- Being traced ---- */

static void plan_trace(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *traced = add(measure, options, &CONFIGS[0], "wall");
    const struct measure_series *plain = add(measure, options, &CONFIGS[0], "no");
    measure_ratio(measure, traced, plain, "trace_slowdown");
}

/* ---- Errors ---- */

static double foretell(const struct trace_run *run, const struct config *config)
{
    const struct predict_cluster cluster = {.hosts = config->ranks,
                                            .cores = config->threads,
                                            .latency = LATENCY,
                                            .bandwidth = BANDWIDTH,
                                            .capacity = INFINITY,
                                            .core_speed = 1,
                                            .overhead = -1,
                                            .scheduler = duite_scheduler_find(config->scheduler),
                                            .mapping = duite_mapping_find(config->mapping),
                                            .seed = 1};
    struct predict_result result;
    return predict(run, &cluster, &result, NULL) ? NAN : result.makespan;
}

/* By the trace of this round. */
static void foretell_all(size_t round)
{
    static size_t known = SIZE_MAX;
    char *path = predict_path(PREDICT_SHEET);
    struct trace_run *run = NULL;
    if (round == known) {
        free(path);
        return;
    }
    known = round;
    const bool fine = path && !trace_read(&run, path, false);
    for (int i = 0; i < N_CONFIGS; i++)
        foretold[i] = fine ? foretell(run, &CONFIGS[i]) : NAN;
    trace_run_free(run);
    free(path);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* scale: which of the sorted errors, 0.5: the median. */
static double error_of(const struct measure_metric *metric, size_t round)
{
    double error[N_CONFIGS];
    size_t n = 0;
    foretell_all(round);
    for (size_t i = 0; i < metric->n; i++) {
        const double real = metric->of[i].sample[round];
        error[n++] = fabs(foretold[1 + i] - real) / real;
        if (isnan(error[n - 1]))
            return NAN;
    }
    qsort(error, n, sizeof *error, compare);
    return error[(size_t)(metric->scale * (double)(n - 1))];
}

static void plan_errors(struct measure *measure, const struct bench_options *options)
{
    add(measure, options, &CONFIGS[0], PREDICT_SHEET);
    const struct measure_series *first = NULL;
    for (int i = 1; i < N_CONFIGS; i++) {
        const struct measure_series *series =
            add(measure, options, &CONFIGS[i], "predict-run.trace");
        first = first ? first : series;
    }
    struct measure_metric *median =
        measure_metric(measure, "", error_of, "%s", "predict_error_median");
    struct measure_metric *worst =
        measure_metric(measure, "", error_of, "%s", "predict_error_worst");
    median->of = worst->of = first;
    median->n = worst->n = N_CONFIGS - 1;
    median->scale = 0.5;
    worst->scale = 1;
}

/* ---- The sheet ---- */

static int run_flow(struct sheet *sheet, const duite_options *options, double *seconds)
{
    struct cloth_error error = {0};
    struct flow_report report = {0};
    duite *rt = NULL;
    int code = duite_start(&rt, options) ? serve_fail("%s", duite_message()) : 0;
    if (!code && flow_run(sheet->flow, rt, NULL, NULL, &report, &error))
        code = serve_fail("%s", error.text);
    if (rt && duite_stop(&rt) && !code)
        code = serve_fail("%s", duite_message());
    if (!code && report.steps != STEPS)
        code = serve_fail("wrong answer: %g steps", (double)report.steps);
    *seconds = report.wall_seconds;
    return code;
}

/* From the first event of the trace to its last: what is foretold, too. */
static int span_of(const char *path, double *seconds)
{
    struct trace_run *run;
    struct trace_sums sums;
    *seconds = 0;
    if (sheet_own_rank())
        return 0;
    int code = trace_read(&run, path, false) ? serve_fail("%s", duite_message()) : 0;
    if (!code && trace_sum(run, &sums))
        code = serve_fail("%s", duite_message());
    if (!code) {
        *seconds = sums.last - sums.first;
        trace_sums_free(&sums);
        trace_run_free(run);
    }
    return code;
}

static int make_sheet(struct sheet *sheet, struct serve_request *request)
{
    struct cloth_error error = {0};
    const uint32_t side = (uint32_t)serve_number(request, "side");
    sheet_model(sheet, side, (uint32_t)serve_number(request, "grain"));
    sheet->model.max_iterations = ITERATIONS;
    sheet->model.end = STEPS * sheet->model.h;
    if (sheet_own_rank() == 0 && mesh_grid(&sheet->cloth.mesh, 1, 1, side, side, &error))
        return serve_fail("%s", error.text);
    return sheet_flow(sheet);
}

/* trace=no: none; wall: one, and the time that the run tells; a name: the time that the trace has.
 */
static int sheet_run(void *context, struct serve_request *request, double *value)
{
    struct sheet *sheet = context;
    char scheduler[40], mapping[40], trace[40];
    int code = make_sheet(sheet, request);
    duite_options options = duite_options_default();
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    serve_word(request, "mapping", mapping, sizeof mapping);
    serve_word(request, "trace", trace, sizeof trace);
    const bool none = !strcmp(trace, "no"), wall = !strcmp(trace, "wall");
    char *path = predict_path(wall ? "predict-wall.trace" : trace);
    options.kernels = flow_kernels();
    options.context = sheet->flow;
    options.threads = (unsigned)serve_number(request, "threads");
    options.scheduler = duite_scheduler_find(scheduler);
    options.mapping = duite_mapping_find(mapping);
    options.trace = none ? NULL : path;
    options.trace_end = UINT64_MAX - 1; /* without what comes before the first step */
    if (!code)
        code = path ? run_flow(sheet, &options, value) : serve_no_memory();
    if (!code && !none && !wall)
        code = span_of(path, value);
    free(path);
    sheet_free(sheet);
    return code;
}

static const struct serve_run RUNS[] = {{"sheet", sheet_run}, {0}};

const struct bench_case predict_trace = {"trace", "what a traced run of the sheet takes longer",
                                         plan_trace, RUNS, 0};
const struct bench_case predict_errors = {
    "errors", "the sheet foretold for other ranks, threads and policies, against runs", plan_errors,
    RUNS, 8};
