/* The iteration of the case `cg`, on a smaller sheet, beside busy loops: four on each core. Against
 * the twin beside the same. */
#include "bench/loops.h"
#include "bench/ranks/ranks.h"

enum { SIDE = 40, GRAIN = 1000, ITERATIONS = 400, QUICK_SIDE = 24, QUICK_GRAIN = 50 };

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned ranks = options->threads;
    const int side = options->quick ? QUICK_SIDE : SIDE;
    const int grain = options->quick ? QUICK_GRAIN : GRAIN;
    const int count = options->quick ? 20 : ITERATIONS;
    measure->loops = LOOPS_A_CORE;
    const char *const command = "%s side=%d grain=%d count=%d threads=1 scheduler=%s";
    const struct measure_series *ours = measure_series(measure, ranks_ours(ranks, 1), command, "cg",
                                                       side, grain, count, options->scheduler);
    const struct measure_series *twin = measure_series(
        measure, ranks_twin(ranks), command, "twin_cg", side, grain, count, options->scheduler);
    measure_value(measure, ours, 1e6 / count, "us", "loaded_r%u_us", ranks);
    measure_value(measure, twin, 1e6 / count, "us", "loaded_r%u_twin_us", ranks);
    measure_ratio(measure, ours, twin, "loaded_r%u_vs_twin", ranks);
}

static const struct serve_run RUNS[] = {{0}}; /* those of ranks_cg are served */

const struct bench_case ranks_loaded = {
    "loaded", "an iteration of conjugate gradients over ranks beside four busy loops on each core",
    plan, RUNS, 0};
