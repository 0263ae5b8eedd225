/* A step of a large sheet by the default solver, traced on this machine and predicted on hosts of
 * 16 cores. Efficiency is against the same trace on one core. Bodies take the median of their
 * kernel: what this machine does beside them belongs to no other. */
#include "bench/scale/scale.h"
#include "bench/temporary.h"

#include "runtime/predict/predict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 1000, GRAIN = 1000, QUICK_SIDE = 60, QUICK_GRAIN = 50, CORES = 16 };

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

/* The trace of a step, made when it is asked for first; NULL, and serve_fail. */
static struct trace_run *trace_of(struct serve_request *request)
{
    static struct trace_run *run;
    char folder[TEMPORARY_PATH], arguments[SCALE_PATH + 200], path[SCALE_PATH + 20];
    if (run || temporary_make(NULL, "duite-scale", folder))
        return run;
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

/* chain: NULL, or room for the seconds of each kernel on the chain that holds up the last task. */
static double makespan(const struct trace_run *run, uint32_t hosts, uint32_t cores,
                       const struct network *network, double *chain)
{
    const struct predict_cluster cluster = {.hosts = hosts,
                                            .cores = cores,
                                            .latency = network->latency,
                                            .bandwidth = network->bandwidth,
                                            .capacity = INFINITY,
                                            .core_speed = 1,
                                            .overhead = -1,
                                            .message = network->message,
                                            .steady = true,
                                            .packed = true,
                                            .scheduler = duite_scheduler_find("steal"),
                                            .mapping = duite_mapping_find("metis"),
                                            .seed = 1};
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
    const struct trace_run *run = trace_of(request);
    (void)context;
    if (!run)
        return 1;
    const double all = hosts * CORES * makespan(run, hosts, CORES, network, NULL);
    *value = makespan(run, 1, 1, network, NULL) / all;
    return isnan(*value) ? serve_fail("%s", duite_message()) : 0;
}

/* The tasks of the coarse space: those of groups, and those that every rank runs. */
static bool is_coarse(const struct trace_run *run, uint32_t kernel)
{
    return !strncmp(run->kernel_name[kernel], "group_", strlen("group_")) ||
           strstr(run->kernel_name[kernel], "coarse");
}

/* coarse side= grain= threads= hosts= network=: their share of the chain. */
static int run_coarse(void *context, struct serve_request *request, double *value)
{
    const struct trace_run *run = trace_of(request);
    double *chain = run ? calloc(run->n_kernels + 1u, sizeof *chain) : NULL;
    (void)context;
    if (!run || !chain)
        return run ? serve_no_memory() : 1;
    const double all =
        makespan(run, (uint32_t)serve_number(request, "hosts"), CORES, network_of(request), chain);
    *value = 0;
    for (uint32_t k = 0; k < run->n_kernels; k++)
        *value += is_coarse(run, k) ? chain[k] / all : 0;
    free(chain);
    return isnan(*value) ? serve_fail("%s", duite_message()) : 0;
}

static const struct serve_run RUNS[] = {{"scaling", run_scaling}, {"coarse", run_coarse}, {0}};

const struct bench_case scale_predicted = {
    "predicted", "a step of a million vertices on 1 to 16 hosts of 16 cores, predicted", plan, RUNS,
    1};
