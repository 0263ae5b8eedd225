#ifndef BENCH_SCALE_SCALE_H
#define BENCH_SCALE_SCALE_H

#include "bench/bench.h"

/* Shared by the cases of the bench "scale". */

enum { SCALE_COMMAND = 16384, SCALE_PATH = 4096 };

/* Runs duite-cloth on cloth/scenes/sheet.yaml, of side x side vertices, with a grain, by `before`
 * (a command that ends with its program; "") and with further arguments. 0, or what serve_fail
 * returns. */
int scale_cloth(const char *before, unsigned side, unsigned grain, const char *arguments);

extern const struct bench_case scale_messages, scale_wait, scale_runs, scale_predicted, scale_vast,
    scale_large, scale_million, scale_small;

#endif
