/* Iterations to an error of 1 % with the coarse space solved by groups of blocks, against one exact
 * factor of it. The states are large ones, and those of the bench "cg" and of cloth in contact in
 * blocks so small that there are groups. */
#include "bench/cg/cg.h"
#include "bench/scale/scale.h"

#include <stdio.h>

enum { GRAIN = 64, QUICK_GRAIN = 4 }; /* small blocks, of a patch each */
enum { SHEET_GRAIN = 1000 };          /* vertices: enough blocks for many hosts */

/* coarse: "exact", "one" (one patch a block), or "" (groups). */
static const struct measure_series *iterations(struct measure *measure,
                                               const struct bench_options *options,
                                               const char *const *state, const char *coarse,
                                               unsigned grain, size_t *n)
{
    char words[60];
    int used = snprintf(words, sizeof words, " what=iterations");
    if (*coarse)
        used += snprintf(words + used, sizeof words - (size_t)used, " coarse=%s", coarse);
    snprintf(words + used, sizeof words - (size_t)used, " grain=%u", grain);
    return cg_solves(measure, options, state, words, n);
}

static void plan_worst(struct measure *measure, const char *kind, const char *rival,
                       const struct measure_series *groups, const struct measure_series *against,
                       size_t n)
{
    struct measure_metric *metric =
        measure_metric(measure, "x", cg_worst, "iterations_%s_vs_%s", kind, rival);
    metric->of = groups;
    metric->against = against;
    metric->n = n;
}

/* States of the motion `kind`. One patch a block in one factor is what such states had before there
 * were groups. */
static void plan_sheet(struct measure *measure, const struct bench_options *options,
                       const char *kind)
{
    const unsigned grain = options->quick ? QUICK_GRAIN : SHEET_GRAIN;
    const char *const *name = states_of(kind);
    size_t n;
    const struct measure_series *groups = iterations(measure, options, name, "", grain, &n);
    const struct measure_series *exact = iterations(measure, options, name, "exact", grain, &n);
    const struct measure_series *one = iterations(measure, options, name, "one", grain, &n);
    measure->cold = true;
    for (size_t i = 0; i < n; i++) {
        measure_value(measure, groups + i, 1, "iterations", "iterations_%s", name[i]);
        measure_value(measure, exact + i, 1, "iterations", "iterations_%s_exact", name[i]);
        measure_value(measure, one + i, 1, "iterations", "iterations_%s_one_patch", name[i]);
    }
    plan_worst(measure, kind, "exact", groups, exact, n);
    plan_worst(measure, kind, "one_patch", groups, one, n);
}

static void plan_large(struct measure *measure, const struct bench_options *options)
{
    plan_sheet(measure, options, "large");
}

static void plan_million(struct measure *measure, const struct bench_options *options)
{
    plan_sheet(measure, options, "million");
}

/* How many springs of contact the systems have. */
static void plan_touch(struct measure *measure, const struct bench_options *options, unsigned grain,
                       const char *const *name, bool self)
{
    char more[40];
    snprintf(more, sizeof more, " grain=%u self=%d", grain, self);
    for (; *name; name++)
        measure_value(
            measure,
            cg_series(measure, options, cg_ours(0, options->threads), "touch", *name, more), 1,
            "springs", "touches_%s%s", self ? "itself_" : "", *name);
}

static void plan_small(struct measure *measure, const struct bench_options *options)
{
    const unsigned grain = options->quick ? QUICK_GRAIN : GRAIN;
    size_t n;
    const char *const *name = states_small();
    const struct measure_series *groups = iterations(measure, options, name, "", grain, &n);
    const struct measure_series *one = iterations(measure, options, name, "one", grain, &n);
    measure->cold = true;
    for (size_t i = 0; i < n; name++) {
        if (states_missing(*name))
            continue;
        measure_value(measure, groups + i, 1, "iterations", "iterations_%s", *name);
        measure_value(measure, one + i++, 1, "iterations", "iterations_%s_one_factor", *name);
    }
    plan_worst(measure, "small", "one_factor", groups, one, n);
    plan_touch(measure, options, grain, states_of("landed"), false);
    plan_touch(measure, options, grain, states_of("folded"), true);
}

/* Makes the state if it is not there: only these cases need states. */
static int make_state(void *session, struct serve_request *request)
{
    struct state state = {0};
    double vertices;
    const int code = state_ready(&state, request) ? cg_make_state(session, request, &vertices) : 0;
    state_free(&state);
    return code;
}

static int run_solve(void *session, struct serve_request *request, double *value)
{
    const int code = make_state(session, request);
    return code ? code : cg_solve_state(session, request, value);
}

static int run_touch(void *session, struct serve_request *request, double *value)
{
    const int code = make_state(session, request);
    return code ? code : cg_touch(session, request, value);
}

static const struct serve_run RUNS[] = {{"solve", run_solve}, {"touch", run_touch}, {0}};

const struct bench_case scale_large = {
    "large", "iterations of 160,000 vertices, by groups and by one factor", plan_large, RUNS, 1};
const struct bench_case scale_million = {"million", "the same of 1,000,000 vertices", plan_million,
                                         NULL, 1};
const struct bench_case scale_small = {
    "small",
    "iterations of the states of cg and of contact in small blocks, by groups and one factor",
    plan_small, NULL, 1};
