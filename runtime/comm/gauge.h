#ifndef DUITE_COMM_GAUGE_H
#define DUITE_COMM_GAUGE_H

#include "runtime/base/clock.h"

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

#endif
