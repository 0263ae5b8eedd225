/* A step of a stencil on a line of points, replayed, over as many ranks as there are cores: 1 point
 * a rank, and 32. Against the same by hand for MPI. */
#include "bench/ranks/ranks.h"

#include <stdlib.h>

static void plan_points(struct measure *measure, const struct bench_options *options,
                        unsigned points, const char *name)
{
    const unsigned ranks = options->threads, steps = options->quick ? 20 : 4000;
    const struct measure_series *ours = measure_series(
        measure, ranks_ours(ranks, 1), "line points=%u steps=%u threads=1 scheduler=%s",
        ranks * points, steps, options->scheduler);
    const struct measure_series *mpi =
        measure_series(measure, (struct subject_shape){"mpi", ranks, 1}, "line points=%u steps=%u",
                       ranks * points, steps);
    measure_value(measure, ours, 1e6 / steps, "us", "%s_us", name);
    measure_value(measure, mpi, 1e6 / steps, "us", "%s_twin_us", name);
    measure_ratio(measure, ours, mpi, "%s_vs_twin", name);
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    plan_points(measure, options, 1, "stencil_step");
    plan_points(measure, options, 32, "stencil_step_32");
}

/* ---- Ours ---- */

struct point_args {
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
    if (problem_line_point(left, middle, right, duite_out(call, 0, struct problem_message)))
        return duite_fail(call, 1, "the neighbours are not of step %llu",
                          (unsigned long long)middle->step);
    return 0;
}

static const duite_kernel POINT = {.name = "line_point",
                                   .body = point,
                                   .access = {DUITE_W, DUITE_R},
                                   .variadic = DUITE_R,
                                   .args_size = sizeof(struct point_args)};

struct line {
    duite_object *object; /* first the points of one field, then those of the other */
    size_t points;
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
            const struct point_args args = {i > 0, i + 1 < points};
            duite_object objects[4] = {new[i], old[i]};
            size_t n = 2;
            if (args.left)
                objects[n++] = old[i - 1];
            if (args.right)
                objects[n++] = old[i + 1];
            code |= duite_fork(rt, &POINT, &args, n, objects);
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
    problem_line(right, line->points, 2 * rounds->rounds);
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

/* Each rank has a range of the line. */
static int new_line(duite *rt, const struct line *line)
{
    const duite_object *point = line->object;
    int code = 0;
    for (size_t i = 0; i < 2 * line->points; i++)
        code |= duite_new(rt, DUITE_I64, 2, &line->object[i]);
    for (size_t i = 0; i < line->points; i++) {
        code |= duite_colocate(rt, point[line->points + i], point[i]);
        if (i)
            code |= duite_hint(rt, point[i], 1, 1, &point[i - 1], NULL);
    }
    return tasks_code(code);
}

static int run_line(duite *rt, struct line *line, uint64_t steps, double *value)
{
    struct tasks_rounds rounds = {
        .rt = rt, .fork = fork_round, .context = line, .rounds = steps / 20, .replayed = true};
    int code = tasks_record(&rounds);
    if (!code)
        code = time_line(&rounds, value); /* a tenth, to get warm */
    rounds.rounds = steps / 2;
    if (!code)
        code = time_line(&rounds, value);
    tasks_forget(&rounds);
    return code;
}

static int run(void *context, struct serve_request *request, double *value)
{
    static const duite_kernel *const kernels[] = {&POINT, NULL};
    struct line line = {.points = serve_number(request, "points")};
    duite_options options = duite_options_default();
    duite *rt = NULL;
    options.kernels = kernels;
    line.object = calloc(2 * line.points, sizeof *line.object);
    int code = line.object ? ranks_start(context, request, &options, &rt) : serve_no_memory();
    if (!code)
        code = new_line(rt, &line);
    if (!code)
        code = run_line(rt, &line, serve_number(request, "steps"), value);
    for (size_t i = 0; !code && i < 2 * line.points; i++)
        code = tasks_code(duite_free(rt, line.object[i]));
    if (!code)
        code = tasks_code(duite_wait(rt)); /* before one rank leaves the others */
    free(line.object);
    return ranks_stop(&rt, code);
}

static const struct serve_run RUNS[] = {{"line", run}, {0}};

const struct bench_case ranks_stencil = {
    "stencil", "a step of empty tasks over ranks, 1 and 32 points each", plan, RUNS, 0};
