/* Messages of a rank. Those of an iteration of the default solver are the difference of the
 * counters of two runs, one of which makes more iterations; those of a wait are counted by the
 * network of its host. */
#include "bench/scale/scale.h"
#include "bench/temporary.h"

#include <duite.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HOSTS = 8, SIDE = 150, GRAIN = 200, QUICK_SIDE = 40, QUICK_GRAIN = 50 };
enum { FEW = 10, MORE = 20, WAITS = 500, QUICK_WAITS = 20 };

/* ---- An iteration ---- */

static const struct measure_series *iterations(struct measure *measure,
                                               const struct bench_options *options, unsigned count)
{
    return measure_series(measure, (struct subject_shape){"duite_hosts", 0, 1},
                          "iterations hosts=%d side=%d grain=%d count=%u", HOSTS,
                          options->quick ? QUICK_SIDE : SIDE, options->quick ? QUICK_GRAIN : GRAIN,
                          count);
}

static double per_iteration(const struct measure_metric *metric, size_t round)
{
    const double few = metric->against->sample[round], more = metric->of->sample[round];
    return (more - few) / ((MORE - FEW) * HOSTS);
}

static void plan_messages(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *few = iterations(measure, options, FEW);
    const struct measure_series *more = iterations(measure, options, MORE);
    struct measure_metric *metric =
        measure_metric(measure, "", per_iteration, "messages_per_iteration_r%d", HOSTS);
    metric->of = more;
    metric->against = few;
    metric->n = 1;
}

static int read_messages(const char *folder, double *messages)
{
    char path[SCALE_PATH + 20], line[4000];
    snprintf(path, sizeof path, "%s/report", folder);
    FILE *file = fopen(path, "r");
    *messages = NAN;
    while (file && fgets(line, sizeof line, file))
        sscanf(line, " \"messages\": %lf", messages);
    if (file)
        fclose(file);
    return isnan(*messages) ? serve_fail("a report has no messages") : 0;
}

/* iterations hosts= side= grain= count=: the messages of all ranks in a step of so many. */
static int run_iterations(void *context, struct serve_request *request, double *value)
{
    char folder[TEMPORARY_PATH], before[SCALE_PATH], arguments[SCALE_PATH + 200];
    const unsigned hosts = (unsigned)serve_number(request, "hosts");
    (void)context;
    int code = temporary_make(NULL, "duite-scale", folder);
    if (code)
        return code;
    snprintf(before, sizeof before, "sh '%s' %u '%s' --bind-to none -n %u", BENCH_HOSTS, hosts,
             BENCH_MPIRUN, hosts);
    snprintf(arguments, sizeof arguments,
             "--threads 1 --end 0.001 --set 'solver.stop={count: %u}' --report '%s/report'",
             (unsigned)serve_number(request, "count"), folder);
    code = scale_cloth(before, (unsigned)serve_number(request, "side"),
                       (unsigned)serve_number(request, "grain"), arguments);
    if (!code)
        code = read_messages(folder, value);
    temporary_remove(folder);
    return code;
}

/* ---- A wait ---- */

static void plan_wait(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *sent =
        measure_series(measure, (struct subject_shape){"duite_hosts", HOSTS, 1}, "wait waits=%d",
                       options->quick ? QUICK_WAITS : WAITS);
    measure_value(measure, sent, 1, "", "wait_messages_r%d", HOSTS);
}

/* The segments with data that this host sent by TCP, each for the first time; a message that is
 * small is one. 0: the system does not say. */
static double segments_sent(void)
{
    static char names[4096], numbers[4096];
    FILE *file = fopen("/proc/self/net/netstat", "r");
    double sent = 0;
    while (file && fgets(names, sizeof names, file) && fgets(numbers, sizeof numbers, file)) {
        char *rest_names, *rest_numbers;
        const char *name = strtok_r(names, " \n", &rest_names);
        const char *number = strtok_r(numbers, " \n", &rest_numbers);
        for (; name && number; name = strtok_r(NULL, " \n", &rest_names),
                               number = strtok_r(NULL, " \n", &rest_numbers))
            if (!strcmp(name, "TCPOrigDataSent"))
                sent = atof(number);
    }
    if (file)
        fclose(file);
    return sent;
}

/* wait waits=: what this rank sends in each; the bench takes the largest of all ranks. */
static int run_wait(void *context, struct serve_request *request, double *value)
{
    static const duite_kernel *const none[] = {NULL};
    const uint64_t waits = serve_number(request, "waits");
    duite_options options = duite_options_default();
    duite *rt = NULL;
    (void)context;
    options.kernels = none;
    options.threads = 1;
    options.bind = 0; /* hosts on one machine know nothing of each other's cores */
    int code = duite_start(&rt, &options) || duite_wait(rt);
    const double before = segments_sent();
    for (uint64_t i = 0; i < waits && !code; i++)
        code = duite_wait(rt);
    *value = waits ? (segments_sent() - before) / (double)waits : 0;
    if (code)
        code = serve_fail("%s", duite_message());
    if (rt && duite_stop(&rt) && !code)
        code = serve_fail("%s", duite_message());
    return !code && !(*value > 0) ? serve_fail("the system does not count segments") : code;
}

static const struct serve_run ITERATION_RUNS[] = {{"iterations", run_iterations}, {0}};
static const struct serve_run WAIT_RUNS[] = {{"wait", run_wait}, {0}};

const struct bench_case scale_messages = {
    "messages", "what a rank of eight sends in an iteration of the default solver", plan_messages,
    ITERATION_RUNS, 2};
const struct bench_case scale_wait = {"wait", "what a rank of eight sends in a duite_wait",
                                      plan_wait, WAIT_RUNS, 4};
