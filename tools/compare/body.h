#ifndef DUITE_TOOLS_COMPARE_BODY_H
#define DUITE_TOOLS_COMPARE_BODY_H

#include <stddef.h>
#include <stdint.h>

/* The body of a graph's task, for duite-graph and its twins in bench/rivals. It begins with the
 * task's number, goes through all values read, works, and leaves values that depend on all. */

#define BODY_TURNS_A_SECOND 1e9 /* about; the same on every machine */

static inline uint64_t body_read(const uint64_t *values, size_t n, uint64_t state)
{
    for (size_t i = 0; i < n; i++)
        state = state * 31 + values[i];
    return state;
}

static inline void body_write(uint64_t *values, size_t n, uint64_t turns, uint64_t state)
{
    for (uint64_t i = 0; i < turns; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        __asm__("" : "+r"(state)); /* else clang makes one turn of eight */
    }
    for (size_t i = 0; i < n; i++)
        values[i] = state + i;
}

/* How many values it leaves. */
static inline size_t body_values(uint32_t bytes)
{
    return bytes < 8 ? 1 : bytes / 8;
}

/* The hash of a graph's results: those of tasks that no task reads, in their order. */
static inline uint64_t body_hash(uint64_t hash, uint64_t first_value)
{
    return hash * 1099511628211u + first_value;
}

#endif
