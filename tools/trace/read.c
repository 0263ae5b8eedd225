/* Reading a trace: every section is checked before anything points to it, so that users of a run
 * need not check. Files stay mapped until the run is freed. */
#include "tools/trace/read.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_RANKS = 1 << 24 };

/* One file while it is read. */
struct source {
    struct trace_run *run;
    struct trace_rank *rank;
    const char *path;
    const char *bytes;
    size_t size, end; /* of the file; of what is to be read */
    bool partial;
};

static int source_damaged(const struct source *source, size_t at, const char *what)
{
    return base_error(DUITE_E_ARGUMENT, "%s: byte %zu: %s", source->path, at, what);
}

/* ---- Opening ---- */

static int source_map(struct source *source)
{
    struct stat status;
    int file = open(source->path, O_RDONLY | O_CLOEXEC);
    if (file < 0 || fstat(file, &status)) {
        int reason = errno;
        if (file >= 0)
            close(file);
        return base_error(DUITE_E_SYSTEM, "%s cannot be read: %s", source->path, strerror(reason));
    }
    source->size = (size_t)status.st_size;
    void *bytes = !S_ISREG(status.st_mode) || !source->size
                      ? MAP_FAILED
                      : mmap(NULL, source->size, PROT_READ, MAP_PRIVATE, file, 0);
    close(file);
    if (bytes == MAP_FAILED)
        return base_error(DUITE_E_ARGUMENT, "%s: byte 0: this is no trace, or an empty file",
                          source->path);
    source->bytes = bytes;
    source->rank->header = bytes;
    source->rank->bytes = source->size;
    return DUITE_OK;
}

static int source_check_size(struct source *source)
{
    const struct trace_header *header = source->rank->header;
    char text[200];
    source->end = source->size;
    if (!header->whole && source->partial)
        return DUITE_OK;
    if (!header->whole)
        return source_damaged(source, offsetof(struct trace_header, whole),
                              "the run did not come to its end; --partial takes what is there");
    source->end = header->bytes;
    if (header->bytes <= source->size)
        return DUITE_OK;
    snprintf(text, sizeof text, "truncated: the file had %" PRIu64 " bytes when it was written",
             header->bytes);
    return source_damaged(source, source->size, text);
}

/* Each worker's counters are in the file of a run that came to its end. Only a file that lost
 * something may lack them, and such a file is not predicted. */
static size_t source_max_workers(const struct source *source)
{
    const size_t each = sizeof(struct trace_section) + sizeof(struct trace_counters);
    const struct trace_header *header = source->rank->header;
    const size_t max = source->size / each + 1;
    return header->whole && !header->lost && max < DUITE_MAX_THREADS ? max : DUITE_MAX_THREADS;
}

/* Between those of a clock of a petahertz and one of a hertz: seconds fit into ticks, and ticks
 * into seconds. */
static bool tick_is_sound(double tick)
{
    return tick >= 1e-15 && tick <= 1;
}

static int source_check_header(struct source *source, uint32_t rank)
{
    const struct trace_header *header = source->rank->header;
    const struct trace_header *first = source->run->rank[0].header;
    char text[200];
    size_t magic = source->size < 8 ? source->size : 8;
    if (memcmp(source->bytes, TRACE_MAGIC, magic) != 0)
        return source_damaged(source, 0, "this is no trace of duite");
    if (source->size < sizeof *header)
        return source_damaged(source, source->size, "truncated in its header");
    if (header->order != TRACE_ORDER)
        return source_damaged(source, offsetof(struct trace_header, order),
                              "written on a machine with another order of bytes");
    if (header->version != TRACE_VERSION) {
        snprintf(text, sizeof text, "a trace of version %" PRIu32 "; this program reads version %d",
                 header->version, TRACE_VERSION);
        return source_damaged(source, offsetof(struct trace_header, version), text);
    }
    if (header->rank != rank || !header->n_ranks || !header->workers ||
        !tick_is_sound(header->tick) || header->n_ranks > MAX_RANKS ||
        header->workers > source_max_workers(source))
        return source_damaged(source, offsetof(struct trace_header, rank),
                              "another rank, or nonsense, where this one was expected");
    if (rank && (header->run != first->run || header->n_ranks != first->n_ranks))
        return source_damaged(source, offsetof(struct trace_header, run),
                              "of another run than the file of rank 0");
    return source_check_size(source);
}

/* ---- Sections ---- */

static int source_take_kernels(struct source *source, const struct trace_section *section,
                               size_t at)
{
    struct trace_run *run = source->run;
    const char *begin = (const char *)(section + 1), *end = begin + section->bytes;
    uint32_t n = section->worker;
    if (source->rank != run->rank)
        return DUITE_OK;
    if (n < run->n_kernels)
        return source_damaged(source, at, "fewer kernels than before");
    base_free(run->kernel_name);
    run->kernel_name = NULL;
    if (section->bytes / sizeof *run->kernel < n)
        return source_damaged(source, at, "fewer kernels than it says");
    run->kernel = (const void *)begin;
    run->kernel_name = base_alloc((n + 1) * sizeof *run->kernel_name);
    if (!run->kernel_name)
        return base_no_memory("a trace");
    const char *name = (const char *)(run->kernel + n);
    for (run->n_kernels = 0; run->n_kernels < n; run->n_kernels++) {
        const char *stop = memchr(name, 0, (size_t)(end - name));
        if (!stop)
            return source_damaged(source, at, "a kernel's name does not end");
        if (run->kernel[run->n_kernels].n_modes > DUITE_MAX_ACCESS)
            return source_damaged(source, at, "a kernel with too many modes");
        run->kernel_name[run->n_kernels] = name;
        name = stop + 1;
    }
    return DUITE_OK;
}

static bool event_is_valid(const struct trace_run *run, const struct trace_event *event)
{
    bool peer =
        event->kind == TRACE_SEND || event->kind == TRACE_RECEIVE || event->kind == TRACE_DELEGATE;
    return event->kind && event->kind < TRACE_KINDS &&
           (event->kind != TRACE_TASK || (event->number && event->kernel < run->n_kernels)) &&
           (!peer || event->kernel < run->n_ranks) && event->within <= event->took;
}

static int source_take_events(struct source *source, const struct trace_section *section, size_t at)
{
    struct trace_rank *rank = source->rank;
    const struct trace_event *event = (const void *)(section + 1);
    size_t n = section->bytes / sizeof *event;
    if (section->bytes % sizeof *event || section->worker >= rank->header->workers)
        return source_damaged(source, at, "events of no worker, or cut in pieces");
    for (size_t i = 0; i < n; i++)
        if (!event_is_valid(source->run, &event[i]))
            return source_damaged(source, at + sizeof *section + i * sizeof *event,
                                  "an invalid event");
    if (!BASE_GROW(rank->piece, rank->pieces_capacity, rank->n_pieces + 1))
        return base_no_memory("a trace");
    rank->piece[rank->n_pieces++] = (struct trace_piece){event, n, section->worker};
    rank->n_events += n;
    return DUITE_OK;
}

static int source_take_words(struct source *source, const struct trace_section *section, size_t at)
{
    struct trace_run *run = source->run;
    size_t n = section->bytes / sizeof *run->word;
    if (source->rank != run->rank || section->bytes % 8)
        return source_damaged(source, at, "words of the program where there are none");
    if (!BASE_GROW(run->word, run->words_capacity, run->n_words + n + 1))
        return base_no_memory("a trace");
    memcpy(run->word + run->n_words, section + 1, section->bytes);
    run->n_words += n;
    if (n && section->worker)
        run->n_words--;
    return DUITE_OK;
}

static int source_take_other(struct source *source, const struct trace_section *section, size_t at)
{
    struct trace_rank *rank = source->rank;
    if (section->kind == TRACE_CLOCK) {
        if (section->bytes != sizeof rank->clock[0] || rank->n_clocks == 2)
            return source_damaged(source, at, "an invalid clock");
        memcpy(&rank->clock[rank->n_clocks++], section + 1, sizeof rank->clock[0]);
        return DUITE_OK;
    }
    if (section->kind != TRACE_COUNTERS || section->worker >= rank->header->workers ||
        section->bytes != sizeof(struct trace_counters))
        return source_damaged(source, at, "an invalid section");
    rank->counters[section->worker] = (const void *)(section + 1);
    return DUITE_OK;
}

static int source_take_sections(struct source *source)
{
    size_t at = sizeof(struct trace_header);
    int code = DUITE_OK;
    while (at < source->end && !code) {
        const struct trace_section *section = (const void *)(source->bytes + at);
        size_t room = source->end - at;
        if (room < sizeof *section || section->bytes > room - sizeof *section ||
            section->bytes % 8) {
            if (!source->rank->header->whole)
                return DUITE_OK; /* --partial: it was being written */
            return source_damaged(source, at, "truncated in a section, or damaged");
        }
        if (section->kind == TRACE_KERNELS)
            code = source_take_kernels(source, section, at);
        else if (section->kind == TRACE_EVENTS)
            code = source_take_events(source, section, at);
        else if (section->kind == TRACE_PROGRAM)
            code = source_take_words(source, section, at);
        else
            code = source_take_other(source, section, at);
        at += sizeof *section + section->bytes;
    }
    return code;
}

/* ---- Files ---- */

static int source_path(const char *file, uint32_t rank, char **path)
{
    int length = 0;
    if (rank)
        length = asprintf(path, "%s.%" PRIu32, file, rank);
    else
        *path = strdup(file);
    return length < 0 || !*path ? base_no_memory("a trace") : DUITE_OK;
}

static int run_read_rank(struct trace_run *run, const char *file, uint32_t rank, bool partial)
{
    char *path = NULL;
    struct trace_rank *own = &run->rank[rank];
    int code = source_path(file, rank, &path);
    struct source source = {.run = run, .rank = own, .path = path, .partial = partial};
    if (!code)
        code = source_map(&source);
    if (!code)
        code = source_check_header(&source, rank);
    if (!code) {
        own->counters = base_alloc_zero((own->header->workers + 1) * sizeof *own->counters);
        code = own->counters ? source_take_sections(&source) : base_no_memory("a trace");
    }
    if (!code) {
        run->whole &= own->header->whole != 0;
        run->lost += own->header->whole ? own->header->lost : 0;
    }
    free(path);
    return code;
}

/* The first moment, and how well the clocks agree. */
static void run_find_zero(struct trace_run *run)
{
    double zero = INFINITY;
    for (uint32_t r = 0; r < run->n_ranks; r++) {
        const struct trace_rank *rank = &run->rank[r];
        for (size_t i = 0; r && i < rank->n_clocks; i++)
            run->bound = fmax(run->bound, rank->clock[i].bound);
        if (r && !rank->n_clocks)
            run->bound = INFINITY;
        for (size_t p = 0; p < rank->n_pieces; p++)
            for (size_t i = 0; i < rank->piece[p].n; i++)
                zero = fmin(zero, trace_when(run, r, rank->piece[p].event[i].begin));
    }
    run->zero = zero < INFINITY ? zero : 0;
}

/* How many ranks there are; the rest is checked when the file is read. */
static int source_peek(const char *path, struct trace_header *header)
{
    struct trace_run run = {.n_ranks = 1};
    struct trace_rank rank = {0};
    run.rank = &rank;
    struct source source = {.run = &run, .rank = &rank, .path = path, .partial = true};
    int code = source_map(&source);
    if (!code)
        code = source_check_header(&source, 0);
    if (!code)
        *header = *rank.header;
    if (rank.header)
        munmap((void *)(uintptr_t)rank.header, rank.bytes);
    return code;
}

/* Checks the number of ranks before memory is taken for them: the last rank must have a file. */
static int run_check_last(const char *file, uint32_t n_ranks)
{
    char *path = NULL;
    int code = source_path(file, n_ranks - 1, &path);
    if (!code && access(path, R_OK))
        code = base_error(DUITE_E_SYSTEM,
                          "%s cannot be read: %s; by its head the trace is of %" PRIu32 " ranks",
                          path, strerror(errno), n_ranks);
    free(path);
    return code;
}

static int run_read_all(struct trace_run *run, const char *file, bool partial)
{
    struct trace_header header;
    int code = source_peek(file, &header);
    if (!code)
        code = run_check_last(file, header.n_ranks);
    if (code)
        return code;
    run->rank = base_alloc_zero(header.n_ranks * sizeof *run->rank);
    if (!run->rank)
        return base_no_memory("a trace");
    run->n_ranks = header.n_ranks;
    code = run_read_rank(run, file, 0, partial);
    for (uint32_t r = 1; r < run->n_ranks && !code; r++)
        code = run_read_rank(run, file, r, partial);
    return code;
}

int trace_read(struct trace_run **out, const char *file, bool partial)
{
    struct trace_run *run = base_alloc_zero(sizeof *run);
    *out = NULL;
    if (!run)
        return base_no_memory("a trace");
    run->whole = true;
    int code = run_read_all(run, file, partial);
    if (code) {
        trace_run_free(run);
        return code;
    }
    run_find_zero(run);
    *out = run;
    return DUITE_OK;
}

void trace_run_free(struct trace_run *run)
{
    if (!run)
        return;
    for (uint32_t r = 0; r < run->n_ranks; r++) {
        if (run->rank[r].header)
            munmap((void *)(uintptr_t)run->rank[r].header, run->rank[r].bytes);
        free(run->rank[r].piece);
        base_free(run->rank[r].counters);
    }
    base_free(run->rank);
    base_free(run->kernel_name);
    free(run->word);
    base_free(run);
}
