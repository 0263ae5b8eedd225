/* asleep goes from 0 to 1 by the worker and back by whoever gets there first: a waker, or the
 * worker itself. */
#include "runtime/workers/park.h"

#include <errno.h>
#include <time.h>

bool work_park_start(struct work_park *park)
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

void work_park_stop(struct work_park *park)
{
    pthread_cond_destroy(&park->wake);
    pthread_mutex_destroy(&park->lock);
}

void work_park_announce(struct work_park *park)
{
    atomic_store_explicit(&park->asleep, 1, memory_order_seq_cst);
    atomic_thread_fence(memory_order_seq_cst);
}

void work_park_cancel(struct work_park *park)
{
    atomic_store_explicit(&park->asleep, 0, memory_order_relaxed);
}

static struct timespec after(double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    long nanoseconds = until.tv_nsec + (long)(1e9 * seconds);
    until.tv_sec += nanoseconds / 1000000000;
    until.tv_nsec = nanoseconds % 1000000000;
    return until;
}

void work_park_sleep(struct work_park *park, double seconds)
{
    struct timespec until = after(seconds);
    int code = 0;
    pthread_mutex_lock(&park->lock);
    while (code != ETIMEDOUT && atomic_load_explicit(&park->asleep, memory_order_acquire)) {
        if (seconds > 0)
            code = pthread_cond_timedwait(&park->wake, &park->lock, &until);
        else
            code = pthread_cond_wait(&park->wake, &park->lock);
    }
    pthread_mutex_unlock(&park->lock);
    work_park_cancel(park);
}

bool work_park_wake(struct work_park *park)
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
