#ifndef DUITE_TASK_FINGERPRINT_H
#define DUITE_TASK_FINGERPRINT_H

#include "runtime/data/object.h"

#include <stdatomic.h>

/* The fingerprint's formula, and the history of calls, in one place. All ranks make the same calls,
 * so each mixes the same numbers into one hash; a rank with another hash made other calls. A fork
 * mixes in its kernel's index, the rank it names and its objects; priority and cost are the running
 * rank's and stay out. The history keeps the last calls, so that the first difference between ranks
 * can be named. */

/* ---- The formula ---- */

static inline uint64_t task_name_bits(duite_object name)
{
    return (uint64_t)name.generation << 32 | name.slot; /* as it lies in memory */
}

/* The hash of a fork: it begins with what is forked, and goes on with each object. It is a sum of
 * products: no multiplication waits for another one. */
#define TASK_HASH_ODD UINT64_C(0x9e3779b97f4a7c15)

static inline uint64_t task_fork_hash(uint64_t what)
{
    return what * TASK_HASH_ODD;
}

static inline uint64_t task_fork_hash_on(uint64_t hash, size_t i, duite_object name)
{
    return hash + task_name_bits(name) * (TASK_HASH_ODD * (2 * i + 3));
}

static inline uint64_t task_fork_hash_all(uint64_t what, size_t n, const duite_object *objects)
{
    uint64_t hash = task_fork_hash(what);
    for (size_t i = 0; i < n; i++)
        hash = task_fork_hash_on(hash, i, objects[i]);
    return hash;
}

/* For all ranks a fork is its kernel's index and the rank that it names. */
static inline uint64_t task_fork_what(uint32_t kernel, int at)
{
    return (uint64_t)kernel << 32 | (uint32_t)at;
}

/* ---- The history: a ring of the last calls that are part of the fingerprint ---- */

enum { TASK_HISTORY_CALLS = 1024 };

/* A call in the history: its kind, for a fork its kernel, and the forks of the main program up to
 * it. */
enum task_call_kind {
    TASK_FORKED,   /* a kernel */
    TASK_RECORDED, /* a kernel, while a graph is recorded */
    TASK_CALLED    /* a function: enum task_called */
};

enum task_called {
    TASK_CALLED_OTHER, /* none of these */
    TASK_CALLED_NEW,
    TASK_CALLED_NEW_SIZED,
    TASK_CALLED_HINT,
    TASK_CALLED_COLOCATE,
    TASK_CALLED_SET,
    TASK_CALLED_FREE,
    TASK_CALLED_GRAPH_BIND,
    TASK_CALLED_GRAPH_FREE,
    TASK_CALLED_REPLAY,
    TASK_CALLED_REPLAY_WHILE,
    TASK_CALLED_GET,
    TASK_CALLED_GET_AT,
    TASK_CALLED_GET_COUNT,
    TASK_CALLED_WAIT,
    TASK_CALLED_STOP,
    TASK_CALLED_COUNT_ALL,
    TASK_N_CALLED
};

/* 2 bits of kind, 22 of kernel or function, 40 of forks: no program has so many of either. */
static inline uint64_t task_call_bits(enum task_call_kind kind, uint32_t which, uint64_t forks)
{
    return ((uint64_t)kind << 22 | which) << 40 | forks;
}
static inline enum task_call_kind task_call_kind(uint64_t call)
{
    return (enum task_call_kind)(call >> 62);
}
static inline uint32_t task_call_which(uint64_t call)
{
    return (uint32_t)(call >> 40 & 0x3fffff);
}
static inline uint64_t task_call_forks(uint64_t call)
{
    return call & 0xffffffffff;
}

/* The function of that name, and back. */
enum task_called task_called_find(const char *name);
const char *task_called_name(uint32_t called);

/* Written by the main thread: an entry of the ring, and then `calls`. */
struct task_history {
    _Atomic uint64_t calls; /* so far; the first one is 1 */
    struct task_history_entry {
        _Atomic uint64_t fingerprint; /* of all calls up to this one */
        _Atomic uint64_t call;        /* task_call_bits */
    } entry[TASK_HISTORY_CALLS];      /* by number of the call */
};

/* Stores with release: a reader that sees one of them sees in `calls` that the ring came so far. */
static inline void task_history_add(struct task_history *history, uint64_t fingerprint,
                                    uint64_t call)
{
    const uint64_t n = atomic_load_explicit(&history->calls, memory_order_relaxed) + 1;
    struct task_history_entry *entry = &history->entry[n % TASK_HISTORY_CALLS];
    atomic_store_explicit(&entry->fingerprint, fingerprint, memory_order_release);
    atomic_store_explicit(&entry->call, call, memory_order_release);
    atomic_store_explicit(&history->calls, n, memory_order_release);
}

/* The calls first .. last as they were at some moment; call n lies in [n % TASK_HISTORY_CALLS]. */
struct task_history_copy {
    uint64_t first, last;
    struct {
        uint64_t fingerprint, call;
    } entry[TASK_HISTORY_CALLS];
};

/* Any thread, while the main thread goes on. */
void task_history_read(struct task_history *history, struct task_history_copy *copy);

#endif
