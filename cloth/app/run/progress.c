/* The line is written at most ten times a second on a terminal, once in ten seconds elsewhere. On a
 * terminal it never reaches the last column: a line that wraps cannot be rewritten. */
#include "cloth/app/run/progress.h"

#include "cloth/base/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

void progress_begin(struct progress *progress, const char *phase)
{
    *progress = (struct progress){.phase = phase, .terminal = isatty(STDERR_FILENO) == 1};
    progress->begun = progress->shown = cloth_seconds();
}

/* Columns that the line may have. */
static size_t progress_columns(const struct progress *progress)
{
    struct winsize window = {0};
    if (!progress->terminal)
        return SIZE_MAX;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &window) || window.ws_col < 2)
        return 79;
    return window.ws_col - 1u;
}

static void put_duration(FILE *to, double seconds)
{
    if (seconds < 120)
        fprintf(to, "%.0f s", seconds);
    else if (seconds < 7200)
        fprintf(to, "%.0f min", seconds / 60);
    else
        fprintf(to, "%.1f h", seconds / 3600);
}

static void put_count(FILE *to, uint64_t n, const char *noun)
{
    fprintf(to, ", %" PRIu64 " %s%s", n, noun, n == 1 ? "" : "s");
}

static bool continues_character(char byte)
{
    return ((unsigned char)byte & 0xc0) == 0x80;
}

/* Bytes of the first characters of a text, at most `columns` of them; none is cut in two. */
static size_t progress_cut(const char *text, size_t columns)
{
    size_t end = 0;
    for (size_t n = 0; text[end] && n < columns; n++)
        do
            end++;
        while (continues_character(text[end]));
    return end;
}

size_t progress_line(char *line, size_t size, size_t columns, const char *phase, uint64_t step,
                     uint64_t steps, double left, const struct progress_counts *counts)
{
    FILE *to = fmemopen(line, size - 1, "w"); /* cuts what is too long */
    *line = line[size - 1] = '\0';
    if (!to)
        return 0;
    if (phase)
        fprintf(to, "%.*s: ", (int)progress_cut(phase, 40), phase);
    fprintf(to, "step %" PRIu64 " of %" PRIu64 ", ", step, steps);
    put_duration(to, left);
    fputs(" left", to);
    if (counts->frames)
        put_count(to, counts->frames, "frame");
    put_count(to, counts->cg_iterations, "iteration");
    if (counts->contacts)
        put_count(to, counts->contacts, "contact");
    if (counts->seams_open) {
        put_count(to, counts->seams_open, "seam");
        fprintf(to, " open by %.2g m", counts->seam_distance);
    }
    fclose(to);
    const size_t end = progress_cut(line, columns);
    line[end] = '\0';
    return end;
}

void progress_step(struct progress *progress, uint64_t step, uint64_t steps,
                   const struct progress_counts *counts)
{
    progress->first = progress->first ? progress->first : step;
    double time = cloth_seconds(), pause = progress->terminal ? 0.1 : 10;
    if (time - progress->shown < pause && !(progress->terminal && step == steps))
        return;
    char line[400];
    const double each = (time - progress->begun) / (double)(step - progress->first + 1);
    progress_line(line, sizeof line, progress_columns(progress), progress->phase, step, steps,
                  each * (double)(steps - step), counts);
    fprintf(stderr, "%s%s%s", progress->terminal ? "\r\033[K" : "", line,
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
