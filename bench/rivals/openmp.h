#ifndef BENCH_RIVALS_OPENMP_H
#define BENCH_RIVALS_OPENMP_H

#include "bench/serve.h"

/* The cases of bench/forks.h. */
extern const struct serve_run openmp_forks[];

#endif
