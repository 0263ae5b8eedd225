/* A step of the stencil of the case `granularity` of the bench "tasks" with bodies of no
 * iterations, replayed, over as many ranks as there are cores: 1 point a rank, and 32. Against the
 * same by hand for MPI. */
#include "bench/ranks/ranks.h"

static void plan_points(struct measure *measure, const struct bench_options *options,
                        unsigned points, const char *name)
{
    const unsigned ranks = options->threads, steps = options->quick ? 20 : 4000;
    const struct measure_series *ours =
        measure_series(measure, ranks_ours(ranks, 1),
                       "granularity_replay points=%u steps=%u iterations=0 threads=1 scheduler=%s",
                       ranks * points, steps, options->scheduler);
    const struct measure_series *mpi =
        measure_series(measure, (struct subject_shape){"mpi", ranks, 1},
                       "granularity points=%u steps=%u iterations=0", ranks * points, steps);
    measure_value(measure, ours, 1e6 / steps, "us", "%s_us", name);
    measure_value(measure, mpi, 1e6 / steps, "us", "%s_twin_us", name);
    measure_ratio(measure, ours, mpi, "%s_vs_twin", name);
}

static void plan(struct measure *measure, const struct bench_options *options)
{
    plan_points(measure, options, 1, "stencil_step");
    plan_points(measure, options, 32, "stencil_step_32");
}

static const struct serve_run RUNS[] = {{0}}; /* those of tasks_granularity are served, too */

const struct bench_case ranks_stencil = {
    "stencil", "a step of empty tasks over ranks, 1 and 32 points each", plan, RUNS, 0};
