/* How far a run on two hosts of a core each, which this machine plays, is from what duite-predict
 * makes of it: from its own trace, and from that of one rank on as many threads, which ran just
 * before it. Both take what messages cost from the run's trace. */
#include "bench/scale/scale.h"
#include "bench/temporary.h"

#include "tools/predict/predict.h"
#include "tools/trace/sums.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HOSTS = 2, SIDE = 150, GRAIN = 1000, QUICK_SIDE = 40, QUICK_GRAIN = 50 };
enum { STEPS = 35, QUICK_STEPS = 2 };

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const struct {
        const char *from, *name;
    } figures[] = {{"own", "prediction_error_r%d"}, {"one", "prediction_error_r%d_from_r1"}};
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        const struct measure_series *series =
            measure_series(measure, (struct subject_shape){"duite_hosts", 0, 1},
                           "run side=%d grain=%d steps=%d from=%s",
                           options->quick ? QUICK_SIDE : SIDE, options->quick ? QUICK_GRAIN : GRAIN,
                           options->quick ? QUICK_STEPS : STEPS, figures[i].from);
        measure_value(measure, series, 1, "", figures[i].name, HOSTS);
    }
}

/* Each rank has a core of its own: without taskset both hosts begin with the first one. */
static int run_cloth(struct serve_request *request, unsigned hosts, const char *trace)
{
    char before[SCALE_PATH], arguments[SCALE_PATH + 200];
    *before = '\0';
    if (hosts > 1)
        snprintf(before, sizeof before,
                 "sh '%s' %u '%s' --bind-to none -n %u "
                 "sh -c 'exec taskset -c ${OMPI_COMM_WORLD_RANK:-$PMI_RANK} \"$@\"' cloth",
                 BENCH_HOSTS, hosts, BENCH_MPIRUN, hosts);
    snprintf(arguments, sizeof arguments, "--threads %d --end %g --trace '%s'",
             hosts > 1 ? 1 : HOSTS, 1e-3 * (double)serve_number(request, "steps"), trace);
    return scale_cloth(before, (unsigned)serve_number(request, "side"),
                       (unsigned)serve_number(request, "grain"), arguments);
}

/* From the first event to the last one. */
static int span_of(const struct trace_run *run, double *seconds)
{
    struct trace_sums sums;
    if (trace_sum(run, &sums))
        return serve_fail("%s", duite_message());
    *seconds = sums.last - sums.first;
    trace_sums_free(&sums);
    return 0;
}

/* The run that was traced; `one`: NULL, or the trace of one rank to predict it from. */
static int compare(const struct trace_run *run, const struct trace_run *one, double *error)
{
    struct predict_cluster cluster = predict_cluster_default();
    cluster.hosts = HOSTS;
    cluster.cores = 1;
    cluster.latency = run->rank[0].header->latency;
    struct predict_result result;
    double seconds = 0;
    int code = predict(run, &cluster, &result, NULL);
    if (!code && one) {
        cluster.message = result.message;
        cluster.look = result.look;
        cluster.packed = true;
        cluster.mapping = duite_mapping_find("metis");
        code = predict(one, &cluster, &result, NULL);
    }
    if (code)
        return serve_fail("%s", duite_message());
    code = span_of(run, &seconds);
    *error = fabs(result.makespan / seconds - 1);
    return code;
}

static int read_trace(struct trace_run **run, const char *path)
{
    *run = NULL;
    return trace_read(run, path, false) ? serve_fail("%s", duite_message()) : 0;
}

/* run side= grain= steps= from=own|one. */
static int run_run(void *context, struct serve_request *request, double *value)
{
    struct trace_run *run = NULL, *one = NULL;
    char folder[TEMPORARY_PATH], own[SCALE_PATH + 8], single[SCALE_PATH + 8], from[8];
    (void)context;
    serve_word(request, "from", from, sizeof from);
    int code = temporary_make(NULL, "duite-scale", folder);
    if (code)
        return code;
    snprintf(own, sizeof own, "%s/own", folder);
    snprintf(single, sizeof single, "%s/one", folder);
    const bool from_one = !strcmp(from, "one");
    if (from_one)
        code = run_cloth(request, 1, single) || read_trace(&one, single);
    if (!code)
        code = run_cloth(request, HOSTS, own) || read_trace(&run, own);
    if (!code)
        code = compare(run, one, value);
    trace_run_free(run);
    trace_run_free(one);
    temporary_remove(folder);
    return code;
}

static const struct serve_run RUNS[] = {{"run", run_run}, {0}};

const struct bench_case scale_runs = {
    "runs", "a run on two hosts of a core each against what is predicted of it", plan, RUNS, 7};
