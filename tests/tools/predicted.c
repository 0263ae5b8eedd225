/* A trace that a test has made is a file of this process only as long as it is read. */
#include "tests/tools/predicted.h"

#include "runtime/map/map.h"
#include "runtime/sched/sched.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static char path[64];

struct predict_cluster predicted_machine(uint32_t hosts, uint32_t cores)
{
    return (struct predict_cluster){.hosts = hosts,
                                    .cores = cores,
                                    .latency = 0,
                                    .bandwidth = 1e12,
                                    .capacity = INFINITY,
                                    .core_speed = 1,
                                    .overhead = 0,
                                    .scheduler = &sched_fifo,
                                    .mapping = hosts > 1 ? &map_block : NULL,
                                    .seed = 1};
}

struct trace_run *predicted_run(struct trace_file *file)
{
    struct trace_run *run;
    snprintf(path, sizeof path, "test_predict.%d.trace", (int)getpid());
    ck_assert(trace_file_write(file, path));
    ck_assert_int_eq(trace_read(&run, path, false), DUITE_OK);
    unlink(path);
    return run;
}

struct predict_result predicted(struct trace_file *file, const struct predict_cluster *cluster)
{
    struct predict_result result, again;
    struct trace_run *run = predicted_run(file);
    ck_assert_msg(!predict(run, cluster, &result, NULL), "%s", duite_message());
    ck_assert_int_eq(predict(run, cluster, &again, NULL), DUITE_OK);
    ck_assert_msg(!memcmp(&result, &again, offsetof(struct predict_result, limit)) &&
                      result.limit == again.limit, /* what is behind it is padding */
                  "not the same twice");
    trace_run_free(run);
    return result;
}

struct trace_file predicted_trace(uint32_t n, uint64_t bytes)
{
    struct trace_file file = {0};
    for (uint32_t slot = 1; slot <= n; slot++)
        trace_file_object(&file, slot, bytes);
    trace_file_begin(&file, n);
    return file;
}
