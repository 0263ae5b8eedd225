#ifndef DUITE_DATA_VERSION_H
#define DUITE_DATA_VERSION_H

#include "runtime/data/failure.h"
#include "runtime/data/packet.h"

#include <stdatomic.h>
#include <stdbool.h>

struct graph_task;

/* A link that makes a task wait for something: embedded in the task's access. */
struct data_waiter {
    struct data_waiter *next;
    struct graph_task *task;
};

/* The value of an object between two writes, on one rank.
 *
 * A version is held by its producer (a task, or a message on its way), by the object while it is
 * the current one, and by each task that reads it. Whoever releases the last hold passes the
 * version on: to its heir, the task that overwrites the bytes in place and frees the version, or,
 * if there is none, to the allocator. So a writer waits for one thing only, and no list of readers
 * is kept. */
struct data_version {
    _Atomic(struct data_waiter *)
        waiters; /* tasks that want to read; DATA_PRODUCED once they may */
    _Atomic uint32_t holds;
    struct data_waiter *heir; /* set before the object's hold is released */
    struct data_packet
        *packet; /* NULL: no bytes yet; they are undefined, or the version is poisoned */
    const struct data_failure *failure; /* poison, or NULL; set before it is produced */
    size_t renamed; /* cache lines of the packet that took its place, or 0: counted until it dies */
    _Atomic uint64_t *rename_bytes; /* there, in bytes; set like the heir */
};

/* A version held by its producer and by its object. NULL without memory. */
struct data_version *data_version_new(void);

/* Lets `waiter` wait for the value. False if the value is there already: then nothing is kept. The
 * caller holds it. */
bool data_version_await(struct data_version *version, struct data_waiter *waiter);

/* The value is there: returns the list of waiters, linked by next. The producer still holds the
 * version. */
struct data_waiter *data_version_produced(struct data_version *version);

/* Whether the value is there. */
bool data_version_ready(const struct data_version *version);

static inline void data_version_hold(struct data_version *version)
{
    atomic_fetch_add_explicit(&version->holds, 1, memory_order_relaxed);
}

/* Whether nobody but the object that has it holds the version: it stays so. */
static inline bool data_version_is_alone(const struct data_version *version)
{
    return atomic_load_explicit(&version->holds, memory_order_relaxed) == 1;
}

/* Releases a hold. Returns the heir if this was the last one, and NULL otherwise; frees a version
 * without heir. */
struct data_waiter *data_version_release(struct data_version *version);

/* Frees a version whose bytes were taken over by its heir, or that never had any. */
void data_version_free(struct data_version *version);

#endif
