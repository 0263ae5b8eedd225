/* The watching thread knows nothing but counters that others keep anyway. While it tells, it reads
 * tasks that run: their workers are kept from going on when the body is over. Each of them stores
 * that it left the task and then loads `watched`; the watcher sets `watched` and then loads what
 * the worker runs. One of the two must see the other: the fence for that is membarrier(2) on the
 * watcher's side alone, which runs one on all threads of the process, so that it costs a task no
 * more than a store and a load. */
#include "runtime/workers/watch.h"

#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

void work_waits(struct work_pool *pool, const struct work_why *why)
{
    struct work_waits *waits = &pool->watch.waits;
    if (why && !why->what) {
        atomic_store_explicit(&waits->slot, why->key->slot, memory_order_relaxed);
        atomic_store_explicit(&waits->generation, why->key->generation, memory_order_relaxed);
        atomic_store_explicit(&waits->number, why->key->number, memory_order_relaxed);
    }
    if (why)
        atomic_store_explicit(&waits->what, why->what, memory_order_relaxed);
    atomic_store_explicit(&waits->tasks, pool->setup.graph->tasks, memory_order_relaxed);
    work_bump(&waits->turn, 1);
    atomic_store_explicit(&waits->call, why ? why->call : NULL, memory_order_release);
}

/* A number that changes with whatever happens on this rank. */
static uint64_t movement(struct work_pool *pool)
{
    const uint64_t odd = 0x9e3779b97f4a7c15u;
    uint64_t sum = atomic_load_explicit(&pool->watch.waits.turn, memory_order_relaxed);
    sum =
        sum * odd + atomic_load_explicit(&pool->setup.graph->root.unfinished, memory_order_relaxed);
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        const struct worker *worker = &pool->worker[i];
        const struct counts *counts = &worker->counts;
        sum = sum * odd + (uintptr_t)atomic_load_explicit(&worker->runs, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->over, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->tasks, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->placed, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->chained, memory_order_relaxed);
    }
    return pool->setup.comm ? sum * odd + comm_movement(pool->setup.comm) : sum;
}

static void look(void *context)
{
    struct work_pool *pool = context;
    struct work_watch *watch = &pool->watch;
    const double now = base_seconds();
    const uint64_t moved = movement(pool);
    if (moved != watch->before || !atomic_load_explicit(&watch->waits.call, memory_order_relaxed)) {
        watch->before = moved;
        watch->since = now;
        watch->told = false;
    } else if (!watch->told && now - watch->since >= watch->patience) {
        work_tell(pool, now - watch->since);
        watch->told = true;
        watch->patience *= 2;
    }
}

int work_watch_start(struct work_pool *pool, double seconds)
{
    struct work_watch *watch = &pool->watch;
    pthread_mutex_init(&watch->lock, NULL);
    if (seconds <= 0)
        return DUITE_OK;
    watch->patience = seconds;
    watch->since = base_seconds();
    watch->before = movement(pool);
    return base_lookout_start(&watch->lookout, "the thread that watches",
                              seconds > 8e-3 ? seconds / 8 : 1e-3, look, pool);
}

void work_watch_stop(struct work_pool *pool)
{
    base_lookout_stop(&pool->watch.lookout);
    pthread_mutex_destroy(&pool->watch.lock);
}

void work_watch_passes(struct work_pool *pool)
{
    pthread_mutex_lock(&pool->watch.lock);
    pthread_mutex_unlock(&pool->watch.lock);
}
