#ifndef CLOTH_PROGRESS_H
#define CLOTH_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

/* The progress line of a run on standard error: on a terminal rewritten ten times a second, else a
 * line every ten seconds. Local; called on rank 0. */
struct progress {
    uint64_t first;      /* the step that was shown first; 0: none was */
    const char *phase;   /* that the line names; NULL: none */
    double begun, shown; /* seconds of a clock that only goes forward */
    bool terminal, open; /* open: the line on the terminal is not ended yet */
};

void progress_begin(struct progress *progress, const char *phase);
/* After step number `step`, from 1, of `steps`: what its solves took, how many contacts there are,
 * and how many pulled seams are open, by how much at most (m); 0: they are not mentioned. */
struct progress_counts {
    uint64_t cg_iterations, contacts, seams_open;
    double seam_distance;
};
void progress_step(struct progress *progress, uint64_t step, uint64_t steps,
                   const struct progress_counts *counts);
void progress_end(struct progress *progress);

#endif
