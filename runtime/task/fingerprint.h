#ifndef DUITE_TASK_FINGERPRINT_H
#define DUITE_TASK_FINGERPRINT_H

#include "runtime/data/object.h"

/* The fingerprint's formula, in one place. All ranks make the same calls, so each mixes the same
 * numbers into one hash; a rank with another hash made other calls. A fork mixes in its kernel's
 * index, the rank it names and its objects; priority and cost are the running rank's and stay out.
 * The communication keeps the hash after each call (comm/history.h). */

static inline uint64_t task_name_bits(duite_object name)
{
    return (uint64_t)name.slot << 32 | name.generation;
}

/* The number of a fork: it begins with the kernel and the rank, and goes on with each object. */
static inline uint64_t task_fork_hash(uint32_t kernel, int at)
{
    return (uint64_t)kernel << 32 | (uint32_t)at;
}

static inline uint64_t task_fork_hash_on(uint64_t hash, duite_object name)
{
    return hash * 0x9e3779b97f4a7c15u + ((uint64_t)name.generation << 32 | name.slot);
}

static inline uint64_t task_fork_hash_all(uint32_t kernel, int at, size_t n,
                                          const duite_object *objects)
{
    uint64_t hash = task_fork_hash(kernel, at);
    for (size_t i = 0; i < n; i++)
        hash = task_fork_hash_on(hash, objects[i]);
    return hash;
}

#endif
