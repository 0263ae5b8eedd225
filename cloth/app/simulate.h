#ifndef CLOTH_APP_SIMULATE_H
#define CLOTH_APP_SIMULATE_H

#include "cloth/app/run/options.h"

/* The whole run of one scene, after the command line of duite-cloth. */

/* Exit codes of the program. After SIMULATE_LOST MPI may not be called any more. */
enum {
    SIMULATE_OK = 0,
    SIMULATE_FAILED = 1,
    SIMULATE_BAD_INPUT = 2,
    SIMULATE_LOST = 3,
    SIMULATE_INTERSECTS = 4, /* it is done, but a check that was asked for found intersections */
    SIMULATE_STOPPED = 5     /* stopped by a signal before its end */
};

/* Before any other thread begins: leaves SIGUSR1 and SIGTERM to simulate_catch_signals. SIGXFSZ
 * becomes an error of the write, instead of ending the process. Local. */
void simulate_block_signals(void);

/* Lets SIGUSR1 and SIGTERM, on any rank, end a run from now on. It ends its step, writes a
 * checkpoint if asked for and a frame of the state after the step, and stops. While files are read
 * and the scene is built the process ends at once. Returns 0, or -1: no thread. Local. */
int simulate_catch_signals(void);

/* Reads, runs, reports. It finds every input error before it writes anything, and one rank prints
 * it. The caller initialises MPI. Returns the exit code, the same on all ranks but for
 * SIMULATE_LOST, which each rank finds and reports by itself. Collective over MPI_COMM_WORLD. */
int simulate(const struct simulate_options *options);

#endif
