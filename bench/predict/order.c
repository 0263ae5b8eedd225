/* Which configuration of the sheet is faster: whether predictions from one trace of one rank say so
 * for each pair of which runs say so. Among them bad mappings, and balancers that mend one. */
#include "bench/predict/predict.h"

#include "tools/compare/compare.h"

#include <math.h>
#include <string.h>

static const struct predict_config TRACED = {1, 2, "steal", "metis", "none"};
static const struct predict_config CONFIGS[] = {
    {1, 1, "steal", "metis", "none"},     {1, 2, "fifo", "metis", "none"},
    {1, 2, "static", "metis", "none"},    {1, 2, "owner", "metis", "none"},
    {1, 2, "priority", "metis", "none"},  {1, 2, "locality", "metis", "none"},
    {2, 1, "steal", "metis", "none"},     {2, 1, "steal", "block", "none"},
    {2, 1, "steal", "cyclic", "none"},    {2, 1, "steal", "random", "none"},
    {2, 1, "steal", "lopsided", "none"},  {2, 1, "steal", "lopsided", "migrate"},
    {2, 1, "steal", "random", "migrate"}, {2, 1, "steal", "taskgraph", "none"},
    {2, 1, "steal", "list", "none"},      {2, 1, "static", "lopsided", "none"}};
enum { N_CONFIGS = sizeof CONFIGS / sizeof *CONFIGS, MOST_ROUNDS = 10 };

/* The findings of all rounds; made once. */
static struct {
    bool made;
    double predicted[N_CONFIGS], median[N_CONFIGS], low[N_CONFIGS], high[N_CONFIGS];
} found;

/* By the traces of all rounds, each by itself: their median, as it is of the runs. */
static void order_predict(size_t rounds)
{
    double predicted[N_CONFIGS][MOST_ROUNDS], low, high;
    for (size_t round = 0; round < rounds; round++) {
        struct trace_run *run = predict_read_sheet(round);
        for (int i = 0; i < N_CONFIGS; i++)
            predicted[i][round] = run ? predict_makespan(run, &CONFIGS[i], false) : NAN;
        trace_run_free(run);
    }
    for (int i = 0; i < N_CONFIGS; i++)
        found.predicted[i] = compare_median(predicted[i], rounds, &low, &high);
}

static void find(const struct measure_metric *metric)
{
    const size_t n = metric->rounds < MOST_ROUNDS ? metric->rounds : MOST_ROUNDS;
    if (found.made)
        return;
    found.made = true;
    for (int i = 0; i < N_CONFIGS; i++) {
        double sample[MOST_ROUNDS];
        memcpy(sample, metric->of[i].sample, n * sizeof *sample);
        found.median[i] = compare_median(sample, n, &found.low[i], &found.high[i]);
    }
    order_predict(n);
}

/* Pairs whose intervals do not overlap; *alike: of these, predicted in the same order. */
static unsigned count_pairs(unsigned *alike)
{
    unsigned n = 0;
    *alike = 0;
    for (int i = 0; i < N_CONFIGS; i++)
        for (int j = 0; j < N_CONFIGS; j++)
            if (found.high[i] < found.low[j]) {
                n++;
                *alike += found.predicted[i] < found.predicted[j];
            }
    return n;
}

static double agrees(const struct measure_metric *metric, size_t round)
{
    unsigned alike;
    (void)round;
    find(metric);
    const unsigned n = count_pairs(&alike);
    return n ? alike / (double)n : NAN;
}

static double pairs(const struct measure_metric *metric, size_t round)
{
    unsigned alike;
    (void)round;
    find(metric);
    return count_pairs(&alike);
}

/* scale: of which configuration. */
static double ratio(const struct measure_metric *metric, size_t round)
{
    const int i = (int)metric->scale;
    (void)round;
    find(metric);
    return found.predicted[i] / found.median[i];
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    predict_series(measure, options, &TRACED, "kept");
    const struct measure_series *first = NULL;
    for (int i = 0; i < N_CONFIGS; i++) {
        const struct measure_series *series = predict_series(measure, options, &CONFIGS[i], "run");
        first = first ? first : series;
    }
    struct measure_metric *order = measure_metric(measure, "", agrees, "rank_order_agrees");
    measure_metric(measure, "pairs", pairs, "rank_order_pairs")->of = first;
    order->of = first;
    for (int i = 0; i < N_CONFIGS; i++) {
        const struct predict_config *c = &CONFIGS[i];
        measure_value(measure, &first[i], 1e3, "ms", "sheet_%ux%u_%s_%s_%s_ms", c->ranks,
                      c->threads, c->scheduler, c->mapping, c->balance);
        struct measure_metric *one =
            measure_metric(measure, "x", ratio, "predicted_%ux%u_%s_%s_%s_vs_run", c->ranks,
                           c->threads, c->scheduler, c->mapping, c->balance);
        one->of = first;
        one->scale = i;
    }
}

const struct bench_case predict_order = {
    "order", "which of two configurations of the sheet is faster, predicted and run", plan,
    predict_sheet_runs, MOST_ROUNDS};
