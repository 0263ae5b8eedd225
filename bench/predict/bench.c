/* The bench "compare": what traces cost, and what predictions are worth. */
#include "bench/predict/predict.h"

static const struct bench_case *const CASES[] = {&predict_trace, &predict_many, &predict_errors,
                                                 NULL};

static const struct measure_target TARGETS[] = {
    {"trace_slowdown", 1.02, false},          {"predict_1e6_seconds", 1, false},
    {"predict_1e6_bytes", 1073741824, false}, {"predict_error_median", 0.1, false},
    {"predict_error_worst", 0.25, false},     {0}};
enum { TARGET_THREADS = 2, MANY = 1000000, FEW = 10000 };

static int prepare(const struct bench_options *options,
                   void (*say)(const char *key, const char *text))
{
    say("trace_many", options->quick ? "10000 tasks" : "1000000 tasks");
    return predict_make_many(options->quick ? FEW : MANY);
}

static int serve_predict(const struct bench *bench)
{
    static struct sheet sheet;
    const struct serve_run *const runs[] = {bench->cases[0]->runs, bench->cases[1]->runs, NULL};
    return serve("duite_options_default() but for threads, scheduler, mapping and trace", runs,
                 &sheet);
}

const struct bench bench_compare = {
    "compare",      "what a trace costs, and predictions against runs",
    CASES,          TARGETS,
    TARGET_THREADS, serve_predict,
    prepare};
