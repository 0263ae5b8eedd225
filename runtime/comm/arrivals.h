#ifndef DUITE_COMM_ARRIVALS_H
#define DUITE_COMM_ARRIVALS_H

#include "runtime/base/clock.h"
#include "runtime/comm/comm.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

/* For how long messages were awaited. `clock` is one word, so that it is read without a lock: while
 * none is awaited the ticks so far, with bit 0 clear; else these minus the moment since when, with
 * bit 0 set. Written under the lock of whoever counts. */
struct comm_gauge {
    uint64_t awaited; /* messages */
    _Atomic uint64_t clock;
};

/* Ticks, up to now, in which messages were awaited. Any thread. */
static inline uint64_t comm_gauge_ticks(const struct comm_gauge *gauge)
{
    uint64_t clock = atomic_load_explicit(&gauge->clock, memory_order_relaxed);
    return clock & 1 ? clock - 1 + base_ticks() : clock;
}

/* So many messages more are awaited, or fewer. Under the lock. */
static inline void comm_gauge_add(struct comm_gauge *gauge, int64_t messages)
{
    uint64_t before = gauge->awaited;
    gauge->awaited += (uint64_t)messages;
    if (!before == !gauge->awaited)
        return;
    uint64_t clock = atomic_load_explicit(&gauge->clock, memory_order_relaxed);
    clock = before ? clock - 1 + base_ticks() : clock - base_ticks();
    clock = (clock & ~UINT64_C(1)) | (gauge->awaited > 0);
    atomic_store_explicit(&gauge->clock, clock, memory_order_relaxed);
}

/* Brings packets that arrive together with whom they are for, whichever comes first. Safe from any
 * thread. */
struct comm_arrivals {
    pthread_mutex_t lock;
    bool closed;
    struct comm_gauge gauge; /* of the packets that are expected and not there */
    struct comm_arrival
        *table; /* uthash by key: expected and not all there, or there and not expected yet */
};

void comm_arrivals_start(struct comm_arrivals *arrivals);
void comm_arrivals_stop(struct comm_arrivals *arrivals); /* frees packets that nobody wanted */

/* Notes a target for so many packets; *early gets those that came already, linked by next. False
 * without memory. */
bool comm_arrivals_expect(struct comm_arrivals *arrivals, struct data_key key,
                          struct comm_target target, uint32_t packets, struct data_packet **early);

enum comm_take {
    COMM_WANTED, /* *target is set: deliver it */
    COMM_KEPT,   /* until it is expected */
    COMM_LOST    /* nobody will ever want it, or there is no memory: the caller frees it */
};

/* A packet came. */
enum comm_take comm_arrivals_take(struct comm_arrivals *arrivals, struct data_packet *packet,
                                  struct comm_target *target);

/* So many messages more, or fewer, are awaited elsewhere: for the gauge. */
void comm_arrivals_also(struct comm_arrivals *arrivals, int messages);

/* Calls back with all that is awaited, and how many packets of it. Meanwhile nobody is given a
 * packet that is awaited here. */
void comm_arrivals_look(struct comm_arrivals *arrivals,
                        void (*awaited)(void *context, const struct data_key *key,
                                        const struct comm_target *target, uint32_t packets),
                        void *context);

/* From the first call on nothing is expected any more, and what comes is lost. Returns one by one
 * the targets that wait, each once for every packet that it wants; false: there are no more. */
bool comm_arrivals_close(struct comm_arrivals *arrivals, struct comm_target *target);

#endif
