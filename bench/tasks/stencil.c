/* A ring of points, step after step; a task reads three points of one field and writes one of the
 * other. A run is timed with empty bodies, after the same tasks with bodies whose answer is
 * checked. */
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <stdlib.h>

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"dynamic", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", "starpu", NULL};
    unsigned points = options->quick ? 8 : 64, steps = options->quick ? 5 : 200;
    char size[60];
    snprintf(size, sizeof size, "points=%u steps=%u", points, steps);
    tasks_plan_contest(measure, options,
                       &(struct tasks_contest){.name = "stencil",
                                               .size = size,
                                               .tasks = (double)points * steps,
                                               .variants = variants,
                                               .rivals = rivals});
}

static int combine(const duite_call *call)
{
    problem_combine(duite_in(call, 0, uint64_t), duite_in(call, 1, uint64_t),
                    duite_in(call, 2, uint64_t), duite_out(call, 3, uint64_t));
    return 0;
}

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

#define STENCIL_ACCESS                                                                             \
    {                                                                                              \
        DUITE_R, DUITE_R, DUITE_R, DUITE_W                                                         \
    }
const duite_kernel tasks_stencil_combine = {
    .name = "stencil_combine", .body = combine, .access = STENCIL_ACCESS};
const duite_kernel tasks_stencil_empty = {
    .name = "stencil_empty", .body = nothing, .access = STENCIL_ACCESS};

/* object: first the points of one field, then those of the other */
static void fork_all(duite *rt, const duite_kernel *kernel, const duite_object *object,
                     size_t points, size_t steps)
{
    for (size_t s = 0; s < steps; s++) {
        const duite_object *old = object + s % 2 * points, *new = object + (1 - s % 2) * points;
        for (size_t i = 0; i < points; i++)
            DUITE_FORK(rt, kernel, NULL, old[i ? i - 1 : points - 1], old[i],
                       old[i + 1 < points ? i + 1 : 0], new[i]);
    }
}

/* Sets the start values, runs, and compares. */
static int check(duite *rt, const duite_object *object, size_t points, size_t steps)
{
    struct problem_cell *got[2];
    if (problem_fields(got, points))
        return serve_no_memory();
    for (size_t i = 0; i < points; i++)
        duite_set(rt, object[i], &got[0][i].value);
    fork_all(rt, &tasks_stencil_combine, object, points, steps);
    int code = 0;
    for (size_t i = 0; i < points && !code; i++)
        code = tasks_code(duite_get(rt, object[steps % 2 * points + i], &got[0][i].value));
    if (!code && problem_stencil_wrong(got[0], points, steps))
        code = serve_fail("wrong answer");
    free(got[0]);
    return code;
}

/* Every body has run, once. */
static int time_empty(duite *rt, const duite_object *object, size_t points, size_t steps,
                      double *value)
{
    duite_counters before, after;
    if (duite_wait(rt) || duite_count_all(rt, &before))
        return tasks_code(1);
    double start = serve_seconds();
    fork_all(rt, &tasks_stencil_empty, object, points, steps);
    int code = duite_wait(rt);
    *value = serve_seconds() - start;
    if (code || duite_count_all(rt, &after))
        return tasks_code(1);
    uint64_t ran = after.tasks - before.tasks;
    return ran == points * steps ? 0 : serve_fail("%zu bodies ran", (size_t)ran);
}

static int dynamic(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    size_t points = serve_number(request, "points"), steps = serve_number(request, "steps");
    int code = tasks_ready(session, request);
    duite_object *object = calloc(2 * points, sizeof *object);
    if (!code && !object)
        code = serve_no_memory();
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, 2 * points, object);
    if (!code) {
        code = check(session->rt, object, points, steps);
        if (!code)
            code = time_empty(session->rt, object, points, steps, value);
        tasks_free_objects(session, 2 * points, object);
    }
    free(object);
    return code;
}

static int sequential(void *context, struct serve_request *request, double *value)
{
    static problem_point *const volatile combine_body = problem_combine,
                                         *const volatile empty_body = problem_nothing;
    size_t points = serve_number(request, "points"), steps = serve_number(request, "steps");
    struct problem_cell *field[2];
    (void)context;
    if (problem_fields(field, points))
        return serve_no_memory();
    problem_sweep(field, points, steps, &combine_body);
    double start = serve_seconds();
    problem_sweep(field, points, steps, &empty_body);
    *value = serve_seconds() - start;
    free(field[0]);
    return 0;
}

static const struct serve_run RUNS[] = {
    {"stencil_dynamic", dynamic}, {"stencil_sequential", sequential}, {0}};

const struct bench_case tasks_stencil = {
    "stencil", "a ring of points: 3 reads and 1 write a task, empty bodies", plan, RUNS};
