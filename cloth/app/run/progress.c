/* The line is written at most ten times a second on a terminal, once in ten seconds elsewhere. On a
 * terminal it never reaches the last column: a line that wraps cannot be rewritten. */
#include "cloth/app/run/progress.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static double progress_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void progress_begin(struct progress *progress, const char *phase)
{
    *progress = (struct progress){.phase = phase, .terminal = isatty(STDERR_FILENO) == 1};
    progress->begun = progress->shown = progress_now();
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

static void write_duration(char *text, size_t size, double seconds)
{
    if (seconds < 120)
        snprintf(text, size, "%.0f s", seconds);
    else if (seconds < 7200)
        snprintf(text, size, "%.0f min", seconds / 60);
    else
        snprintf(text, size, "%.1f h", seconds / 3600);
}

/* A text that may be cut at its end. */
struct progress_text {
    char *bytes;
    size_t size, used;
};

__attribute__((format(printf, 2, 3))) static void progress_add(struct progress_text *text,
                                                               const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const int more = vsnprintf(text->bytes + text->used, text->size - text->used, format, values);
    va_end(values);
    const size_t room = text->size - 1 - text->used;
    if (more > 0)
        text->used += (size_t)more < room ? (size_t)more : room;
}

static void progress_add_count(struct progress_text *text, uint64_t n, const char *noun)
{
    progress_add(text, ", %" PRIu64 " %s%s", n, noun, n == 1 ? "" : "s");
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
    struct progress_text text = {line, size, 0};
    char duration[32];
    write_duration(duration, sizeof duration, left);
    if (phase)
        progress_add(&text, "%.*s: ", (int)progress_cut(phase, 40), phase);
    progress_add(&text, "step %" PRIu64 " of %" PRIu64 ", %s left", step, steps, duration);
    if (counts->frames)
        progress_add_count(&text, counts->frames, "frame");
    progress_add_count(&text, counts->cg_iterations, "iteration");
    if (counts->contacts)
        progress_add_count(&text, counts->contacts, "contact");
    if (counts->seams_open) {
        progress_add_count(&text, counts->seams_open, "seam");
        progress_add(&text, " open by %.2g m", counts->seam_distance);
    }
    const size_t end = progress_cut(line, columns);
    line[end] = '\0';
    return end;
}

void progress_step(struct progress *progress, uint64_t step, uint64_t steps,
                   const struct progress_counts *counts)
{
    progress->first = progress->first ? progress->first : step;
    double time = progress_now(), pause = progress->terminal ? 0.1 : 10;
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
