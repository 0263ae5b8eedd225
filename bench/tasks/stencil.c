/* A ring of points, step after step; a task reads three points of one field and writes one of the
 * other. A run is timed with empty bodies, after the same tasks with bodies whose answer is
 * checked. "Once": the neighbours are others in each step, so that no round of forks comes again.
 */
#include "bench/tasks/tasks.h"

#include <duite_policy.h>

#include <stdio.h>
#include <stdlib.h>

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"replay", "dynamic", "once", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", "starpu", NULL};
    unsigned points = options->quick ? 8 : 64, steps = options->quick ? 6 : 200;
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

enum ring_way { RING_DYNAMIC, RING_REPLAY, RING_ONCE };

struct ring {
    const duite_kernel *kernel;
    duite_object *object; /* first the points of one field, then those of the other */
    size_t points, steps;
    enum ring_way way;
    size_t step; /* RING_ONCE: the next one */
};

/* How far away the neighbours are, to the left and to the right. */
static void ring_reach(size_t points, size_t step, size_t reach[2])
{
    uint64_t state = step;
    for (size_t side = 0; side < 2; side++)
        reach[side] = 1 + duite_random(&state) % (points / 2 - 1);
}

/* Two steps: there and back. */
static int fork_round(duite *rt, void *context)
{
    struct ring *ring = context;
    const size_t points = ring->points;
    size_t reach[2] = {1, 1};
    int code = 0;
    for (size_t s = 0; s < 2; s++) {
        const duite_object *old = ring->object + s * points, *new = ring->object + (1 - s) * points;
        if (ring->way == RING_ONCE)
            ring_reach(points, ring->step++, reach);
        for (size_t i = 0; i < points; i++) {
            const size_t left = i >= reach[0] ? i - reach[0] : i + points - reach[0];
            const size_t right = i + reach[1] < points ? i + reach[1] : i + reach[1] - points;
            code |= DUITE_FORK(rt, ring->kernel, NULL, old[left], old[i], old[right], new[i]);
        }
    }
    return code;
}

static bool once_is_wrong(const struct problem_cell *got, size_t points, size_t steps)
{
    struct problem_cell *field[2];
    if (problem_fields(field, points))
        return true;
    for (size_t step = 0; step < steps; step++) {
        const struct problem_cell *old = field[step % 2];
        size_t reach[2];
        ring_reach(points, step, reach);
        for (size_t i = 0; i < points; i++)
            problem_combine(&old[(i + points - reach[0]) % points].value, &old[i].value,
                            &old[(i + reach[1]) % points].value, &field[1 - step % 2][i].value);
    }
    bool wrong = false;
    for (size_t i = 0; i < points; i++)
        wrong |= got[i].value != field[steps % 2][i].value;
    free(field[0]);
    return wrong;
}

static struct tasks_rounds rounds(duite *rt, struct ring *ring, const duite_kernel *kernel)
{
    ring->kernel = kernel;
    ring->step = 0;
    return (struct tasks_rounds){.rt = rt,
                                 .fork = fork_round,
                                 .context = ring,
                                 .rounds = ring->steps / 2,
                                 .replayed = ring->way == RING_REPLAY};
}

/* Sets the start values, runs, and compares. */
static int check(duite *rt, struct ring *ring)
{
    struct tasks_rounds combined = rounds(rt, ring, &tasks_stencil_combine);
    struct problem_cell *got[2];
    double ignored;
    if (problem_fields(got, ring->points))
        return serve_no_memory();
    int code = tasks_record(&combined);
    for (size_t i = 0; i < ring->points; i++)
        duite_set(rt, ring->object[i], &got[0][i].value);
    if (!code)
        code = tasks_run(&combined, &ignored);
    for (size_t i = 0; i < ring->points && !code; i++)
        code = tasks_code(duite_get(rt, ring->object[i], &got[0][i].value));
    const bool wrong = ring->way == RING_ONCE
                           ? once_is_wrong(got[0], ring->points, ring->steps)
                           : problem_stencil_wrong(got[0], ring->points, ring->steps);
    if (!code && wrong)
        code = serve_fail("wrong answer");
    tasks_forget(&combined);
    free(got[0]);
    return code;
}

/* Every body has run, once. */
static int time_empty(duite *rt, struct ring *ring, double *value)
{
    struct tasks_rounds empty = rounds(rt, ring, &tasks_stencil_empty);
    duite_counters before = {0}, after = {0};
    int code = tasks_record(&empty);
    if (!code)
        code = tasks_code(duite_count_all(rt, &before));
    if (!code)
        code = tasks_run(&empty, value);
    if (!code)
        code = tasks_code(duite_count_all(rt, &after));
    tasks_forget(&empty);
    uint64_t ran = after.tasks - before.tasks;
    if (!code && ran != ring->points * ring->steps)
        code = serve_fail("%zu bodies ran", (size_t)ran);
    return code;
}

static int run(struct tasks_session *session, struct serve_request *request, enum ring_way way,
               double *value)
{
    size_t points = serve_number(request, "points"), steps = serve_number(request, "steps");
    int code = tasks_ready(session, request);
    struct ring ring = {.points = points, .steps = steps, .way = way};
    ring.object = calloc(2 * points, sizeof *ring.object);
    if (!code && !ring.object)
        code = serve_no_memory();
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, 2 * points, ring.object);
    if (!code) {
        code = check(session->rt, &ring);
        if (!code)
            code = time_empty(session->rt, &ring, value);
        tasks_free_objects(session, 2 * points, ring.object);
    }
    free(ring.object);
    return code;
}

static int dynamic(void *context, struct serve_request *request, double *value)
{
    return run(context, request, RING_DYNAMIC, value);
}

static int replay(void *context, struct serve_request *request, double *value)
{
    return run(context, request, RING_REPLAY, value);
}

static int once(void *context, struct serve_request *request, double *value)
{
    return run(context, request, RING_ONCE, value);
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

static const struct serve_run RUNS[] = {{"stencil_dynamic", dynamic},
                                        {"stencil_replay", replay},
                                        {"stencil_once", once},
                                        {"stencil_sequential", sequential},
                                        {0}};

const struct bench_case tasks_stencil = {
    "stencil", "a ring of points: 3 reads and 1 write a task, empty bodies", plan, RUNS, 0};
