/* Sleeping, waking and counting. The sleeper sets `asleep` to 1; a waker or the sleeper itself,
 * whichever is first, sets it back to 0. Each worker counts its tasks on its own cache lines, and
 * readers add them up: so a task costs no shared line. Tasks that are awaited beside forked ones
 * count in `more` before they can be over. */
#include "runtime/queue/pool.h"

#include <errno.h>
#include <time.h>

bool queue_park_start(struct queue_park *park)
{
    pthread_condattr_t monotonic;
    atomic_init(&park->asleep, 0);
    pthread_mutex_init(&park->lock, NULL);
    if (pthread_condattr_init(&monotonic))
        return false;
    bool fine = !pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC) &&
                !pthread_cond_init(&park->wake, &monotonic);
    pthread_condattr_destroy(&monotonic);
    return fine;
}

void queue_park_stop(struct queue_park *park)
{
    pthread_cond_destroy(&park->wake);
    pthread_mutex_destroy(&park->lock);
}

void queue_park_announce(struct queue_park *park)
{
    atomic_store_explicit(&park->asleep, 1, memory_order_seq_cst);
    atomic_thread_fence(memory_order_seq_cst);
}

void queue_park_cancel(struct queue_park *park)
{
    atomic_store_explicit(&park->asleep, 0, memory_order_relaxed);
}

static struct timespec park_until(double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    long nanoseconds = until.tv_nsec + (long)(1e9 * seconds);
    until.tv_sec += nanoseconds / 1000000000;
    until.tv_nsec = nanoseconds % 1000000000;
    return until;
}

void queue_park_sleep(struct queue_park *park, double seconds)
{
    struct timespec until = park_until(seconds);
    int code = 0;
    pthread_mutex_lock(&park->lock);
    while (code != ETIMEDOUT && atomic_load_explicit(&park->asleep, memory_order_acquire)) {
        if (seconds > 0)
            code = pthread_cond_timedwait(&park->wake, &park->lock, &until);
        else
            code = pthread_cond_wait(&park->wake, &park->lock);
    }
    pthread_mutex_unlock(&park->lock);
    queue_park_cancel(park);
}

bool queue_park_wake(struct queue_park *park)
{
    int asleep = 1;
    if (!atomic_load_explicit(&park->asleep, memory_order_relaxed) ||
        !atomic_compare_exchange_strong_explicit(&park->asleep, &asleep, 0, memory_order_acq_rel,
                                                 memory_order_relaxed))
        return false;
    pthread_mutex_lock(&park->lock);
    pthread_cond_signal(&park->wake);
    pthread_mutex_unlock(&park->lock);
    return true;
}

/* ---- Waking ---- */

void queue_wake_one(struct queue_pool *pool, unsigned queue)
{
    if (!atomic_load_explicit(&pool->parked, memory_order_seq_cst))
        return;
    unsigned n = pool->n, first = queue < n ? queue : 0;
    for (unsigned i = 0; i < n; i++)
        if (queue_park_wake(&pool->worker[(first + i) % n].park))
            return;
}

void queue_notify(struct queue_pool *pool)
{
    if (!pool)
        return;
    atomic_thread_fence(memory_order_seq_cst);
    queue_park_wake(&pool->worker[0].park);
}

/* ---- Counts of tasks ---- */

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

static inline void count_one(_Atomic uint64_t *count)
{
    const uint64_t before = atomic_load_explicit(count, memory_order_relaxed);
    atomic_store_explicit(count, before + 1, memory_order_release);
}

void queue_over(struct queue_pool *pool, struct worker *worker)
{
    count_one(&worker->counts.over);
    if (atomic_load_explicit(&pool->wanted, memory_order_relaxed) && queue_main_has_enough(pool))
        queue_notify(pool);
}

void queue_more(struct worker *worker)
{
    count_one(&worker->counts.more);
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
