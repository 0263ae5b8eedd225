/* Writing: one thread at a time, under the lock. The file always ends with a whole section. The
 * first failure ends all writing; everything later is counted as lost. */
#include "runtime/trace/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool file_write(int fd, const void *data, size_t bytes)
{
    const char *at = data;
    while (bytes) {
        ssize_t n = write(fd, at, bytes);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0) {
            errno = n ? errno : ENOSPC;
            return false;
        }
        at += n;
        bytes -= (size_t)n;
    }
    return true;
}

bool trace_write(struct trace *trace, enum trace_section_kind kind, uint32_t worker,
                 const struct trace_part *part, size_t n)
{
    struct trace_section head = {.kind = kind, .worker = worker};
    if (trace->error)
        return false;
    for (size_t i = 0; i < n; i++)
        head.bytes += part[i].bytes;
    bool fine = file_write(trace->fd, &head, sizeof head);
    for (size_t i = 0; i < n && fine; i++)
        fine = file_write(trace->fd, part[i].data, part[i].bytes);
    if (fine) {
        trace->bytes += sizeof head + head.bytes;
        return true;
    }
    trace->error = errno;
    if (ftruncate(trace->fd, (off_t)trace->bytes)) /* then the reader sees where it ends */
        trace->error = errno;
    return false;
}

/* Rewrites the header in place, even on a full disk. */
static bool file_write_header(struct trace *trace)
{
    const struct trace_header header = trace->header;
    ssize_t n = pwrite(trace->fd, &header, sizeof header, 0);
    if (n == (ssize_t)sizeof trace->header)
        return true;
    if (!trace->error)
        trace->error = n < 0 ? errno : ENOSPC;
    return false;
}

/* ---- Opening ---- */

static bool file_write_kernels(struct trace *trace)
{
    const duite_kernel *const *kernels = trace->graph->kernels;
    size_t names = 0, n = trace->graph->n_kernels;
    for (size_t i = 0; i < n; i++)
        names += strlen(kernels[i]->name) + 1;
    names = (names + 7) / 8 * 8;
    struct trace_kernel *kernel = base_alloc_zero(n * sizeof *kernel + names + 1);
    if (!kernel)
        return false;
    char *name = (char *)(kernel + n);
    for (size_t i = 0; i < n; i++) {
        const duite_kernel *from = kernels[i];
        struct trace_kernel *to = &kernel[i];
        while (to->n_modes < DUITE_MAX_ACCESS && from->access[to->n_modes]) {
            to->mode[to->n_modes] = from->access[to->n_modes];
            to->n_modes++;
        }
        to->variadic = (uint8_t)from->variadic;
        to->replicated = from->replicated != 0;
        to->fixed = from->fixed != 0;
        name = stpcpy(name, from->name) + 1;
    }
    bool fine = trace_write(trace, TRACE_KERNELS, (uint32_t)n,
                            &(struct trace_part){kernel, n * sizeof *kernel + names}, 1);
    base_free(kernel);
    return fine;
}

void trace_kernels(struct trace *trace)
{
    if (!trace || trace->fd < 0)
        return;
    pthread_mutex_lock(&trace->lock);
    if (!file_write_kernels(trace))
        trace->header.lost++;
    pthread_mutex_unlock(&trace->lock);
}

static bool rings_new(struct trace *trace)
{
    unsigned n = trace->header.workers;
    trace->ring = base_alloc_zero(n * sizeof *trace->ring);
    for (unsigned i = 0; i < n && trace->ring; i++) {
        struct trace_ring *ring = &trace->ring[i];
        ring->event = base_alloc(TRACE_RING * sizeof *ring->event);
        if (!ring->event)
            return false;
        ring->on = &trace->on;
        ring->worker = i;
    }
    return trace->ring != NULL;
}

static bool trace_make(struct trace *trace, const struct trace_setup *setup)
{
    trace->header = (struct trace_header){.version = TRACE_VERSION,
                                          .order = TRACE_ORDER,
                                          .rank = (uint32_t)setup->rank,
                                          .n_ranks = (uint32_t)setup->n_ranks,
                                          .workers = setup->workers,
                                          .epoch = base_ticks(),
                                          .tick = base_tick_seconds(),
                                          .began = (int64_t)time(NULL),
                                          .first = setup->first,
                                          .end = setup->end};
    memcpy(trace->header.magic, TRACE_MAGIC, sizeof trace->header.magic);
    trace->graph = setup->graph;
    size_t length = strlen(setup->file) + 16;
    trace->path = malloc(length);
    if (trace->path && setup->rank)
        snprintf(trace->path, length, "%s.%d", setup->file, setup->rank);
    else if (trace->path)
        strcpy(trace->path, setup->file);
    if (!setup->rank)
        trace->word = base_alloc(TRACE_WORDS * sizeof *trace->word);
    return rings_new(trace) && trace->path && (trace->word || setup->rank);
}

/* Removes an existing file first: another run may still write to it, and must not write into ours.
 * A pipe or /dev/null is written to as it is. */
static int file_open_fresh(const char *path)
{
    struct stat there;
    bool fresh = lstat(path, &there) != 0 || S_ISREG(there.st_mode);
    if (fresh && unlink(path) != 0 && errno != ENOENT)
        fresh = false; /* the folder keeps the file: then it is written over where it is */
    return open(path, O_WRONLY | O_CREAT | (fresh ? O_EXCL : O_TRUNC) | O_CLOEXEC, 0666);
}

int trace_open(struct trace **out, const struct trace_setup *setup)
{
    struct trace *trace = *out = base_alloc_zero(sizeof *trace);
    if (!trace)
        return base_no_memory("the trace");
    trace->fd = -1;
    trace->mpi = MPI_COMM_NULL;
    pthread_mutex_init(&trace->lock, NULL);
    if (!trace_make(trace, setup))
        return base_no_memory("the trace");
    trace->fd = file_open_fresh(trace->path);
    trace->bytes = sizeof trace->header;
    if (trace->fd < 0)
        trace->error = errno;
    else if (file_write_header(trace) && lseek(trace->fd, (off_t)trace->bytes, SEEK_SET) < 0)
        trace->error = errno;
    if (!trace->error && !file_write_kernels(trace) && !trace->error)
        return base_no_memory("the trace");
    if (trace->error)
        return base_error(DUITE_E_SYSTEM, "the trace %s cannot be written: %s", trace->path,
                          strerror(trace->error));
    return DUITE_OK;
}

/* ---- Rings ---- */

/* Under the lock. Events that can no longer be written are lost. */
static void ring_write(struct trace *trace, struct trace_ring *ring)
{
    uint64_t tail = atomic_load_explicit(&ring->tail, memory_order_relaxed);
    uint64_t head = atomic_load_explicit(&ring->head, memory_order_acquire);
    if (head == tail)
        return;
    size_t n = (size_t)(head - tail), at = tail % TRACE_RING;
    size_t first = at + n > TRACE_RING ? TRACE_RING - at : n;
    const struct trace_part part[] = {{ring->event + at, first * sizeof *ring->event},
                                      {ring->event, (n - first) * sizeof *ring->event}};
    if (!trace_write(trace, TRACE_EVENTS, ring->worker, part, 2))
        trace->header.lost += n;
    atomic_store_explicit(&ring->tail, head, memory_order_release);
}

static void ring_note_flush(struct trace *trace, struct trace_ring *ring, uint64_t begin,
                            uint64_t before)
{
    trace_put(ring, &(struct trace_event){.begin = begin,
                                          .took = base_ticks() - begin,
                                          .number = trace->bytes - before,
                                          .kind = TRACE_FLUSH});
}

void trace_relieve(struct trace *trace, struct trace_ring *ring)
{
    if (!trace_is_full(ring) || pthread_mutex_trylock(&trace->lock))
        return;
    uint64_t begin = base_ticks(), before = trace->bytes;
    ring_write(trace, ring);
    ring_note_flush(trace, ring, begin, before);
    pthread_mutex_unlock(&trace->lock);
}

void trace_flush(struct trace *trace)
{
    pthread_mutex_lock(&trace->lock);
    uint64_t begin = base_ticks(), before = trace->bytes;
    for (unsigned i = 0; i < trace->header.workers; i++)
        ring_write(trace, &trace->ring[i]);
    ring_note_flush(trace, &trace->ring[0], begin, before);
    pthread_mutex_unlock(&trace->lock);
    trace_flush_words(trace);
}

struct trace_ring *trace_ring(struct trace *trace, unsigned worker)
{
    return trace ? &trace->ring[worker] : NULL;
}

void trace_flush_words(struct trace *trace)
{
    if (!trace->n_words)
        return;
    bool fills = trace->n_words % 2;
    if (fills)
        trace->word[trace->n_words++] = TRACE_FILLS;
    pthread_mutex_lock(&trace->lock);
    const struct trace_part part = {trace->word, trace->n_words * sizeof *trace->word};
    if (!trace_write(trace, TRACE_PROGRAM, fills, &part, 1))
        trace->header.lost += trace->n_words;
    pthread_mutex_unlock(&trace->lock);
    trace->n_words = 0;
}

/* ---- Closing ---- */

static void file_write_counters(struct trace *trace, const struct trace_counters *counters)
{
    for (unsigned i = 0; i < trace->header.workers; i++)
        trace_write(trace, TRACE_COUNTERS, i, &(struct trace_part){&counters[i], sizeof *counters},
                    1);
}

/* True if some name still leads to the file. The path may not: the program may have changed its
 * folder. */
static bool file_is_there(const struct trace *trace)
{
    struct stat here;
    return fstat(trace->fd, &here) == 0 && here.st_nlink > 0;
}

int trace_close(struct trace *trace, const struct trace_counters *counters)
{
    struct trace_header *header = &trace->header;
    trace_flush(trace);
    atomic_store_explicit(&trace->on, 0, memory_order_relaxed);
    pthread_mutex_lock(&trace->lock);
    for (unsigned i = 0; i < header->workers; i++) {
        ring_write(trace, &trace->ring[i]); /* the flush itself */
        header->lost += atomic_load_explicit(&trace->ring[i].lost, memory_order_relaxed);
    }
    if (counters)
        file_write_counters(trace, counters);
    header->lost += trace->words_lost;
    header->whole = 1;
    header->bytes = trace->bytes;
    file_write_header(trace);
    const bool there = file_is_there(trace);
    if (close(trace->fd) && !trace->error)
        trace->error = errno;
    trace->fd = -1;
    pthread_mutex_unlock(&trace->lock);
    if (!trace->error && there)
        return DUITE_OK;
    if (!there) /* both may be true: then the message has both */
        return base_error(DUITE_E_SYSTEM,
                          "the trace %s was removed or replaced while the run wrote to it%s%s",
                          trace->path, trace->error ? ", and is not whole: " : "",
                          trace->error ? strerror(trace->error) : "");
    return base_error(DUITE_E_SYSTEM,
                      "the trace %s is not whole: %s; what was written before is kept", trace->path,
                      strerror(trace->error));
}

void trace_free(struct trace *trace, bool mpi)
{
    if (!trace)
        return;
    if (trace->fd >= 0)
        close(trace->fd);
    if (trace->stuck)
        return;
    if (mpi && trace->mpi != MPI_COMM_NULL)
        MPI_Comm_free(&trace->mpi);
    for (unsigned i = 0; i < trace->header.workers && trace->ring; i++)
        base_free(trace->ring[i].event);
    pthread_mutex_destroy(&trace->lock);
    base_free(trace->ring);
    base_free(trace->word);
    base_free(trace->slot);
    free(trace->path);
    base_free(trace);
}

/* ---- Steps ---- */

bool trace_wants(const struct trace *trace, uint64_t step)
{
    return step >= trace->header.first && step < trace->header.end;
}

bool trace_is_on(const struct trace *trace)
{
    return atomic_load_explicit(&trace->on, memory_order_relaxed);
}
