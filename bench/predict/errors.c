/* The sheet, run and predicted: all predictions start from one trace of one rank, and the runs are
 * of other threads, ranks, schedulers and mappings, each traced, so that both times are from the
 * first event of the steps to the last. And what it costs to be traced. */
#include "bench/predict/predict.h"

#include <math.h>
#include <stdlib.h>

/* The runs; predictions are from the trace of the first one. */
static const struct predict_config CONFIGS[] = {
    {1, 2, "steal", "metis", "none"}, {1, 1, "steal", "metis", "none"},
    {1, 2, "fifo", "metis", "none"},  {1, 2, "static", "metis", "none"},
    {1, 2, "owner", "metis", "none"}, {1, 1, "fifo", "metis", "none"},
    {2, 1, "steal", "metis", "none"}, {2, 1, "steal", "cyclic", "none"},
    {2, 1, "steal", "random", "none"}};
enum { N_CONFIGS = sizeof CONFIGS / sizeof *CONFIGS };

/* And where the second host is half as fast, on a machine that can do that. */
static const struct predict_config UNLIKE = {2, 1, "steal", "metis", "none"};

/* The predicted times of the sheet's runs; < 0: not yet predicted, NAN: that failed. */
static double predicted[N_CONFIGS + 1];

/* ---- Being traced ---- */

static void plan_trace(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *traced = predict_series(measure, options, &CONFIGS[0], "wall");
    const struct measure_series *plain = predict_series(measure, options, &CONFIGS[0], "no");
    measure_ratio(measure, traced, plain, "trace_slowdown");
}

/* ---- Errors ---- */

/* By the trace of this round. */
static void errors_predict(size_t round)
{
    static size_t known = SIZE_MAX;
    if (round == known)
        return;
    known = round;
    struct trace_run *run = predict_read_sheet(round);
    for (int i = 0; i < N_CONFIGS; i++)
        predicted[i] = run ? predict_makespan(run, &CONFIGS[i], false) : NAN;
    predicted[N_CONFIGS] = run ? predict_makespan(run, &UNLIKE, true) : NAN;
    trace_run_free(run);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* scale: which of the sorted errors, 0.5: the median. */
static double error_of(const struct measure_metric *metric, size_t round)
{
    double error[N_CONFIGS + 1];
    size_t n = 0;
    errors_predict(round);
    for (size_t i = 0; i < metric->n; i++) {
        const double real = metric->of[i].sample[round];
        error[n++] = fabs(predicted[1 + i] - real) / real;
        if (isnan(error[n - 1]))
            return NAN;
    }
    qsort(error, n, sizeof *error, compare);
    return error[(size_t)(metric->scale * (double)(n - 1))];
}

static double unlike_of(const struct measure_metric *metric, size_t round)
{
    errors_predict(round);
    return predicted[N_CONFIGS] / metric->of->sample[round];
}

static void plan_errors(struct measure *measure, const struct bench_options *options)
{
    predict_series(measure, options, &CONFIGS[0], "kept");
    const struct measure_series *first = NULL;
    for (int i = 1; i < N_CONFIGS; i++) {
        const struct measure_series *series = predict_series(measure, options, &CONFIGS[i], "run");
        first = first ? first : series;
    }
    const bool unlike = predict_quota_is_there();
    if (unlike)
        measure_metric(measure, "x", unlike_of, "predicted_unlike_vs_run")->of =
            predict_series(measure, options, &UNLIKE, "slow");
    struct measure_metric *median =
        measure_metric(measure, "", error_of, "%s", "predict_error_median");
    struct measure_metric *worst =
        measure_metric(measure, "", error_of, "%s", "predict_error_worst");
    median->of = worst->of = first;
    median->n = worst->n = N_CONFIGS - 1 + unlike;
    median->scale = 0.5;
    worst->scale = 1;
}

const struct bench_case predict_trace = {"trace", "what a traced run of the sheet takes longer",
                                         plan_trace, predict_sheet_runs, 0};
const struct bench_case predict_errors = {
    "errors", "the sheet predicted for other ranks, threads, policies and hosts, against runs",
    plan_errors, predict_sheet_runs, 8};
