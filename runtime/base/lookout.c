/* `stop` is written and read under the lock. */
#include "runtime/base/lookout.h"

#include "runtime/base/error.h"
#include "runtime/base/thread.h"

#include <errno.h>
#include <signal.h>
#include <time.h>

/* False: it is to stop. */
static bool rest(struct base_lookout *lookout)
{
    struct timespec until;
    int code = 0;
    clock_gettime(CLOCK_MONOTONIC, &until);
    const long whole = (long)lookout->seconds;
    const long parts = until.tv_nsec + (long)(1e9 * (lookout->seconds - (double)whole));
    until.tv_sec += whole + parts / 1000000000;
    until.tv_nsec = parts % 1000000000;
    pthread_mutex_lock(&lookout->lock);
    while (!lookout->stop && code != ETIMEDOUT)
        code = pthread_cond_timedwait(&lookout->wake, &lookout->lock, &until);
    const bool on = !lookout->stop;
    pthread_mutex_unlock(&lookout->lock);
    return on;
}

static void *lookout_main(void *argument)
{
    struct base_lookout *lookout = argument;
    while (rest(lookout))
        lookout->look(lookout->context);
    return NULL;
}

int base_lookout_start(struct base_lookout *lookout, const char *what, double seconds,
                       void (*look)(void *), void *context)
{
    pthread_condattr_t monotonic;
    sigset_t all, before;
    *lookout = (struct base_lookout){.look = look, .context = context, .seconds = seconds};
    if (pthread_condattr_init(&monotonic))
        return base_error(DUITE_E_SYSTEM, "cannot start %s: pthread_condattr_init", what);
    lookout->made = !pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC) &&
                    !pthread_cond_init(&lookout->wake, &monotonic);
    pthread_condattr_destroy(&monotonic);
    pthread_mutex_init(&lookout->lock, NULL);
    sigfillset(&all); /* signals are for the program's threads */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int code = lookout->made
                         ? base_thread_start(&lookout->thread, what, lookout_main, lookout)
                         : base_error(DUITE_E_SYSTEM, "cannot start %s: pthread_cond_init", what);
    lookout->started = !code;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return code;
}

void base_lookout_stop(struct base_lookout *lookout)
{
    if (lookout->started) {
        pthread_mutex_lock(&lookout->lock);
        lookout->stop = true;
        pthread_cond_signal(&lookout->wake);
        pthread_mutex_unlock(&lookout->lock);
        pthread_join(lookout->thread, NULL);
    }
    if (!lookout->made)
        return;
    pthread_cond_destroy(&lookout->wake);
    pthread_mutex_destroy(&lookout->lock);
}
