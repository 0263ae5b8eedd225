/* A step of a large sheet by the default solver, traced on this machine and predicted on hosts of
 * 16 or of 64 cores. Efficiency is against the same trace on one core. Bodies take the median of
 * their kernel: what this machine does beside them belongs to no other. */
#include "bench/scale/scale.h"
#include "bench/temporary.h"

#include "tools/predict/predict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 1000, GRAIN = 1000, QUICK_SIDE = 60, QUICK_GRAIN = 50, CORES = 16 };
/* 16 million vertices in blocks of 1,000 do not fit this machine: 4 million in as many blocks of
 * 250 do. Bodies then take four times as long, but for those of the coarse space, which are of
 * blocks, however large these are; halos have twice the bytes, for which the network
 * has half the bandwidth. */
enum { VAST_SIDE = 2000, VAST_GRAIN = 250, VAST_HOSTS = 64, VAST_CORES = 64, LARGER = 4 };

static const struct network {
    const char *name;
    double latency, bandwidth, message; /* s, bytes/s, s of a core for each message */
} NETWORKS[] = {{"tcp", 1e-5, 1.25e9, 5e-6}, {"fast", 1.5e-6, 1.25e10, 5e-7}};
enum { N_NETWORKS = sizeof NETWORKS / sizeof *NETWORKS };

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned side = options->quick ? QUICK_SIDE : SIDE;
    const unsigned grain = options->quick ? QUICK_GRAIN : GRAIN;
    measure->cold = true;
    for (int i = 0; i < N_NETWORKS; i++)
        for (unsigned hosts = 1; hosts <= 16; hosts *= 2) {
            const struct measure_series *series =
                measure_series(measure, (struct subject_shape){"duite", 0, options->threads},
                               "scaling side=%u grain=%u threads=%u hosts=%u network=%s", side,
                               grain, options->threads, hosts, NETWORKS[i].name);
            measure_value(measure, series, 1, "", "scaling_%ux%d_%s", hosts, CORES,
                          NETWORKS[i].name);
        }
    const struct measure_series *coarse = measure_series(
        measure, (struct subject_shape){"duite", 0, options->threads},
        "coarse side=%u grain=%u threads=%u hosts=16 network=fast", side, grain, options->threads);
    measure_value(measure, coarse, 1, "", "coarse_path_share");
}

enum { VAST_SCALING, VAST_MAIN, VAST_PATH, N_VAST };
static const struct {
    const char *what, *name;
} VAST[N_VAST] = {
    {"scaling", "scaling_%dx%d_fast"}, {"main", "main_share_%dx%d"}, {"path", "path_share_%dx%d"}};

static void plan_vast(struct measure *measure, const struct bench_options *options)
{
    measure->cold = true;
    for (int i = 0; i < N_VAST; i++) {
        const struct measure_series *series = measure_series(
            measure, (struct subject_shape){"duite", 0, options->threads},
            "vast side=%d grain=%d threads=%u what=%s", options->quick ? QUICK_SIDE : VAST_SIDE,
            options->quick ? QUICK_GRAIN : VAST_GRAIN, options->threads, VAST[i].what);
        measure_value(measure, series, 1, "", VAST[i].name, VAST_HOSTS, VAST_CORES);
    }
}

/* The trace of a step, made when it is asked for; the last one is kept. fresh: it shall be a new
 * one. NULL, and serve_fail. */
static struct trace_run *trace_of(struct serve_request *request, bool fresh)
{
    static struct trace_run *run;
    static uint64_t side;
    char folder[TEMPORARY_PATH], arguments[SCALE_PATH + 200], path[SCALE_PATH + 20];
    if (run && side == serve_number(request, "side") && !fresh)
        return run;
    trace_run_free(run);
    run = NULL;
    side = serve_number(request, "side");
    if (temporary_make(NULL, "duite-scale", folder))
        return NULL;
    snprintf(path, sizeof path, "%s/trace", folder);
    snprintf(arguments, sizeof arguments, "--threads %u --end 0.003 --trace-steps 1:2 --trace '%s'",
             (unsigned)serve_number(request, "threads"), path);
    if (!scale_cloth("", (unsigned)serve_number(request, "side"),
                     (unsigned)serve_number(request, "grain"), arguments) &&
        trace_read(&run, path, false)) {
        run = NULL;
        serve_fail("%s", duite_message());
    }
    temporary_remove(folder);
    return run;
}

static struct predict_cluster cluster_of(uint32_t hosts, uint32_t cores,
                                         const struct network *network)
{
    return (struct predict_cluster){.hosts = hosts,
                                    .cores = cores,
                                    .latency = network->latency,
                                    .bandwidth = network->bandwidth,
                                    .capacity = INFINITY,
                                    .core_speed = 1,
                                    .overhead = -1,
                                    .message = network->message,
                                    .look = -1,
                                    .steady = true,
                                    .packed = true,
                                    .scheduler = duite_scheduler_find("steal"),
                                    .mapping = duite_mapping_find("metis"),
                                    .seed = 1};
}

/* chain: NULL, or room for the seconds of each kernel on the chain that holds up the last task. */
static double makespan(const struct trace_run *run, uint32_t hosts, uint32_t cores,
                       const struct network *network, double *chain)
{
    const struct predict_cluster cluster = cluster_of(hosts, cores, network);
    const struct predict_more more = {.chain = chain};
    struct predict_result result;
    return predict(run, &cluster, &result, &more) ? NAN : result.makespan;
}

static const struct network *network_of(const struct serve_request *request)
{
    const struct network *network = NETWORKS;
    char name[20];
    serve_word(request, "network", name, sizeof name);
    while (network < NETWORKS + N_NETWORKS - 1 && strcmp(network->name, name))
        network++;
    return network;
}

/* scaling side= grain= threads= hosts= network=: the efficiency. */
static int run_scaling(void *context, struct serve_request *request, double *value)
{
    const struct network *network = network_of(request);
    const uint32_t hosts = (uint32_t)serve_number(request, "hosts");
    const struct trace_run *run = trace_of(request, false);
    (void)context;
    if (!run)
        return 1;
    const double all = hosts * CORES * makespan(run, hosts, CORES, network, NULL);
    *value = makespan(run, 1, 1, network, NULL) / all;
    return isnan(*value) ? serve_fail("%s", duite_message()) : 0;
}

/* The tasks of the coarse space: those of groups, and those that every rank runs. */
static bool is_coarse(const char *kernel)
{
    return !strncmp(kernel, "group_", strlen("group_")) || strstr(kernel, "coarse");
}

static bool grows(const char *kernel)
{
    return !is_coarse(kernel);
}

static int predict_larger(const struct trace_run *run, uint32_t hosts, uint32_t cores,
                          struct predict_result *result)
{
    struct predict_cluster cluster = cluster_of(hosts, cores, NETWORKS + 1);
    cluster.bodies = LARGER;
    cluster.grows = grows;
    cluster.bandwidth *= 0.5;
    return predict(run, &cluster, result, NULL) ? serve_fail("%s", duite_message()) : 0;
}

static int predict_vast(struct serve_request *request, double figure[N_VAST])
{
    struct predict_result all, one;
    const struct trace_run *run = trace_of(request, true);
    if (!run || predict_larger(run, 1, 1, &one) ||
        predict_larger(run, VAST_HOSTS, VAST_CORES, &all))
        return 1;
    figure[VAST_SCALING] = one.makespan / (VAST_HOSTS * VAST_CORES * all.makespan);
    figure[VAST_MAIN] = all.chain[PREDICT_MAIN] / all.makespan;
    figure[VAST_PATH] = all.chain[PREDICT_PATH] / all.makespan;
    return 0;
}

/* vast side= grain= threads= what=: the efficiency ("scaling"); of the time, what the main program
 * ("main") or the critical path ("path") holds up. Each is told once of a trace, so that rounds
 * have traces of their own: a pause of the machine in the traced step changes all three. */
static int run_vast(void *context, struct serve_request *request, double *value)
{
    static double figure[N_VAST] = {NAN, NAN, NAN}; /* NAN: told, or not known */
    char what[16];
    int i = 0;
    (void)context;
    serve_word(request, "what", what, sizeof what);
    while (i < N_VAST - 1 && strcmp(VAST[i].what, what) != 0)
        i++;
    if (isnan(figure[i]) && predict_vast(request, figure))
        return 1;
    *value = figure[i];
    figure[i] = NAN;
    return 0;
}

/* coarse side= grain= threads= hosts= network=: their share of the chain. */
static int run_coarse(void *context, struct serve_request *request, double *value)
{
    const struct trace_run *run = trace_of(request, false);
    double *chain = run ? calloc(run->n_kernels + 1u, sizeof *chain) : NULL;
    (void)context;
    if (!run || !chain)
        return run ? serve_no_memory() : 1;
    const double all =
        makespan(run, (uint32_t)serve_number(request, "hosts"), CORES, network_of(request), chain);
    *value = 0;
    for (uint32_t k = 0; k < run->n_kernels; k++)
        *value += is_coarse(run->kernel_name[k]) ? chain[k] / all : 0;
    free(chain);
    return isnan(*value) ? serve_fail("%s", duite_message()) : 0;
}

static const struct serve_run RUNS[] = {
    {"scaling", run_scaling}, {"coarse", run_coarse}, {"vast", run_vast}, {0}};

const struct bench_case scale_predicted = {
    "predicted", "a step of a million vertices on 1 to 16 hosts of 16 cores, predicted", plan, RUNS,
    1};

const struct bench_case scale_vast = {
    "vast", "a step of 16 million vertices on 64 hosts of 64 cores, predicted: wants 8 GB",
    plan_vast, NULL, 3};
