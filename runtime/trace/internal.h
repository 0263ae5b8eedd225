#ifndef DUITE_TRACE_INTERNAL_H
#define DUITE_TRACE_INTERNAL_H

#include "runtime/trace/trace.h"

#include <pthread.h>

/* Shared by the files of this folder only. */

enum { TRACE_WORDS = 1 << 15 }; /* of the program, that are kept before they are written */

/* Between rank 0 and another one. */
struct trace_word {
    uint64_t run;
    double more; /* 1: what time is it? */
    double at, ahead, bound;
};

struct trace {
    _Atomic int on;
    struct trace_header header;
    struct trace_ring *ring;        /* one a worker */
    const struct task_graph *graph; /* whose kernels these are */
    pthread_mutex_t lock;           /* of the file: what follows */
    char *path;
    int fd;
    int error;      /* errno of the first failure, or 0: nothing is written any more */
    uint64_t bytes; /* of whole sections, with the header */
    /* Main thread. */
    uint32_t *word; /* rank 0; NULL on others */
    size_t n_words;
    uint32_t *slot; /* of objects that are being settled */
    size_t n_slots, slots_capacity;
    uint64_t words_lost;
    MPI_Comm mpi; /* for clocks only */
    struct trace_word said, heard;
    bool stuck; /* a rank did not answer in time: MPI may still use the two */
};

/* A part of a section. */
struct trace_part {
    const void *data;
    size_t bytes;
};

/* Writes a section whole, or takes it back. False: it is not in the file. Under the lock. */
bool trace_write(struct trace *trace, enum trace_section_kind kind, uint32_t worker,
                 const struct trace_part *part, size_t n);

/* Writes the words that are kept. Main thread, under no lock. */
void trace_flush_words(struct trace *trace);

static inline double trace_seconds(const struct trace *trace)
{
    return trace->header.tick * (double)(base_ticks() - trace->header.epoch);
}

#endif
