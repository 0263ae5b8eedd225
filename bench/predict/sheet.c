/* The sheet of the cases, run in a configuration, or predicted from a trace. A run is traced, so
 * that both times are from the first event of the steps to the last. A rank has the host's memory
 * between it and another one: latency and bandwidth are those of messages there. */
#include "bench/predict/predict.h"

#include "tools/trace/sums.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 150, GRAIN = 1000, STEPS = 10, ITERATIONS = 30, QUICK_SIDE = 30, QUICK_GRAIN = 100 };
#define LATENCY   1e-6
#define BANDWIDTH 5e9
#define MESSAGE   2.5e-7

/* A bad mapping: the last rank has a quarter of the work of two. */
static int map_lopsided(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = 4 * i < 3 * graph->n ? 0 : n_ranks - 1;
    return 0;
}
static const duite_mapping LOPSIDED = {.size = sizeof(duite_mapping),
                                       .name = "lopsided",
                                       .summary = "three quarters on one rank",
                                       .map = map_lopsided};

static const duite_mapping *find_mapping(const char *name)
{
    return strcmp(name, LOPSIDED.name) ? duite_mapping_find(name) : &LOPSIDED;
}

struct measure_series *predict_series(struct measure *measure, const struct bench_options *options,
                                      const struct predict_config *config, const char *trace)
{
    const bool many = config->ranks > 1;
    return measure_series(
        measure, (struct subject_shape){"duite", many ? config->ranks : 0, config->threads},
        "sheet side=%d grain=%d threads=%u scheduler=%s mapping=%s balance=%s trace=%s",
        options->quick ? QUICK_SIDE : SIDE, options->quick ? QUICK_GRAIN : GRAIN, config->threads,
        config->scheduler, config->mapping, config->balance, trace);
}

/* Two hosts, of which the second is half as fast if `slow`. */
double predict_makespan(const struct trace_run *run, const struct predict_config *config, bool slow)
{
    struct predict_place place[] = {
        {2, config->threads, 1, 0.5 * LATENCY, BANDWIDTH, INFINITY},
        {2, config->threads, 0.5, 0.5 * LATENCY, BANDWIDTH, INFINITY},
        {2, 0, 1, 0, INFINITY, INFINITY},
    };
    const struct predict_platform unlike = {place, 2, 3};
    const struct predict_cluster cluster = {.hosts = config->ranks,
                                            .cores = config->threads,
                                            .latency = LATENCY,
                                            .bandwidth = BANDWIDTH,
                                            .capacity = INFINITY,
                                            .core_speed = 1,
                                            .platform = slow ? &unlike : NULL,
                                            .overhead = -1,
                                            .message = MESSAGE,
                                            .look = -1,
                                            .scheduler = duite_scheduler_find(config->scheduler),
                                            .mapping = find_mapping(config->mapping),
                                            .balance = duite_balancer_find(config->balance),
                                            .seed = 1};
    struct predict_result result;
    return predict(run, &cluster, &result, NULL) ? NAN : result.makespan;
}

/* All traces of a process are kept; the first one is of the round that is left out. */
static char *kept_path(size_t number)
{
    char name[40];
    snprintf(name, sizeof name, "sheet-%zu.trace", number);
    return predict_path(name);
}

struct trace_run *predict_read_sheet(size_t round)
{
    struct trace_run *run = NULL;
    char *path = kept_path(1 + round);
    if (path && trace_read(&run, path, false))
        run = NULL;
    free(path);
    return run;
}

/* ---- Runs ---- */

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

/* From the first event of the trace to its last: what is predicted, too. */
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
    if (sheet_own_rank() == 0 && mesh_grid(&sheet->cloth.mesh, 1, 1, side, side, MESH_SAME, &error))
        return serve_fail("%s", error.text);
    return sheet_flow(sheet);
}

static int sheet_run(void *context, struct serve_request *request, double *value)
{
    static size_t n_kept;
    struct sheet *sheet = context;
    char scheduler[40], mapping[40], balance[40], trace[40];
    int code = make_sheet(sheet, request);
    duite_options options = duite_options_default();
    serve_word(request, "scheduler", scheduler, sizeof scheduler);
    serve_word(request, "mapping", mapping, sizeof mapping);
    serve_word(request, "balance", balance, sizeof balance);
    serve_word(request, "trace", trace, sizeof trace);
    const bool none = !strcmp(trace, "no"), wall = !strcmp(trace, "wall");
    char *path = strcmp(trace, "kept") ? predict_path("run.trace") : kept_path(n_kept++);
    options.kernels = flow_kernels();
    options.context = sheet->flow;
    options.threads = (unsigned)serve_number(request, "threads");
    options.scheduler = duite_scheduler_find(scheduler);
    options.mapping = find_mapping(mapping);
    options.balance = duite_balancer_find(balance);
    options.trace = none ? NULL : path;
    options.trace_end = UINT64_MAX - 1; /* without what comes before the first step */
    const bool slow = !strcmp(trace, "slow") && sheet_own_rank() == 1;
    if (!code && slow)
        code = predict_quota(true);
    if (!code)
        code = path ? run_flow(sheet, &options, value) : serve_no_memory();
    if (slow && predict_quota(false) && !code)
        code = 1;
    if (!code && !none && !wall)
        code = span_of(path, value);
    free(path);
    sheet_free(sheet);
    return code;
}

const struct serve_run predict_sheet_runs[] = {{"sheet", sheet_run}, {0}};
