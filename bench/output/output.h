#ifndef BENCH_OUTPUT_OUTPUT_H
#define BENCH_OUTPUT_OUTPUT_H

#include "bench/bench.h"

/* The bench "output": what frames, checkpoints and pictures of the sheet cost. bench.c has the
 * plans, run.c what our process runs for them; draw.c is a program of its own, since it needs
 * OpenGL. All read the frames and the checkpoint of one run, which is made once. */

enum { OUTPUT_PATH = 4200 };

/* Makes that run; as bench.prepare. */
int output_prepare(const struct bench_options *options,
                   void (*say)(const char *key, const char *text));

/* simulate output=none|frames|hdf5|checkpoints|live|stopped threads= scheduler= quick=: seconds of
 * duite-cloth, from its start to its end. All runs must end with the same state_hash, and write
 * what they should; live and stopped have a viewer (viewer.h). write as=checkpoint|plain times=:
 * seconds of writing the bytes of a checkpoint of the sheet, of the fastest of so many. */
extern const struct serve_run output_runs[];

#endif
