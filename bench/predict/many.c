/* A million tasks on 4,096 hosts of 16 cores, predicted: a stencil of 1,000 objects, of which each
 * task reads two and changes one. Its trace is written by hand, since nothing depends on what ran.
 */
#include "bench/predict/predict.h"

#include "runtime/map/map.h"
#include "runtime/sched/sched.h"
#include "tests/support/trace_file.h"
#include "tools/predict/predict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { OBJECTS = 1000, MANY = 1000000, FEW = 10000 };

int predict_make_many(uint32_t tasks)
{
    struct trace_file file = {0};
    char *path = predict_path(PREDICT_MANY);
    for (uint32_t slot = 1; slot <= OBJECTS; slot++)
        trace_file_object(&file, slot, 800);
    trace_file_begin(&file, OBJECTS);
    for (uint32_t i = 0; i < tasks; i++) {
        const uint32_t at = i % OBJECTS;
        trace_file_fork(
            &file, FILE_RR_RW, 1e-5 + 1e-8 * (i % 7), 0, 3,
            (const uint32_t[]){(at + 1) % OBJECTS + 1, (at + 999) % OBJECTS + 1, at + 1});
    }
    const int code = path && trace_file_write(&file, path)
                         ? 0
                         : serve_fail("the trace of many tasks cannot be written");
    free(path);
    return code;
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    const struct subject_shape own = {"duite", 0, 1};
    const unsigned tasks = options->quick ? FEW : MANY;
    const struct measure_series *seconds = measure_series(measure, own, "many tasks=%u", tasks);
    struct measure_series *bytes = measure_series(measure, own, "many_bytes tasks=%u", tasks);
    bytes->fresh = true;
    measure_value(measure, seconds, 1, "s", "predict_1e6_seconds");
    measure_value(measure, bytes, 1, "B", "predict_1e6_bytes");
}

static int many_predict(struct serve_request *request)
{
    const struct predict_cluster cluster = {.hosts = 4096,
                                            .cores = 16,
                                            .latency = 5e-6,
                                            .bandwidth = 1.25e9,
                                            .capacity = INFINITY,
                                            .core_speed = 1,
                                            .overhead = 1e-7,
                                            .scheduler = &sched_steal,
                                            .mapping = &map_block,
                                            .seed = 1};
    const uint64_t tasks = serve_number(request, "tasks");
    struct predict_result result = {0};
    struct trace_run *run = NULL;
    char *path = predict_path(PREDICT_MANY);
    int code = !path || trace_read(&run, path, false) || predict(run, &cluster, &result, NULL)
                   ? serve_fail("%s", duite_message())
                   : 0;
    if (!code && (result.tasks != tasks || !(result.makespan >= result.critical_path)))
        code = serve_fail("wrong answer: %g tasks in %g s", (double)result.tasks, result.makespan);
    trace_run_free(run);
    free(path);
    return code;
}

static int many(void *context, struct serve_request *request, double *value)
{
    (void)context;
    const double begin = serve_seconds();
    const int code = many_predict(request);
    *value = serve_seconds() - begin;
    return code;
}

/* The most memory that the process ever had. */
static int many_bytes(void *context, struct serve_request *request, double *value)
{
    (void)context;
    const int code = many_predict(request);
    *value = (double)serve_most_bytes();
    return code;
}

static const struct serve_run RUNS[] = {{"many", many}, {"many_bytes", many_bytes}, {0}};

const struct bench_case predict_many = {
    "many", "a million tasks predicted on 4,096 hosts of 16 cores: time and memory", plan, RUNS, 0};
