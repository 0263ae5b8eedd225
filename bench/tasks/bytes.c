/* Memory of tasks that wait: what the process grows by, in pages that it holds, while it forks
 * stencil tasks behind a first one that does not end. A fresh process for each sample, since
 * memory once taken is not given back. */
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { POINTS = 64 };

struct padding {
    uint64_t step, point;
};

static void plan(struct measure *measure, const struct bench_options *options)
{
    unsigned steps = options->quick ? 100 : 1000000 / POINTS, threads = options->threads;
    struct measure_series *series =
        measure_series(measure, tasks_ours(threads), "bytes steps=%u threads=%u scheduler=%s",
                       steps, threads, options->scheduler);
    series->fresh = true;
    measure_value(measure, series, 1.0 / (steps * POINTS), "bytes", "bytes_per_pending_task");
}

/* Starts a chain per point at the gate's object, hands on, and counts steps. */
static int padded(const duite_call *call)
{
    const struct padding *args = call->args;
    uint64_t *out = duite_out(call, 3, uint64_t);
    for (size_t i = 0; i < 3 && args->step; i++)
        if (*duite_in(call, i, uint64_t) != args->step)
            return duite_fail(call, 1, "wrong answer");
    *out = args->step + 1;
    return 0;
}

const duite_kernel tasks_stencil_padded = {.name = "stencil_padded",
                                           .body = padded,
                                           .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                           .args_size = sizeof(struct padding)};

/* Bytes of memory that this process holds. */
static double resident(void)
{
    long size = 0, pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%ld %ld", &size, &pages) != 2)
        pages = 0;
    if (file)
        fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

/* object: two fields of points, then three that the gate holds */
static int fork_steps(duite *rt, const duite_object *object, size_t first, size_t steps)
{
    int code = 0;
    for (size_t s = first; s < steps && !code; s++) {
        const duite_object *old = object + s % 2 * POINTS, *new = object + (1 - s % 2) * POINTS;
        const duite_object *gates = object + 2 * POINTS;
        for (size_t i = 0; i < POINTS && !code; i++) {
            const struct padding args = {s, i};
            if (s)
                code = DUITE_FORK(rt, &tasks_stencil_padded, &args, old[i ? i - 1 : POINTS - 1],
                                  old[i], old[(i + 1) % POINTS], new[i]);
            else
                code = DUITE_FORK(rt, &tasks_stencil_padded, &args, gates[0], gates[1], gates[2],
                                  new[i]);
        }
    }
    return code;
}

static int check(duite *rt, const duite_object *object, uint64_t steps)
{
    uint64_t got;
    for (size_t i = 0; i < POINTS; i++)
        if (duite_get(rt, object[steps % 2 * POINTS + i], &got))
            return tasks_code(1);
        else if (got != steps)
            return serve_fail("wrong answer");
    return 0;
}

static int bytes(void *context, struct serve_request *request, double *value)
{
    enum { OBJECTS = 2 * POINTS + 3 };
    struct tasks_session *session = context;
    uint64_t steps = serve_number(request, "steps");
    duite_object object[OBJECTS];
    int code = tasks_ready(session, request);
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, OBJECTS, object);
    if (code)
        return code;
    duite *rt = session->rt;
    atomic_store(&session->gate, 0);
    duite_fork(rt, &tasks_gate_write, NULL, 1, &object[2 * POINTS]);
    fork_steps(rt, object, 0, 1); /* not counted: their objects are touched for the first time */
    double before = resident();
    code = fork_steps(rt, object, 1, steps + 1);
    *value = resident() - before;
    atomic_store(&session->gate, 1);
    code = code || duite_wait(rt) ? tasks_code(1) : check(rt, object, steps + 1);
    tasks_free_objects(session, OBJECTS, object);
    return code;
}

static const struct serve_run RUNS[] = {{"bytes", bytes}, {0}};

const struct bench_case tasks_bytes = {
    "bytes", "memory of 1,000,000 stencil tasks behind one that does not end", plan, RUNS, 0};
