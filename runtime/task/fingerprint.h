#ifndef DUITE_TASK_FINGERPRINT_H
#define DUITE_TASK_FINGERPRINT_H

#include "runtime/data/object.h"

/* The fingerprint's formula, in one place. All ranks make the same calls, so each mixes the same
 * numbers into one hash; a rank with another hash made other calls. A fork mixes in its kernel's
 * index, the rank it names and its objects; priority and cost are the running rank's and stay out.
 * The communication keeps the hash after each call (comm/history.h). */

#define TASK_HASH_ODD UINT64_C(0x9e3779b97f4a7c15)

static inline uint64_t task_name_bits(duite_object name)
{
    uint64_t bits; /* as it lies in memory: one load */
    memcpy(&bits, &name, sizeof bits);
    return bits;
}

/* The fingerprint with one more value. */
static inline uint64_t task_fingerprint(uint64_t fingerprint, uint64_t value)
{
    fingerprint = (fingerprint ^ value) * TASK_HASH_ODD;
    return fingerprint ^ fingerprint >> 32;
}

/* The hash of a fork: it begins with what is forked, and goes on with each object, as a polynomial:
 * forks with the same objects in another order differ. */
static inline uint64_t task_fork_hash(uint64_t what)
{
    return what * TASK_HASH_ODD;
}

static inline uint64_t task_fork_hash_on(uint64_t hash, duite_object name)
{
    return (hash + task_name_bits(name)) * TASK_HASH_ODD;
}

static inline uint64_t task_fork_hash_all(uint64_t what, size_t n, const duite_object *objects)
{
    uint64_t hash = task_fork_hash(what);
    for (size_t i = 0; i < n; i++)
        hash = task_fork_hash_on(hash, objects[i]);
    return hash;
}

/* For all ranks a fork is its kernel's index and the rank that it names. */
static inline uint64_t task_fork_what(uint32_t kernel, int at)
{
    return (uint64_t)kernel << 32 | (uint32_t)at;
}

#endif
