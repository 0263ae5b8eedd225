#ifndef BENCH_OUTPUT_VIEWER_H
#define BENCH_OUTPUT_VIEWER_H

#include <stdbool.h>
#include <sys/types.h>

/* A process that follows a run of duite-cloth --live, takes every frame and draws nothing; or that
 * stops by SIGSTOP when it has the first one. */
struct output_viewer {
    pid_t process;
    unsigned port; /* of the run */
    bool stops;
};

/* Before the run. Errors: as serve_fail. */
int output_viewer_start(struct output_viewer *viewer, bool stops);
/* After it. It must have got the last of the run's frames, whose number is `last`, or have stopped;
 * unless that is left out. Errors: as serve_fail. */
int output_viewer_end(struct output_viewer *viewer, bool checks, int last);

#endif
