#ifndef BENCH_GARMENTS_GARMENTS_H
#define BENCH_GARMENTS_GARMENTS_H

#include "bench/bench.h"

/* The parts of the bench "garments" that have a file of their own. */

/* "hanging threads=N quick=0|1 corrected=0|1": seconds of a step of hanging.yaml. */
extern const struct serve_run garments_correction_runs[];
extern const struct bench_case garments_correction;

#endif
