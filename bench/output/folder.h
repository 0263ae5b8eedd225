#ifndef BENCH_OUTPUT_FOLDER_H
#define BENCH_OUTPUT_FOLDER_H

#include "bench/cg/state.h"

#include <stdio.h>
#include <stdlib.h>

/* The folder of the run that the bench "output" reads: "sheet-frames" in the folder of the states,
 * which all processes know. */
static inline void output_folder(char *path, size_t size)
{
    const char *states = getenv(STATE_FOLDER);
    snprintf(path, size, "%s/sheet-frames", states ? states : ".");
}

#endif
