#ifndef DUITE_TRACE_READ_H
#define DUITE_TRACE_READ_H

#include "runtime/trace/format.h"

#include <stdbool.h>
#include <stddef.h>

/* A trace that was read: the files of all ranks, checked once, as they lie in memory. */

struct trace_piece {
    const struct trace_event *event;
    size_t n;
    uint32_t worker;
};

struct trace_rank {
    const struct trace_header *header;
    size_t bytes; /* of the file that are mapped */
    struct trace_piece *piece;
    size_t n_pieces, pieces_capacity, n_events;
    struct trace_clock clock[2]; /* at the start, at the end */
    size_t n_clocks;
    const struct trace_counters **counters; /* workers; NULL: not there */
};

struct trace_run {
    uint32_t n_ranks, n_kernels;
    struct trace_rank *rank;
    const struct trace_kernel *kernel;
    const char **kernel_name;
    uint32_t *word; /* of the program */
    size_t n_words, words_capacity;
    double zero;   /* the first moment that was written down, on the clock of rank 0 */
    double bound;  /* of the error between clocks of two ranks, s; infinite: not aligned */
    uint64_t lost; /* of all ranks */
    bool whole;    /* the run came to its end */
};

/* Reads FILE and those of the other ranks beside it. `partial`: a run that did not come to its end
 * has what is whole. Errors: DUITE_E_SYSTEM, memory; DUITE_E_ARGUMENT for a file that is foreign,
 * newer, truncated, damaged or of another run: the sentence has the byte. *run is NULL then. */
int trace_read(struct trace_run **run, const char *file, bool partial);
void trace_run_free(struct trace_run *run);

/* Seconds since run->zero on the clock of rank 0. */
double trace_when(const struct trace_run *run, uint32_t rank, uint64_t ticks);
double trace_lasts(const struct trace_run *run, uint32_t rank, uint64_t ticks);

/* What is to be called: the kernel, the runtime's own task, or the kind. */
const char *trace_event_name(const struct trace_run *run, const struct trace_event *event);
const char *trace_kind_name(unsigned kind);

/* Whether it has a duration; if not, it happens at its beginning. */
bool trace_event_lasts(const struct trace_event *event);

/* Workers of all ranks before those of this one. */
uint32_t trace_first_worker(const struct trace_run *run, uint32_t rank);

/* Calls back with each event, worker by worker. */
struct trace_seen {
    const struct trace_event *event;
    uint32_t rank, worker;
    double begin, end; /* s; as aligned, so nothing overlaps that did not */
    double took;       /* s of its own clock */
};
void trace_each(const struct trace_run *run,
                void (*visit)(void *context, const struct trace_seen *), void *context);

#endif
