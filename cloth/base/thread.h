#ifndef CLOTH_BASE_THREAD_H
#define CLOTH_BASE_THREAD_H

#include <pthread.h>
#include <signal.h>
#include <time.h>

/* Threads beside those of the runtime, and the clock that they go by. */

/* Starts a thread that takes no signals: those are the other threads'. Returns 0 or an error
 * number. */
static inline int cloth_thread_start(pthread_t *thread, void *(*run)(void *context), void *context)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(thread, NULL, run, context);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return failed;
}

/* Seconds of a clock that only runs forward. */
static inline double cloth_seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

#endif
