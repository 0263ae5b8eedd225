/* The watching thread knows nothing but counters that others keep anyway. While it tells, it reads
 * tasks that run: their workers are kept from going on when the body is over. Each of them stores
 * that it left the task and then loads `watched`; the watcher sets `watched` and then loads what
 * the worker runs. One of the two must see the other: the fence for that is membarrier(2) on the
 * watcher's side alone, which runs one on all threads of the process, so that it costs a task no
 * more than a store and a load. */
#include "runtime/workers/watch.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/workers/internal.h"

#include <signal.h>

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
        const struct work_worker *worker = &pool->worker[i];
        const struct counts *counts = &worker->counts;
        sum = sum * odd + (uintptr_t)atomic_load_explicit(&worker->runs, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->over, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->tasks, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->placed, memory_order_relaxed);
        sum = sum * odd + atomic_load_explicit(&counts->chained, memory_order_relaxed);
    }
    return pool->setup.comm ? sum * odd + comm_movement(pool->setup.comm) : sum;
}

static void *watch_main(void *argument)
{
    struct work_pool *pool = argument;
    struct work_watch *watch = &pool->watch;
    double patience = watch->seconds, since = base_seconds();
    uint64_t before = movement(pool);
    bool told = false;
    for (;;) {
        work_park_announce(&watch->park);
        if (atomic_load_explicit(&pool->stop, memory_order_seq_cst))
            break;
        work_park_sleep(&watch->park, watch->seconds > 8e-3 ? watch->seconds / 8 : 1e-3);
        double now = base_seconds();
        uint64_t moved = movement(pool);
        if (moved != before || !atomic_load_explicit(&watch->waits.call, memory_order_relaxed)) {
            before = moved;
            since = now;
            told = false;
        } else if (!told && now - since >= patience) {
            work_tell(pool, now - since);
            told = true;
            patience *= 2;
        }
    }
    work_park_cancel(&watch->park);
    return NULL;
}

int work_watch_start(struct work_pool *pool, double seconds)
{
    struct work_watch *watch = &pool->watch;
    sigset_t all, before;
    pthread_mutex_init(&watch->lock, NULL);
    if (!work_park_start(&watch->park))
        return base_no_memory("the thread that watches");
    watch->seconds = seconds;
    if (seconds <= 0)
        return DUITE_OK;
    sigfillset(&all); /* signals are for the program's threads */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    watch->started = !pthread_create(&watch->thread, NULL, watch_main, pool);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return watch->started ? DUITE_OK
                          : base_error(DUITE_E_SYSTEM, "cannot start the thread that watches");
}

void work_watch_stop(struct work_pool *pool)
{
    struct work_watch *watch = &pool->watch;
    if (watch->started) {
        atomic_thread_fence(memory_order_seq_cst);
        work_park_wake(&watch->park);
        pthread_join(watch->thread, NULL);
    }
    work_park_stop(&watch->park);
    pthread_mutex_destroy(&watch->lock);
}

void work_watch_passes(struct work_pool *pool)
{
    pthread_mutex_lock(&pool->watch.lock);
    pthread_mutex_unlock(&pool->watch.lock);
}
