#ifndef CLOTH_BASE_THREAD_H
#define CLOTH_BASE_THREAD_H

#include <pthread.h>
#include <signal.h>

/* Threads beside those of the runtime. */

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

#endif
