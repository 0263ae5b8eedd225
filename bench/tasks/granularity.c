/* How short a body may be: a line of points, bodies of growing length, and the shortest one with
 * which the machine still does half of the work it can do (Slaughter et al., Task Bench, 2020: half
 * of their METG at 50 %, which adds the overhead to the body). Against a hand-written program of
 * as many MPI ranks as we have threads. */
#include "bench/tasks/tasks.h"

#include <math.h>
#include <stdlib.h>

enum { RUNGS = 15, SHORTEST = 1, WIDTHS = 2 };

/* Iterations a second of all cores, the most that anybody reached in the round. */
static double peak(const struct measure_metric *metric, size_t round)
{
    const struct measure_series *ladder[2] = {metric->of, metric->against};
    double most = 0;
    for (int side = 0; side < 2; side++)
        for (size_t i = 0; i < metric->n && ladder[side] && ladder[side]->sample; i++)
            most = fmax(most, ladder[side][i].work / ladder[side][i].sample[round]);
    return most;
}

/* Iterations of the shortest body with half of the peak, between two rungs on a line of logarithms;
 * NAN if no rung reaches it, or all do. */
static double half(const struct measure_series *ladder, size_t n, double top, size_t round)
{
    double below = 0, above = 1;
    size_t i = n;
    while (i > 0 && above >= 0.5) {
        i--;
        below = above;
        above = ladder[i].work / ladder[i].sample[round] / top;
    }
    if (above >= 0.5 || i + 1 == n)
        return NAN;
    double share = (0.5 - above) / (below - above);
    return SHORTEST * exp2((double)i + share);
}

static double microseconds(const struct measure_metric *metric, size_t round)
{
    double top = peak(metric, round);
    return metric->scale * 1e6 * half(metric->of, metric->n, top, round) / top;
}

static double against_mpi(const struct measure_metric *metric, size_t round)
{
    double top = peak(metric, round);
    return half(metric->of, metric->n, top, round) / half(metric->against, metric->n, top, round);
}

/* The rungs of one subject: bodies of SHORTEST x 2^i iterations. */
static struct measure_series *plan_ladder(struct measure *measure, struct subject_shape shape,
                                          const struct bench_options *options, const char *run,
                                          unsigned points)
{
    struct measure_series *first = NULL;
    unsigned steps = options->quick ? 20 : 16000 / points;
    for (unsigned i = 0; i < RUNGS; i++) {
        unsigned iterations = (unsigned)SHORTEST << i;
        struct measure_series *series = measure_series(
            measure, shape, "%s points=%u steps=%u iterations=%u threads=%u scheduler=%s", run,
            points, steps, iterations, shape.threads, options->scheduler);
        series->work = (double)points * steps * iterations;
        if (!first)
            first = series;
    }
    return first;
}

/* One metric of a ladder, or of two. */
static void add(struct measure *measure, const struct bench_options *options, const char *name,
                unsigned points, const struct measure_series *of,
                const struct measure_series *against)
{
    struct measure_metric *metric =
        against ? measure_metric(measure, "x", against_mpi, "%s_50_w%u_vs_mpi", name, points)
                : measure_metric(measure, "us", microseconds, "%s_50_w%u", name, points);
    metric->of = of;
    metric->against = against;
    metric->n = RUNGS;
    metric->scale = options->threads;
}

static void plan_width(struct measure *measure, const struct bench_options *options,
                       unsigned points)
{
    const struct subject_shape ours = tasks_ours(options->threads);
    const struct subject_shape ranks = {"mpi", options->threads, 1};
    const struct measure_series *replayed =
        plan_ladder(measure, ours, options, "granularity_replay", points);
    const struct measure_series *forked =
        plan_ladder(measure, ours, options, "granularity_dynamic", points);
    const struct measure_series *mpi = plan_ladder(measure, ranks, options, "granularity", points);
    add(measure, options, "granularity", points, replayed, NULL);
    add(measure, options, "granularity", points, replayed, mpi);
    add(measure, options, "granularity_dynamic", points, forked, NULL);
    add(measure, options, "granularity_dynamic", points, forked, mpi);
    add(measure, options, "granularity_mpi", points, mpi, NULL);
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const unsigned points[WIDTHS] = {2, 16};
    for (int i = 0; i < WIDTHS; i++)
        plan_width(measure, options, points[i]);
    unsigned steps = options->quick ? 20 : 1000;
    const struct measure_series *twin = measure_series(
        measure, tasks_twin(), "granularity_sequential points=%u steps=%u iterations=%d", points[1],
        steps, SHORTEST);
    measure_value(measure, twin, 1e9 / (points[1] * steps), "ns",
                  "granularity_sequential_ns_per_task");
}

/* ---- Ours ---- */

struct point_args {
    uint64_t iterations;
    int left, right; /* whether there are neighbours */
};

static int point(const duite_call *call)
{
    const struct point_args *args = call->args;
    const struct problem_message *middle = duite_in(call, 1, struct problem_message);
    const struct problem_message *left =
        args->left ? duite_in(call, 2, struct problem_message) : NULL;
    const struct problem_message *right =
        args->right ? duite_in(call, (size_t)(2 + args->left), struct problem_message) : NULL;
    if (problem_line_point(left, middle, right, args->iterations,
                           duite_out(call, 0, struct problem_message)))
        return duite_fail(call, 1, "the neighbours are not of step %llu",
                          (unsigned long long)middle->step);
    return 0;
}

const duite_kernel tasks_granularity_point = {.name = "granularity_point",
                                              .body = point,
                                              .access = {DUITE_W, DUITE_R},
                                              .variadic = DUITE_R,
                                              .args_size = sizeof(struct point_args)};

struct line {
    duite_object *object; /* first the points of one field, then those of the other */
    size_t points;
    uint64_t iterations;
};

/* Two steps: there and back. */
static int fork_round(duite *rt, void *context)
{
    const struct line *line = context;
    size_t points = line->points;
    int code = 0;
    for (size_t s = 0; s < 2; s++) {
        const duite_object *old = line->object + s * points, *new = line->object + (1 - s) * points;
        for (size_t i = 0; i < points; i++) {
            const struct point_args args = {line->iterations, i > 0, i + 1 < points};
            duite_object objects[4] = {new[i], old[i]};
            size_t n = 2;
            if (args.left)
                objects[n++] = old[i - 1];
            if (args.right)
                objects[n++] = old[i + 1];
            code |= duite_fork(rt, &tasks_granularity_point, &args, n, objects);
        }
    }
    return code;
}

/* Runs from the start values, and compares. */
static int time_line(struct tasks_rounds *rounds, double *value)
{
    const struct line *line = rounds->context;
    struct problem_message *right = calloc(2 * line->points, sizeof *right), got;
    if (!right)
        return serve_no_memory();
    problem_line(right, line->points, 2 * rounds->rounds, 0);
    for (size_t i = 0; i < line->points; i++)
        duite_set(rounds->rt, line->object[i], &(struct problem_message){0, problem_start(i)});
    int code = tasks_run(rounds, value);
    for (size_t i = 0; i < line->points && !code; i++) {
        code = tasks_code(duite_get(rounds->rt, line->object[i], &got));
        if (!code && (got.value != right[i].value || got.step != right[i].step))
            code = serve_fail("wrong answer");
    }
    free(right);
    return code;
}

/* On several ranks: each has a range of the line. */
static int place(duite *rt, const struct line *line)
{
    const duite_object *point = line->object;
    int code = 0;
    for (size_t i = 0; i < line->points; i++) {
        code |= duite_colocate(rt, point[line->points + i], point[i]);
        if (i)
            code |= duite_hint(rt, point[i], 1, 1, &point[i - 1], NULL);
    }
    return tasks_code(code);
}

static int run(struct tasks_session *session, struct serve_request *request, bool replayed,
               double *value)
{
    struct line line = {.points = serve_number(request, "points"),
                        .iterations = serve_number(request, "iterations")};
    uint64_t steps = serve_number(request, "steps");
    line.object = calloc(2 * line.points, sizeof *line.object);
    int code = line.object ? tasks_ready(session, request) : serve_no_memory();
    if (!code)
        code = tasks_objects(session, DUITE_I64, 2, 2 * line.points, line.object);
    if (!code)
        code = place(session->rt, &line);
    if (!code) {
        struct tasks_rounds rounds = {.rt = session->rt,
                                      .fork = fork_round,
                                      .context = &line,
                                      .rounds = steps / 20,
                                      .replayed = replayed};
        code = tasks_record(&rounds);
        if (!code)
            code = time_line(&rounds, value); /* a tenth, to get warm */
        rounds.rounds = steps / 2;
        if (!code)
            code = time_line(&rounds, value);
        tasks_forget(&rounds);
        tasks_free_objects(session, 2 * line.points, line.object);
    }
    free(line.object);
    return code;
}

static int dynamic(void *context, struct serve_request *request, double *value)
{
    return run(context, request, false, value);
}

static int replay(void *context, struct serve_request *request, double *value)
{
    return run(context, request, true, value);
}

static int sequential(void *context, struct serve_request *request, double *value)
{
    size_t points = serve_number(request, "points");
    uint64_t steps = serve_number(request, "steps");
    uint64_t iterations = serve_number(request, "iterations");
    struct problem_message *line = calloc(2 * points, sizeof *line);
    (void)context;
    if (!line)
        return serve_no_memory();
    double start = serve_seconds();
    int wrong = problem_line(line, points, steps, iterations);
    *value = serve_seconds() - start;
    free(line);
    return wrong ? serve_fail("wrong answer") : 0;
}

static const struct serve_run RUNS[] = {{"granularity_replay", replay},
                                        {"granularity_dynamic", dynamic},
                                        {"granularity_sequential", sequential},
                                        {0}};

const struct bench_case tasks_granularity = {
    "granularity", "the shortest body with half of peak speed, on 2 and 16 points", plan, RUNS, 0};
