/* The line is written at most ten times a second on a terminal, and once in ten seconds elsewhere,
 * whatever the steps take. */
#include "cloth/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void progress_begin(struct progress *progress, const char *phase)
{
    *progress = (struct progress){.phase = phase, .terminal = isatty(STDERR_FILENO) == 1};
    progress->begun = progress->shown = now();
}

static void write_duration(char *text, size_t size, double seconds)
{
    if (seconds < 120)
        snprintf(text, size, "%.0f s", seconds);
    else if (seconds < 7200)
        snprintf(text, size, "%.0f min", seconds / 60);
    else
        snprintf(text, size, "%.1f h", seconds / 3600);
}

void progress_step(struct progress *progress, uint64_t step, uint64_t steps,
                   const struct progress_counts *counts)
{
    progress->first = progress->first ? progress->first : step;
    double time = now(), pause = progress->terminal ? 0.1 : 10;
    if (time - progress->shown < pause && !(progress->terminal && step == steps))
        return;
    char left[32], touching[40] = "", open[60] = "";
    const double each = (time - progress->begun) / (double)(step - progress->first + 1);
    write_duration(left, sizeof left, each * (double)(steps - step));
    if (counts->contacts)
        snprintf(touching, sizeof touching, "%" PRIu64 " contacts, ", counts->contacts);
    if (counts->seams_open)
        snprintf(open, sizeof open, "%" PRIu64 " seams open by %.2g m, ", counts->seams_open,
                 counts->seam_distance);
    fprintf(stderr,
            "%s%.40s%sstep %" PRIu64 " of %" PRIu64 ", %" PRIu64 " iterations, %s%s%s left%s",
            progress->terminal ? "\r\033[K" : "", progress->phase ? progress->phase : "",
            progress->phase ? ": " : "", step, steps, counts->cg_iterations, touching, open, left,
            progress->terminal ? "" : "\n");
    fflush(stderr);
    progress->shown = time;
    progress->open = progress->terminal;
}

void progress_end(struct progress *progress)
{
    if (progress->open)
        fputc('\n', stderr);
    progress->open = false;
}
