#ifndef DUITE_TRACE_WORDS_H
#define DUITE_TRACE_WORDS_H

#include "runtime/trace/read.h"

#include <duite.h>
#include <string.h>

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
