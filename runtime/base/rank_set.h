#ifndef DUITE_BASE_RANK_SET_H
#define DUITE_BASE_RANK_SET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Sets of ranks: a bit a rank, in as many words as all ranks take. The owner keeps the words; of
 * many sets one behind the other. Not for several threads at a time. */

/* Words of a set. */
static inline size_t base_ranks_words(int n_ranks)
{
    return ((size_t)n_ranks + 63) / 64;
}

static inline bool base_ranks_has(const uint64_t *set, int rank)
{
    return set[rank / 64] >> (rank % 64) & 1;
}

static inline void base_ranks_add(uint64_t *set, int rank)
{
    set[rank / 64] |= UINT64_C(1) << (rank % 64);
}

static inline void base_ranks_remove(uint64_t *set, int rank)
{
    set[rank / 64] &= ~(UINT64_C(1) << (rank % 64));
}

static inline void base_ranks_clear(uint64_t *set, size_t words)
{
    memset(set, 0, words * sizeof *set);
}

static inline bool base_ranks_is_empty(const uint64_t *set, size_t words)
{
    uint64_t any = 0;
    for (size_t i = 0; i < words; i++)
        any |= set[i];
    return !any;
}

static inline uint32_t base_ranks_count(const uint64_t *set, size_t words)
{
    uint32_t n = 0;
    for (size_t i = 0; i < words; i++)
        for (uint64_t word = set[i]; word; word &= word - 1)
            n++;
    return n;
}

/* The first rank >= `from` of the set; -1: there is none. */
static inline int base_ranks_next(const uint64_t *set, size_t words, int from)
{
    size_t i = (size_t)from / 64;
    uint64_t word = i < words ? set[i] & UINT64_MAX << (from % 64) : 0;
    while (!word && ++i < words)
        word = set[i];
    return word ? (int)(64 * i) + __builtin_ctzll(word) : -1;
}

/* True if each rank of `set` is in `other`. */
static inline bool base_ranks_within(const uint64_t *set, const uint64_t *other, size_t words)
{
    uint64_t outside = 0;
    for (size_t i = 0; i < words; i++)
        outside |= set[i] & ~other[i];
    return !outside;
}

/* Adds the ranks of `from`. Returns whether `to` grew. */
static inline bool base_ranks_join(uint64_t *to, const uint64_t *from, size_t words)
{
    uint64_t added = 0;
    for (size_t i = 0; i < words; i++) {
        added |= from[i] & ~to[i];
        to[i] |= from[i];
    }
    return added;
}

#endif
