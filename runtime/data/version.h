#ifndef DUITE_DATA_VERSION_H
#define DUITE_DATA_VERSION_H

#include "runtime/base/memory.h"
#include "runtime/data/law.h"
#include "runtime/data/order.h"
#include "runtime/data/packet.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* ---- Poison ---- */

/* Why a value is poisoned: the task that failed. Plain bytes: it travels between ranks in place of
 * the value.
 *
 * Its place in the reference order is `number` and, for a task forked by a task, `path`. The path
 * has the task's index among the children of each ancestor, outermost first, in a code that orders
 * like the numbers (data_path_add). The end of a longer path is cut off: among tasks that differ
 * only there, any one may count as the first. A path that is cut off and a whole one are in
 * order. */
struct data_failure {
    int32_t code;         /* of the body, or of the runtime (memory) */
    int32_t rank;         /* where the task ran */
    uint64_t number;      /* of the main program's task in fork order */
    uint32_t kernel;      /* index in the list given at start */
    uint32_t path_length; /* bytes */
    uint8_t path[104];    /* "" for a task of the main program; zeros behind its end */
    char text[204];       /* the body's own message, or "" */
    uint8_t unused[4];
};

/* Appends an index > 0 to the path, if it still fits. */
void data_path_add(struct data_failure *failure, uint64_t index);

/* Writes the task's place as "number.index.index"; `size` bytes at most, cut off with "...". */
void data_path_print(const struct data_failure *failure, char *text, size_t size);

/* The one that comes first in the reference order; either may be NULL. */
static inline const struct data_failure *data_failure_first(const struct data_failure *a,
                                                            const struct data_failure *b)
{
    if (!a || !b)
        return a ? a : b;
    if (a->number != b->number)
        return b->number < a->number ? b : a;
    return memcmp(b->path, a->path, sizeof a->path) < 0 ? b : a;
}

/* ---- Versions ---- */

/* A task's link to a version or a sum that it waits for, embedded in the task. A reader is a link
 * in the version's list until the value is there, and only then knows the version. An heir knows
 * the version that it writes, which gets the old version's bytes when the last hold on them is
 * released. */
struct data_waiter {
    union {
        struct data_waiter *next;     /* of a reader that waits */
        struct data_version *version; /* to be read, or written */
    };
    uint32_t back; /* bytes from the beginning of the task; 0: the waiter is no task */
    uint32_t mode; /* of the access it is embedded in */
};

/* A packet for at most one line of values, not zeroed. It is inline, with a constant size, because
 * most packets need no more. NULL without memory. */
static inline struct data_packet *data_packet_line(size_t bytes)
{
    struct data_packet *packet = base_pool_take(2 * sizeof *packet);
    if (!packet)
        return NULL;
    memset(packet, 0, sizeof *packet);     /* in two parts, as data_object_clear */
    memset(packet + 1, 0, sizeof *packet); /* the last line is sent whole */
    packet->bytes = bytes;
    packet->lines = 2;
    return packet;
}

/* The value of an object between two writes, on one rank.
 *
 * A version has these holders: its producer (a task, or a message on its way), the object while the
 * version is current, and each task that reads it. Releasing the last hold passes the bytes to the
 * heir, a task that overwrites them in place, or to the allocator if there is no heir. So a writer
 * waits for one thing only, and no list of readers is kept. */
struct data_version {
    _Atomic(struct data_waiter *)
        waiters; /* tasks that want to read; DATA_PRODUCED once they may */
    _Atomic uint32_t holds;
    bool sized : 1;   /* its size is its own */
    bool lent : 1;    /* its memory is that of a scope, which lives longer: see task_cell */
    bool adopted : 1; /* its bytes may be the program's memory: its object's is */
    bool poisoned;    /* in place of bytes; set before it is produced */
    uint8_t type;
    size_t max; /* elements there may be; there are as many, or fewer if it is sized */
    struct data_waiter *heir; /* set before the object's hold is released */
    union {
        struct data_packet *packet;         /* NULL: no bytes yet; they are undefined */
        const struct data_failure *failure; /* poisoned: why; never NULL */
    };
};

/* In place of a list of waiters: the value is there. */
#define DATA_PRODUCED ((struct data_waiter *)1)

/* A version held by its producer and by its object. NULL without memory. */
static inline struct data_version *data_version_new(duite_type type, size_t max, bool sized,
                                                    bool adopted)
{
    struct data_version *version = base_pool_take(sizeof *version);
    if (!version)
        return NULL;
    *version = (struct data_version){
        .holds = 2, .type = (uint8_t)type, .max = max, .sized = sized, .adopted = adopted};
    return version;
}

/* Frees a version whose bytes were taken over, or that never had any. */
static inline void data_version_free(struct data_version *version)
{
    if (!version->lent)
        base_pool_give(version, sizeof *version);
}

/* Bytes of the largest version. */
static inline size_t data_version_room(const struct data_version *version)
{
    return version->max * data_type_size((duite_type)version->type);
}

/* Why there are no bytes, or NULL. */
static inline const struct data_failure *data_version_failure(const struct data_version *version)
{
    return version->poisoned ? version->failure : NULL;
}

/* The bytes; NULL: none yet, or it is poisoned. */
static inline struct data_packet *data_version_packet(const struct data_version *version)
{
    return version->poisoned ? NULL : version->packet;
}

/* Puts poison in place of the bytes, which are freed; failure NULL: changes nothing. */
void data_version_poison(struct data_version *version, const struct data_failure *failure);

/* Lets `waiter` wait for the value. False if the value is there already: then the producer's writes
 * are seen, and the waiter knows the version. The caller holds it. */
static inline bool data_version_await(struct data_version *version, struct data_waiter *waiter)
{
    struct data_waiter *first = atomic_load_explicit(&version->waiters, memory_order_acquire);
    do {
        if (first == DATA_PRODUCED) {
            waiter->version = version;
            return false;
        }
        waiter->next = first;
    } while (!atomic_compare_exchange_weak_explicit(&version->waiters, &first, waiter,
                                                    memory_order_acq_rel, memory_order_acquire));
    return true;
}

/* The waiters, linked by next; NULL if the value is there. The list is valid as long as something
 * keeps the value from being produced. */
static inline const struct data_waiter *data_version_waiters(const struct data_version *version)
{
    struct data_waiter *first = atomic_load_explicit(&version->waiters, memory_order_acquire);
    return first == DATA_PRODUCED ? NULL : first;
}

/* The value is there: returns the list of waiters, linked by next. The producer still holds the
 * version. */
static inline struct data_waiter *data_version_produced(struct data_version *version)
{
    return atomic_exchange_explicit(&version->waiters, DATA_PRODUCED, memory_order_acq_rel);
}

/* True if the value is there. */
static inline bool data_version_ready(const struct data_version *version)
{
    return atomic_load_explicit(&version->waiters, memory_order_acquire) == DATA_PRODUCED;
}

static inline void data_version_hold(struct data_version *version)
{
    atomic_fetch_add_explicit(&version->holds, 1, memory_order_relaxed);
}

/* No hold is left, and there is no heir: frees it with its bytes. */
void data_version_drop(struct data_version *version);

/* Hands the bytes to the version that the heir writes, or the poison if the heir also reads (rw).
 * Frees the old version. */
static inline void data_version_take_over(struct data_version *old, const struct data_waiter *heir)
{
    struct data_version *version = heir->version;
    if (!old->poisoned) {
        version->packet = old->packet;
    } else if (heir->mode == DUITE_RW) {
        version->poisoned = true;
        version->failure = old->failure;
    }
    data_version_free(old);
}

/* No hold is left: returns the heir, or frees a version without one. */
static inline struct data_waiter *data_version_end(struct data_version *version)
{
    struct data_waiter *heir = version->heir;
    if (!heir)
        data_version_drop(version);
    else if (heir->back)
        data_version_take_over(version, heir);
    return heir;
}

/* Releases a hold. Returns the heir if this was the last one, and NULL otherwise. The version is
 * then freed, unless its heir is no task. The last release sees every access to the bytes. */
static inline struct data_waiter *data_version_release(struct data_version *version)
{
    if (atomic_fetch_sub_explicit(&version->holds, 1, memory_order_acq_rel) != 1)
        return NULL;
    return data_version_end(version);
}

/* ---- The order rule (order.h) ---- */

/* A reader waits for the value, and the next writer for its hold. True if there is nothing to wait
 * for. */
static inline bool data_version_read(struct data_version *version, struct data_waiter *reader)
{
    if (data_order_waits(true, false))
        data_version_hold(version);
    if (data_order_waits(false, true))
        return !data_version_await(version, reader);
    reader->version = version;
    return true;
}

/* The reader is over. Returns the heir if it waits for nothing more, as data_version_release. */
static inline struct data_waiter *data_version_was_read(struct data_version *version)
{
    return data_order_waits(true, false) ? data_version_release(version) : NULL;
}

/* A writer, whose version is `out`, waits for all holds on the one before it, which loses that of
 * its object: `old` or NULL. True if there is nothing to wait for. */
static inline bool data_version_overwrite(struct data_version *old, struct data_version *out,
                                          struct data_waiter *writer)
{
    writer->version = out;
    if (!old)
        return true;
    old->heir = writer;
    return data_version_release(old) != NULL;
}

#pragma GCC visibility pop

#endif
