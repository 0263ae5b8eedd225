#ifndef CLOTH_APP_RUN_PROGRESS_H
#define CLOTH_APP_RUN_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The progress line of a run on standard error: on a terminal rewritten ten times a second and cut
 * to its width, else a line every ten seconds. Local; called on rank 0. */
struct progress {
    uint64_t first;      /* the step that was shown first; 0: none was */
    const char *phase;   /* that the line names; NULL: none */
    double begun, shown; /* seconds of a clock that only goes forward */
    bool terminal, open; /* open: the line on the terminal is not ended yet */
};

void progress_begin(struct progress *progress, const char *phase);
/* Counts after step number `step`, from 1, of `steps`: frames so far, iterations of the step's
 * solves, contacts, open pulled seams and the largest gap (m). A line leaves out zeros, except
 * iterations. */
struct progress_counts {
    uint64_t frames, cg_iterations, contacts, seams_open;
    double seam_distance;
};
void progress_step(struct progress *progress, uint64_t step, uint64_t steps,
                   const struct progress_counts *counts);
void progress_end(struct progress *progress);

/* The line itself, without its end: at most `columns` characters, and size - 1 bytes, of UTF-8.
 * Phase, step and time left (s) stand first. Returns its length in bytes. */
size_t progress_line(char *line, size_t size, size_t columns, const char *phase, uint64_t step,
                     uint64_t steps, double left, const struct progress_counts *counts);

#endif
