/* Traces of up to three ranks: read, summed up, written in each form, drawn, and predicted. */
#include "tests/fuzz/fuzz.h"
#include "tools/chart/chart.h"
#include "tools/predict/predict.h"
#include "tools/trace/export.h"
#include "tools/trace/sums.h"

#include <math.h>
#include <stdio.h>

static void predict_run(const struct trace_run *run)
{
    struct predict_cluster cluster = {.hosts = run->n_ranks,
                                      .cores = 2,
                                      .latency = 5e-6,
                                      .bandwidth = 1e9,
                                      .capacity = (double)INFINITY,
                                      .core_speed = 1,
                                      .overhead = -1,
                                      .message = 5e-7,
                                      .look = -1,
                                      .scheduler = duite_scheduler_find("steal"),
                                      .seed = 1};
    struct predict_result result;
    predict(run, &cluster, &result, NULL);
    cluster.mapping = duite_mapping_find("metis");
    cluster.hosts = 2;
    cluster.steady = true;
    predict(run, &cluster, &result, NULL);
}

static void write_forms(const struct trace_run *run, FILE *file)
{
    const struct chart_options options = chart_options_default();
    struct predict_bounds bounds;
    char tables[256];
    trace_print(run, predict_bounds(run, &bounds) ? (double)NAN : bounds.path, file);
    predict_bounds_free(&bounds);
    trace_sums_agree(run, file);
    trace_export_paje.write(run, file);
    trace_export_chrome.write(run, file);
    snprintf(tables, sizeof tables, "%s/tables", fuzz_folder());
    trace_export_csv.write_folder(run, tables);
    predict_write_dot(run, file);
    predict_write_graph(run, file);
    chart_write_svg(run, &options, file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"trace", "trace.1", "trace.2"};
    static FILE *nowhere;
    char path[256];
    struct trace_run *run;
    if (!nowhere && !(nowhere = fopen("/dev/null", "w")))
        return 0;
    fuzz_files(3, names, data, size);
    snprintf(path, sizeof path, "%s/trace", fuzz_folder());
    for (int partial = 0; partial < 2; partial++)
        if (!trace_read(&run, path, partial)) {
            write_forms(run, nowhere);
            predict_run(run);
            trace_run_free(run);
        }
    return 0;
}
