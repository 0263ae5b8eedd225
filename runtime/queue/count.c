/* Counts of tasks. Each worker counts its own on its own cache lines, and readers add them up: so a
 * task costs no shared line. Tasks that are awaited beside forked ones count in `more` before they
 * can be over. */
#include "runtime/queue/pool.h"

#include <stdlib.h>

/* Never counts too many: `over` is read first. */
uint64_t queue_all_over(const struct queue_pool *pool)
{
    uint64_t sum = 0;
    for (unsigned i = 0; i < pool->n; i++)
        sum += atomic_load_explicit(&pool->worker[i].counts.over, memory_order_acquire);
    for (unsigned i = 0; i < pool->n; i++)
        sum -= atomic_load_explicit(&pool->worker[i].counts.more, memory_order_acquire);
    return sum;
}

bool queue_main_has_enough(const struct queue_pool *pool)
{
    uint64_t awaited = atomic_load_explicit(&pool->awaited, memory_order_relaxed);
    uint64_t wanted = atomic_load_explicit(&pool->wanted, memory_order_relaxed);
    return awaited && awaited - queue_all_over(pool) < (wanted ? wanted : 1);
}

static inline void count_over(struct queue_pool *pool, _Atomic uint64_t *count, uint64_t tasks)
{
    const uint64_t before = atomic_load_explicit(count, memory_order_relaxed);
    atomic_store_explicit(count, before + tasks, memory_order_release);
    if (atomic_load_explicit(&pool->wanted, memory_order_relaxed) && queue_main_has_enough(pool))
        queue_notify(pool);
}

void queue_over(struct queue_pool *pool, struct worker *worker, int tasks)
{
    count_over(pool, tasks < 0 ? &worker->counts.more : &worker->counts.over, (uint64_t)abs(tasks));
}

void queue_over_one(struct queue_pool *pool, struct worker *worker)
{
    count_over(pool, &worker->counts.over, 1);
}

void queue_bodies(struct queue_pool *pool, uint64_t *bodies, double *seconds)
{
    uint64_t ticks = 0;
    *bodies = 0;
    for (unsigned i = 0; i < pool->n; i++) {
        const struct queue_counts *counts = &pool->worker[i].counts;
        *bodies += atomic_load_explicit(&counts->tasks, memory_order_relaxed);
        ticks += atomic_load_explicit(&counts->busy, memory_order_relaxed);
    }
    *seconds = pool->tick * (double)ticks;
}
