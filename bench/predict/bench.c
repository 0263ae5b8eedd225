/* The bench "compare": what traces and comparisons cost, and what predictions are worth. */
#include "bench/predict/predict.h"
#include "bench/temporary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct bench_case *const CASES[] = {&predict_trace, &predict_many,     &predict_errors,
                                                 &predict_order, &predict_overhead, NULL};

static const struct measure_target TARGETS[] = {
    {"trace_slowdown", 1.02, false},          {"predict_1e6_seconds", 1, false},
    {"predict_1e6_bytes", 1073741824, false}, {"predict_error_median", 0.1, false},
    {"predict_error_worst", 0.25, false},     {"rank_order_agrees", 0.95, true},
    {"compare_overhead", 1.01, false},        {0}};
enum { TARGET_THREADS = 2, MANY = 1000000, FEW = 10000 };

/* ---- The folder of the traces: the processes that are measured know it by the environment ---- */

#define FOLDER "DUITE_BENCH_TRACES"

char *predict_path(const char *name)
{
    const char *folder = getenv(FOLDER);
    char *path = NULL;
    return !folder || asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

static int make_folder(void)
{
    char folder[TEMPORARY_PATH];
    const int code = temporary_make(NULL, "duite-traces", folder);
    return code || !setenv(FOLDER, folder, 1) ? code : serve_no_memory();
}

static void finish(void)
{
    const char *folder = getenv(FOLDER);
    if (folder)
        temporary_remove(folder);
    predict_quota_end();
}

static int prepare(const struct bench_options *options,
                   void (*say)(const char *key, const char *text))
{
    const int code = make_folder() || predict_make_many(options->quick ? FEW : MANY);
    if (code)
        fprintf(stderr, "duite-bench: %s\n", serve_failure());
    else
        say("trace_many", options->quick ? "10000 tasks" : "1000000 tasks");
    return code;
}

static int serve_predict(const struct bench *bench)
{
    static struct sheet sheet;
    const struct serve_run *const runs[] = {bench->cases[0]->runs, bench->cases[1]->runs,
                                            predict_overhead.runs, NULL};
    return serve("duite_options_default() but for threads, policies and trace", runs, &sheet);
}

const struct bench bench_compare = {
    "compare",      "what a trace and duite-compare cost, and predictions against runs",
    CASES,          TARGETS,
    TARGET_THREADS, serve_predict,
    prepare,        finish};
