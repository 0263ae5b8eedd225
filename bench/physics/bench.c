/* The bench "physics": its cases and its targets. */
#include "bench/physics/physics.h"

#include <math.h>

enum { SIDE = 150, LARGE_SIDE = 1000, QUICK_SIDE = 16 };

/* Bytes that an explicit Euler step of a sheet of springs has to move at least. */
#define BYTES_FORMULA                                                                              \
    "5 x 24 + 3 x 8 a vertex (x, v read and written, load; mass, drag, filter) and 4 x 8 a "       \
    "spring (its ends, k, c, L)"

static double explicit_bytes(double side)
{
    const double springs = 2 * side * (side - 1) + (side - 1) * (side - 1);
    return (5 * 24 + 3 * 8) * side * side + 4 * 8 * springs;
}

static const struct measure_series *series(struct measure *measure,
                                           const struct bench_options *options, unsigned threads,
                                           const char *run, const char *sheet, const char *count)
{
    return measure_series(measure, (struct subject_shape){"duite", 0, threads},
                          "%s sheet=%s side=%d threads=%u scheduler=%s quick=%d %s", run, sheet,
                          options->quick ? QUICK_SIDE : SIDE, threads, options->scheduler,
                          options->quick, count);
}

static const struct measure_series *assemble(struct measure *measure,
                                             const struct bench_options *options, unsigned threads,
                                             const char *sheet)
{
    return series(measure, options, threads, "assemble", sheet,
                  options->quick ? "rounds=2" : "rounds=50");
}

/* ---- Forces and matrix ---- */

static void plan_assembly(struct measure *measure, const struct bench_options *options,
                          const char *sheet)
{
    const struct measure_series *both = assemble(measure, options, options->threads, sheet);
    const struct measure_series *iteration =
        series(measure, options, options->threads, "iterate", sheet,
               options->quick ? "count=20" : "count=400");
    measure_value(measure, both, 1e6, "us", "assembly_%s_us", sheet);
    measure_value(measure, iteration, 1e6, "us", "iteration_%s_us", sheet);
    measure_ratio(measure, both, iteration, "assembly_%s_vs_iteration", sheet);
}

static void plan_springs(struct measure *measure, const struct bench_options *options)
{
    plan_assembly(measure, options, "springs");
}

static void plan_triangles(struct measure *measure, const struct bench_options *options)
{
    plan_assembly(measure, options, "triangles");
}

/* Springs and triangles together, on one thread against several. */
static double speedup(const struct measure_metric *metric, size_t round)
{
    const struct measure_series *one = metric->of, *several = metric->against;
    return (one[0].sample[round] + one[1].sample[round]) /
           (several[0].sample[round] + several[1].sample[round]);
}

static void plan_speedup(struct measure *measure, const struct bench_options *options)
{
    static const char *const sheet[] = {"springs", "triangles"};
    const struct measure_series *first[2] = {NULL};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) {
            const struct measure_series *one =
                assemble(measure, options, i ? options->threads : 1, sheet[k]);
            first[i] = first[i] ? first[i] : one;
        }
    for (int k = 0; k < 2; k++)
        measure_value(measure, first[0] + k, 1e6, "us", "assembly_%s_t1_us", sheet[k]);
    struct measure_metric *metric =
        measure_metric(measure, "x", speedup, "physics_speedup_t%u", options->threads);
    metric->of = first[0];
    metric->against = first[1];
    metric->n = 2;
}

/* ---- An explicit step ---- */

static void plan_explicit(struct measure *measure, const struct bench_options *options)
{
    const int side = options->quick ? 2 * QUICK_SIDE : LARGE_SIDE;
    const unsigned threads = options->threads;
    const struct measure_series *step =
        measure_series(measure, (struct subject_shape){"duite", 0, threads},
                       "explicit side=%d steps=%d threads=%u scheduler=%s quick=%d", side,
                       options->quick ? 2 : 10, threads, options->scheduler, options->quick);
    const struct measure_series *triad =
        measure_series(measure, (struct subject_shape){"openmp", 0, threads},
                       "triad bytes=%.0f threads=%u", explicit_bytes(side), threads);
    measure_value(measure, step, 1e3, "ms", "explicit_step_ms");
    measure_value(measure, triad, 1e3, "ms", "explicit_triad_ms");
    measure_ratio(measure, triad, step, "explicit_step_vs_triad");
}

static const struct bench_case SPRINGS = {
    "springs",
    "forces and matrix of springs, 150 x 150 vertices, against an iteration of the solve",
    plan_springs, physics_runs, 0};
static const struct bench_case TRIANGLES = {"triangles", "the same of triangles, in half storage",
                                            plan_triangles, NULL, 0};
static const struct bench_case SPEEDUP = {
    "speedup", "forces and matrix of both, on one thread and on all", plan_speedup, NULL, 0};
static const struct bench_case EXPLICIT = {"explicit",
                                           "an explicit Euler step of 1,000,000 vertices against "
                                           "what memory allows: at least " BYTES_FORMULA,
                                           plan_explicit, NULL, 8};

static const struct bench_case *const CASES[] = {&SPRINGS, &TRIANGLES, &SPEEDUP, &EXPLICIT, NULL};

/* For two threads and the full sizes. */
static const struct measure_target TARGETS[] = {{"assembly_springs_vs_iteration", 3, false},
                                                {"assembly_triangles_vs_iteration", 8, false},
                                                {"explicit_step_vs_triad", 0.6, true},
                                                {"physics_speedup_t2", 1.9, true},
                                                {0}};
enum { TARGET_THREADS = 2 };

static int serve_physics(const struct bench *bench)
{
    static struct physics_session session;
    const struct serve_run *const runs[] = {physics_runs, NULL};
    (void)bench;
    const int status = serve(
        "the cloth's tasks; duite_options_default() but for threads and scheduler", runs, &session);
    const int code = physics_end(&session);
    return status || code;
}

const struct bench bench_physics = {
    "physics",
    "forces and matrices against an iteration of the solve, an explicit step against memory",
    CASES,
    TARGETS,
    TARGET_THREADS,
    serve_physics,
    NULL,
    NULL};
