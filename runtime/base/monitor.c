/* The list of looks is written by one thread and read by the monitor, under the lock. A look is
 * made without the lock; `looking` says which, and whoever removes that one waits until it is over:
 * so a look that was removed is never touched again. */
#include "runtime/base/monitor.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/thread.h"

#include <math.h>
#include <signal.h>
#include <time.h>

#define MOMENT 1e-4 /* s, until a look that could not be made is tried again */

/* ---- The thread ---- */

static struct base_look *monitor_first_due(const struct base_monitor *monitor)
{
    struct base_look *first = monitor->looks;
    for (struct base_look *look = first; look; look = look->next)
        if (look->due < first->due)
            first = look;
    return first;
}

/* Until then, or until somebody wakes it. */
static void monitor_sleep(struct base_monitor *monitor, double until)
{
    if (!isfinite(until)) {
        pthread_cond_wait(&monitor->wake, &monitor->lock);
        return;
    }
    struct timespec time = {.tv_sec = (time_t)until};
    time.tv_nsec = (long)(1e9 * (until - (double)time.tv_sec));
    pthread_cond_timedwait(&monitor->wake, &monitor->lock, &time);
}

static void monitor_make_look(struct base_monitor *monitor, struct base_look *look)
{
    monitor->looking = look;
    pthread_mutex_unlock(&monitor->lock);
    const bool looked = look->look(look->context);
    pthread_mutex_lock(&monitor->lock);
    look->due = base_seconds() + (looked ? look->seconds : MOMENT);
    monitor->looking = NULL;
    pthread_cond_signal(&monitor->done);
}

static void *monitor_main(void *argument)
{
    struct base_monitor *monitor = argument;
    pthread_mutex_lock(&monitor->lock);
    while (!monitor->stop) {
        struct base_look *look = monitor_first_due(monitor);
        if (look && look->due <= base_seconds())
            monitor_make_look(monitor, look);
        else
            monitor_sleep(monitor, look ? look->due : INFINITY);
    }
    pthread_mutex_unlock(&monitor->lock);
    return NULL;
}

/* ---- Start and stop of the thread ---- */

static void monitor_free(struct base_monitor *monitor)
{
    pthread_cond_destroy(&monitor->wake);
    pthread_cond_destroy(&monitor->done);
    pthread_mutex_destroy(&monitor->lock);
}

static int monitor_init(struct base_monitor *monitor)
{
    pthread_condattr_t monotonic;
    if (pthread_condattr_init(&monotonic))
        return base_no_memory("the monitor");
    const int failed = pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC) ||
                       pthread_cond_init(&monitor->wake, &monotonic);
    pthread_condattr_destroy(&monotonic);
    if (failed)
        return base_error(DUITE_E_SYSTEM, "cannot start the monitor: pthread_cond_init");
    pthread_cond_init(&monitor->done, NULL); /* with the defaults it cannot fail on Linux */
    pthread_mutex_init(&monitor->lock, NULL);
    monitor->stop = false;
    return DUITE_OK;
}

static int monitor_start(struct base_monitor *monitor)
{
    sigset_t all, before;
    int code = monitor_init(monitor);
    if (code)
        return code;
    sigfillset(&all); /* signals are for the program's threads */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    code = base_thread_start(&monitor->thread, "the monitor", monitor_main, monitor);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (code)
        monitor_free(monitor);
    return code;
}

/* ---- Looks ---- */

int base_monitor_add(struct base_monitor *monitor, struct base_look *look)
{
    const int code = monitor->looks ? DUITE_OK : monitor_start(monitor);
    if (code)
        return code;
    pthread_mutex_lock(&monitor->lock);
    look->due = base_seconds() + look->seconds;
    look->next = monitor->looks;
    look->added = true;
    monitor->looks = look;
    pthread_cond_signal(&monitor->wake);
    pthread_mutex_unlock(&monitor->lock);
    return DUITE_OK;
}

void base_monitor_set_period(struct base_monitor *monitor, struct base_look *look, double seconds)
{
    pthread_mutex_lock(&monitor->lock);
    look->seconds = seconds;
    look->due = base_seconds() + seconds;
    pthread_cond_signal(&monitor->wake);
    pthread_mutex_unlock(&monitor->lock);
}

void base_monitor_remove(struct base_monitor *monitor, struct base_look *look)
{
    if (!look->added)
        return;
    pthread_mutex_lock(&monitor->lock);
    struct base_look **at = &monitor->looks;
    while (*at != look)
        at = &(*at)->next;
    *at = look->next;
    while (monitor->looking == look)
        pthread_cond_wait(&monitor->done, &monitor->lock);
    const bool last = !monitor->looks;
    monitor->stop = last;
    pthread_cond_signal(&monitor->wake);
    pthread_mutex_unlock(&monitor->lock);
    look->added = false;
    if (!last)
        return;
    pthread_join(monitor->thread, NULL);
    monitor_free(monitor);
}
