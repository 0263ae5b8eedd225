/* The plans of the cases. A process that runs has the states' folder in the environment. */
#include "bench/cg/cg.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ERROR = 10000 }; /* 1 % in the mass norm, in millionths */

struct subject_shape cg_ours(unsigned ranks, unsigned threads)
{
    return (struct subject_shape){"duite", ranks, threads};
}

struct measure_series *cg_series(struct measure *measure, const struct bench_options *options,
                                 struct subject_shape shape, const char *run, const char *state,
                                 const char *more)
{
    return measure_series(measure, shape, "%s state=%s threads=%u scheduler=%s quick=%d%s", run,
                          state, shape.threads, options->scheduler, options->quick, more);
}

struct measure_series *cg_petsc(struct measure *measure, const struct bench_options *options,
                                const char *run, const char *state, const char *more)
{
    const unsigned most = options->quick && strcmp(run, "cg") != 0 ? 1 : options->threads;
    struct measure_series *all = measure_series(measure, (struct subject_shape){"petsc", most, 1},
                                                "%s state=%s%s", run, state, more);
    if (most > 1)
        all->other = measure_series(measure, (struct subject_shape){"petsc", 1, 1}, "%s state=%s%s",
                                    run, state, more);
    return all;
}

/* ---- An iteration ---- */

static struct measure_series *twin(struct measure *measure, const struct bench_options *options,
                                   const char *state, const char *more)
{
    const struct subject_shape shape = {"openmp", 0, options->threads};
    struct measure_series *whole = measure_series(measure, shape, "cg state=%s threads=%u size=0%s",
                                                  state, options->threads, more);
    whole->other = measure_series(measure, shape, "cg state=%s threads=%u size=%d%s", state,
                                  options->threads, options->quick ? 40 : 1000, more);
    return whole;
}

static const struct measure_series *
plan_spring(struct measure *measure, const struct bench_options *options, int side, int count)
{
    char state[40], more[40];
    const double us = 1e6 / count;
    snprintf(state, sizeof state, "sheet_%d", side);
    snprintf(more, sizeof more, " count=%d", count);
    char plain[60];
    snprintf(plain, sizeof plain, "%s solver=plain", more);
    const struct measure_series *ours =
        cg_series(measure, options, cg_ours(0, options->threads), "cg", state, plain);
    const struct measure_series *petsc = cg_petsc(measure, options, "cg", state, more);
    const struct measure_series *loop = twin(measure, options, state, more);
    measure_value(measure, ours, us, "us", "spring_%d_us", side);
    measure_value(measure, petsc, us, "us", "spring_%d_petsc_us", side);
    measure_value(measure, loop, us, "us", "spring_%d_twin_us", side);
    measure_ratio(measure, ours, petsc, "spring_%d_vs_petsc", side);
    measure_ratio(measure, ours, loop, "spring_%d_vs_twin", side);
    measure_ratio(measure, loop, petsc, "twin_%d_vs_petsc", side);
    return ours;
}

static void plan_150(struct measure *measure, const struct bench_options *options)
{
    plan_spring(measure, options, 150, options->quick ? 20 : 400);
}

/* Both move the same bytes: their rates are as their times. */
static void plan_400(struct measure *measure, const struct bench_options *options)
{
    const int count = options->quick ? 20 : 100;
    struct measure_series *triad =
        measure_series(measure, (struct subject_shape){"openmp", 0, options->threads},
                       "triad state=sheet_400 threads=%u", options->threads);
    const struct measure_series *ours = plan_spring(measure, options, 400, count);
    triad->work = 1.0 / count;
    measure_value(measure, triad, 1e6, "us", "triad_400_us");
    measure_ratio(measure, triad, ours, "bandwidth_fraction_400");
}

/* Half storage of 3x3 blocks on the same system. */
static void plan_half(struct measure *measure, const struct bench_options *options)
{
    const int count = options->quick ? 20 : 400;
    const double us = 1e6 / count;
    char more[60];
    snprintf(more, sizeof more, " count=%d", count);
    const struct measure_series *petsc = cg_petsc(measure, options, "cg", "sheet_150", more);
    snprintf(more, sizeof more, " count=%d solver=plain format=half", count);
    const struct measure_series *ours =
        cg_series(measure, options, cg_ours(0, options->threads), "cg", "sheet_150", more);
    measure_value(measure, ours, us, "us", "half_150_us");
    measure_ratio(measure, ours, petsc, "half_150_vs_petsc");
    measure_value(measure, petsc, us, "us", "half_150_petsc_us");
}

const struct bench_case cg_spring_150 = {
    "spring_150", "an iteration of conjugate gradients, 150 x 150 vertices", plan_150, cg_runs, 0};
const struct bench_case cg_spring_400 = {
    "spring_400", "the same, 400 x 400, and what memory allows: at least " STATE_BYTES_FORMULA,
    plan_400, NULL, 8};

const struct bench_case cg_half_150 = {
    "half_150", "an iteration with a matrix of 3x3 blocks in half storage", plan_half, NULL, 0};

/* ---- A solve ---- */

static void plan_solve(struct measure *measure, const struct bench_options *options)
{
    static const char *const pc[] = {"none", "icc", "gamg"};
    static const char *const name[] = {"cg", "icc", "gamg"};
    char more[60];
    snprintf(more, sizeof more, " error=%d", ERROR);
    const struct measure_series *ours =
        cg_series(measure, options, cg_ours(0, options->threads), "solve", "sheet_150", more);
    measure_value(measure, ours, 1e3, "ms", "solve_ms");
    for (int i = 0; i < 3; i++) {
        snprintf(more, sizeof more, " error=%d pc=%s", ERROR, pc[i]);
        const struct measure_series *petsc = cg_petsc(measure, options, "solve", "sheet_150", more);
        measure_value(measure, petsc, 1e3, "ms", "solve_petsc_%s_ms", name[i]);
        measure_ratio(measure, ours, petsc, "solve_vs_petsc_%s", name[i]);
    }
    snprintf(more, sizeof more, " error=%d what=iterations", ERROR);
    const struct measure_series *iterations =
        cg_series(measure, options, cg_ours(0, options->threads), "solve", "sheet_150", more);
    measure_value(measure, iterations, 1, "iterations", "solve_iterations");
    for (int i = 0; i < 3; i++) {
        snprintf(more, sizeof more, " error=%d pc=%s what=iterations", ERROR, pc[i]);
        const struct measure_series *petsc = measure_series(
            measure, (struct subject_shape){"petsc", 1, 1}, "solve state=sheet_150%s", more);
        measure_value(measure, petsc, 1, "iterations", "solve_petsc_%s_iterations", name[i]);
    }
}

const struct bench_case cg_solve = {
    "solve", "the whole solve of sheet_150 to an error of 1 % in the mass norm, with set-up",
    plan_solve, NULL, 8};

/* ---- The default preconditioner ---- */

double cg_worst(const struct measure_metric *metric, size_t round)
{
    double most = 0;
    for (size_t i = 0; i < metric->n; i++)
        most = fmax(most, metric->of[i].sample[round] / metric->against[i].sample[round]);
    return most;
}

const struct measure_series *cg_solves(struct measure *measure, const struct bench_options *options,
                                       const char *const *name, const char *words, size_t *n)
{
    const struct measure_series *first = NULL;
    char more[80];
    snprintf(more, sizeof more, " error=%d%s", ERROR, words);
    for (*n = 0; *name; name++) {
        if (states_missing(*name))
            continue;
        const struct measure_series *one =
            cg_series(measure, options, cg_ours(0, options->threads), "solve", *name, more);
        first = first ? first : one;
        ++*n;
    }
    return first;
}

static void plan_jacobi(struct measure *measure, const struct bench_options *options)
{
    static const char *const what[] = {" what=iterations", ""};
    static const char *const name[] = {"iterations", "solve_time"};
    for (int i = 0; i < 2; i++) {
        char more[60];
        size_t n;
        const struct measure_series *ours = cg_solves(measure, options, states_met(), what[i], &n);
        snprintf(more, sizeof more, " solver=jacobi%s", what[i]);
        const struct measure_series *jacobi = cg_solves(measure, options, states_met(), more, &n);
        struct measure_metric *metric[] = {
            measure_metric(measure, "x", measure_geometric, "%s_vs_jacobi_geo", name[i]),
            measure_metric(measure, "x", cg_worst, "%s_vs_jacobi_worst", name[i])};
        for (int k = 0; k < 2; k++) {
            metric[k]->of = ours;
            metric[k]->against = jacobi;
            metric[k]->n = n;
        }
    }
}

const struct bench_case cg_jacobi = {
    "jacobi", "the default preconditioner against 3x3 block Jacobi, all states to an error of 1 %",
    plan_jacobi, NULL, 2};

/* ---- The default stop ---- */

static double largest(const struct measure_metric *metric, size_t round)
{
    double most = 0;
    for (size_t i = 0; i < metric->n; i++)
        most = fmax(most, metric->of[i].sample[round]);
    return most;
}

static void plan_error(struct measure *measure, const struct bench_options *options)
{
    const struct measure_series *first = NULL;
    size_t n = 0;
    for (const char *const *name = states_met(); *name; name++) {
        if (states_missing(*name))
            continue;
        const struct measure_series *one =
            cg_series(measure, options, cg_ours(0, options->threads), "error", *name, "");
        measure_value(measure, one, 1, "of_dv", "error_%s", *name);
        first = first ? first : one;
        n++;
    }
    struct measure_metric *worst = measure_metric(measure, "of_dv", largest, "mass_norm_error");
    worst->of = first;
    worst->n = n;
}

const struct bench_case cg_error = {
    "error", "what the default stop leaves, in the mass norm, of each state and the worst",
    plan_error, NULL, 1};

/* ---- A step ---- */

static void plan_step(struct measure *measure, const struct bench_options *options)
{
    const unsigned n = options->threads;
    const char *more = options->quick ? " steps=2" : " steps=4";
    const double ms = 1e3 / (options->quick ? 2 : 4);
    const struct measure_series *one =
        cg_series(measure, options, cg_ours(0, 1), "step", "sheet_150", more);
    const struct measure_series *threads =
        cg_series(measure, options, cg_ours(0, n), "step", "sheet_150", more);
    const struct measure_series *ranks =
        cg_series(measure, options, cg_ours(n, 1), "step", "sheet_150", more);
    measure_value(measure, one, ms, "ms", "step_ms");
    measure_ratio(measure, one, threads, "step_speedup_t%u", n);
    measure_ratio(measure, one, ranks, "step_speedup_r%u", n);
}

const struct bench_case cg_step = {
    "step", "whole steps of sheet_150 with the default solver, on threads and ranks against one",
    plan_step, NULL, 8};

static void plan_realtime(struct measure *measure, const struct bench_options *options)
{
    static const struct {
        const char *what, *name, *unit;
        double factor;
    } reported[] = {{"mean", "realtime_ms_per_frame", "ms", 1e3},
                    {"p95", "realtime_ms_per_frame_p95", "ms", 1e3},
                    {"halved", "realtime_steps_halved", "steps", 1}};
    for (size_t i = 0; i < sizeof reported / sizeof *reported; i++) {
        char more[20];
        snprintf(more, sizeof more, " what=%s", reported[i].what);
        const struct measure_series *one = cg_series(measure, options, cg_ours(0, options->threads),
                                                     "realtime", "sheet_150", more);
        measure_value(measure, one, reported[i].factor, reported[i].unit, "%s", reported[i].name);
    }
}

const struct bench_case cg_realtime = {"realtime",
                                       "a tilted sheet of 22,500 vertices falls onto the floor and "
                                       "comes to rest: h = 20 ms, 25 frames "
                                       "a second, with substeps",
                                       plan_realtime, NULL, 3};
