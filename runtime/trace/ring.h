#ifndef DUITE_TRACE_RING_H
#define DUITE_TRACE_RING_H

#include "runtime/base/clock.h"
#include "runtime/trace/format.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

enum { TRACE_RING = 1 << 15 }; /* events */

/* One writer, the worker; one reader at a time, under the lock of the file. The writer moves `head`
 * when an event is whole, the reader `tail` when it has copied it. */
struct trace_ring {
    struct trace_event *event; /* TRACE_RING of them */
    const _Atomic int *on;
    unsigned worker;
    uint64_t known; /* tail, as the writer saw it last */
    _Alignas(64) _Atomic uint64_t head;
    _Atomic uint64_t lost;
    _Alignas(64) _Atomic uint64_t tail;
};

/* Room for one more event, to be filled and then put; NULL: it is lost. */
static inline struct trace_event *trace_next(struct trace_ring *ring)
{
    uint64_t head = atomic_load_explicit(&ring->head, memory_order_relaxed);
    if (head - ring->known == TRACE_RING)
        ring->known = atomic_load_explicit(&ring->tail, memory_order_acquire);
    if (head - ring->known < TRACE_RING)
        return &ring->event[head % TRACE_RING];
    uint64_t lost = atomic_load_explicit(&ring->lost, memory_order_relaxed);
    atomic_store_explicit(&ring->lost, lost + 1, memory_order_relaxed);
    return NULL;
}

/* Puts an event, unless steps are not recorded now. `ring` NULL is fine. By the worker. */
static inline void trace_put(struct trace_ring *ring, const struct trace_event *event)
{
    if (!ring || !atomic_load_explicit(ring->on, memory_order_relaxed))
        return;
    struct trace_event *room = trace_next(ring);
    if (!room)
        return;
    *room = *event;
    atomic_store_explicit(&ring->head, atomic_load_explicit(&ring->head, memory_order_relaxed) + 1,
                          memory_order_release);
}

/* Something without a duration, now. */
static inline void trace_mark(struct trace_ring *ring, enum trace_kind kind, uint32_t kernel,
                              uint64_t number)
{
    if (ring)
        trace_put(ring, &(struct trace_event){.begin = base_ticks(),
                                              .kernel = kernel,
                                              .number = number,
                                              .kind = (uint8_t)kind});
}

/* Whether it is to be written soon. By the worker. */
static inline bool trace_is_full(const struct trace_ring *ring)
{
    uint64_t head = atomic_load_explicit(&ring->head, memory_order_relaxed);
    return head - atomic_load_explicit(&ring->tail, memory_order_relaxed) > TRACE_RING / 4 * 3;
}

#endif
