#ifndef DUITE_TOOLS_TRACE_READ_H
#define DUITE_TOOLS_TRACE_READ_H

#include "runtime/trace/format.h"

#include <duite.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

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
 * has its whole sections. Errors: DUITE_E_SYSTEM, memory; DUITE_E_ARGUMENT for a file that is
 * foreign, newer, truncated, damaged or of another run: the message has the byte. *run is NULL
 * then. */
int trace_read(struct trace_run **run, const char *file, bool partial);
void trace_run_free(struct trace_run *run);

/* Seconds since run->zero on the clock of rank 0. */
double trace_when(const struct trace_run *run, uint32_t rank, uint64_t ticks);
double trace_lasts(const struct trace_run *run, uint32_t rank, uint64_t ticks);

/* An event's name: of its kernel, of the runtime's own task, or of its kind. */
const char *trace_event_name(const struct trace_run *run, const struct trace_event *event);
const char *trace_kind_name(unsigned kind);

/* True if it has a duration; if not, it happens at its beginning. */
bool trace_event_lasts(const struct trace_event *event);

/* Workers of all ranks before those of this one. */
uint32_t trace_first_worker(const struct trace_run *run, uint32_t rank);

/* Calls back with each event, worker by worker. */
struct trace_seen {
    const struct trace_event *event;
    uint32_t rank, worker;
    double begin, end; /* s; as aligned, without new overlaps */
    double took;       /* s of its own clock */
};
void trace_each(const struct trace_run *run,
                void (*visit)(void *context, const struct trace_seen *), void *context);

/* ---- Messages ---- */

/* A message with both ends known. Clocks of two ranks agree within run->bound only, so it may be
 * received before it is sent, by that. */
struct trace_message {
    double sent, received; /* s */
    uint64_t bytes;
    uint32_t from, to; /* workers, numbered through all ranks */
    uint32_t from_rank, to_rank;
};

struct trace_messages {
    struct trace_message *message; /* n; to be freed by base_free, after an error, too */
    size_t n;
};

/* Ordered by sending rank, receiving rank and time. Errors: memory. */
int trace_messages_find(const struct trace_run *run, struct trace_messages *messages);

/* ---- The main program ---- */

/* The main program of a trace, read word by word: see runtime/trace/format.h for its entries.
 * Beyond the last word zeros are read, and `short_of` says so. */
struct trace_words {
    const uint32_t *word;
    size_t n, at; /* at: the next one */
    bool short_of;
};

static inline struct trace_words trace_words_of(const struct trace_run *run)
{
    return (struct trace_words){.word = run->word, .n = run->n_words};
}

static inline size_t trace_words_left(const struct trace_words *words)
{
    return words->n - words->at;
}

static inline uint32_t trace_words_next(struct trace_words *words)
{
    words->short_of |= words->at >= words->n;
    return words->short_of ? 0 : words->word[words->at++];
}

static inline uint64_t trace_words_next2(struct trace_words *words)
{
    const uint64_t low = trace_words_next(words);
    return low | (uint64_t)trace_words_next(words) << 32;
}

static inline double trace_words_double(struct trace_words *words)
{
    const uint64_t bits = trace_words_next2(words);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline float trace_words_float(struct trace_words *words)
{
    const uint32_t bits = trace_words_next(words);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The access mode of a parameter; a postponed mode counts as the mode itself. */
static inline duite_mode trace_mode(const struct trace_kernel *kernel, size_t i)
{
    static const duite_mode same[] = {DUITE_NONE, DUITE_R, DUITE_W,  DUITE_RW, DUITE_CW,
                                      DUITE_R,    DUITE_W, DUITE_RW, DUITE_CW};
    const uint8_t mode = i < kernel->n_modes ? kernel->mode[i] : kernel->variadic;
    return mode < sizeof same / sizeof same[0] ? same[mode] : DUITE_R;
}

#endif
