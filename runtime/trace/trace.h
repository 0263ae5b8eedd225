#ifndef DUITE_TRACE_TRACE_H
#define DUITE_TRACE_TRACE_H

#include "runtime/base/clock.h"
#include "runtime/data/object.h"
#include "runtime/plan/record.h"
#include "runtime/task/fork.h"
#include "runtime/trace/format.h"

#include <mpi.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

/* A running rank writes its trace. Workers put events into rings of their own. The main thread
 * writes these to the file between steps; a worker writes its own between two tasks when it gets
 * full. Events that do not fit are counted as lost. A failure of the file ends the writing, not the
 * run; trace_close returns it. */
struct trace;

struct trace_setup {
    const char *file; /* of rank 0; the others add .RANK */
    uint64_t first, end;
    int rank, n_ranks;
    unsigned workers;
    const struct task_graph *graph; /* its kernels are named, by their index */
};

/* Opens the file of this rank, which is replaced. Local. Errors: memory; DUITE_E_SYSTEM if it
 * cannot be written. */
int trace_open(struct trace **trace, const struct trace_setup *setup);

/* Aligns the clocks, at the start and at the end: rank 0 makes round trips with one rank after the
 * other, and keeps the shortest. Ranks that do not answer within some seconds stay unaligned. Uses
 * a duplicate of the communicator, which the first call makes. No other thread calls MPI meanwhile.
 * Collective, main thread. */
void trace_align(struct trace *trace, MPI_Comm mpi);

/* Ends the trace: writes the rest. `counters`: one a worker, or NULL for want of memory. Returns 0,
 * or DUITE_E_SYSTEM with a message if not everything was written. Main thread; no task runs. */
int trace_close(struct trace *trace, const struct trace_counters *counters);
/* Frees the trace, closed or not. `mpi`: MPI may be called; then this is collective. NULL is fine.
 */
void trace_free(struct trace *trace, bool mpi);

/* True if this step is to be recorded; if events are recorded at the moment. */
bool trace_wants(const struct trace *trace, uint64_t step);
bool trace_is_on(const struct trace *trace);
/* Recording begins or ends with a step, when no task runs; forks: so far. Main thread. */
void trace_switch(struct trace *trace, bool on, uint64_t step, uint64_t forks);

/* ---- Events of the workers ---- */

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

/* Puts an event without a duration, now. */
static inline void trace_mark(struct trace_ring *ring, enum trace_kind kind, uint32_t kernel,
                              uint64_t number)
{
    if (ring)
        trace_put(ring, &(struct trace_event){.begin = base_ticks(),
                                              .kernel = kernel,
                                              .number = number,
                                              .kind = (uint8_t)kind});
}

/* True if the ring must be written soon. By the worker. */
static inline bool trace_is_full(const struct trace_ring *ring)
{
    uint64_t head = atomic_load_explicit(&ring->head, memory_order_relaxed);
    return head - atomic_load_explicit(&ring->tail, memory_order_relaxed) > TRACE_RING / 4 * 3;
}

/* The ring of a worker; NULL on a rank without a trace. */
struct trace_ring *trace_ring(struct trace *trace, unsigned worker);

/* Writes the worker's ring if it is nearly full and no other thread is writing. By that worker,
 * between two tasks. */
void trace_relieve(struct trace *trace, struct trace_ring *ring);
/* Writes all rings. Main thread. */
void trace_flush(struct trace *trace);

/* ---- Calls of the main program. Main thread; only rank 0 writes. NULL is fine. ---- */

void trace_object(struct trace *trace, const struct data_table *table, duite_object name);
void trace_freed(struct trace *trace, duite_object name);
void trace_hint(struct trace *trace, duite_object name, double weight, size_t n,
                const duite_object *neighbours, const double *edge_weights);
void trace_colocate(struct trace *trace, duite_object name, duite_object leader);
/* settles: notes the objects without a home, before they get one. settled: afterwards, the homes
 * that they got. */
void trace_settles(struct trace *trace, const struct data_table *table);
void trace_settled(struct trace *trace, const struct data_table *table);
/* Homes of objects that moved. */
void trace_moved(struct trace *trace, const struct data_table *table, const uint32_t *slots,
                 size_t n);
void trace_fork(struct trace *trace, const duite_kernel *kernel, const struct task_options *options,
                size_t n, const duite_object *objects);
void trace_set(struct trace *trace, duite_object name);
void trace_get(struct trace *trace, duite_object name, int rank, uint64_t from);
void trace_get_begin(struct trace *trace, duite_object name, uint32_t get);
void trace_get_end(struct trace *trace, uint32_t get, uint64_t from);
void trace_wait(struct trace *trace, uint64_t from);
/* The graph has a kernel more: all kernels once again. On every rank. */
void trace_kernels(struct trace *trace);
void trace_graph(struct trace *trace, uint32_t name, const struct plan_record *record);
/* A replay, before it begins. rounds: how many at most. */
void trace_replay(struct trace *trace, uint32_t name, const struct plan_record *record,
                  const duite_object *flag, uint64_t rounds);

#endif
