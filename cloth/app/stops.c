/* Signals that ask for a stop interrupt no thread: all block them, and one waits for them. So
 * METIS, which installs its own handler while it works, cannot take one for an error, and a program
 * that waits for a file gets it, too. */
#include "cloth/app/simulate_run.h"
#include "cloth/output/output.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

static atomic_int requested;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; /* of what follows */
static bool ends_at_once = true;                         /* nothing was written yet */

static sigset_t stops(void)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR1);
    sigaddset(&set, SIGTERM);
    return set;
}

int simulate_stops(void *context)
{
    (void)context;
    return atomic_load_explicit(&requested, memory_order_relaxed);
}

void simulate_say_unbegun(void)
{
    fprintf(stderr, "duite-cloth: stopped as asked by a signal before the first step; nothing was "
                    "written\n");
}

/* The lock is kept when the process ends, so that nothing is written meanwhile. */
static void *wait_for_stops(void *context)
{
    const sigset_t set = stops();
    (void)context;
    for (;;) {
        int number;
        if (sigwait(&set, &number) != 0)
            continue;
        atomic_store_explicit(&requested, 1, memory_order_relaxed);
        pthread_mutex_lock(&lock);
        if (ends_at_once) {
            simulate_say_unbegun();
            output_locks_remove();
            _exit(SIMULATE_STOPPED);
        }
        pthread_mutex_unlock(&lock);
    }
    return NULL;
}

void simulate_block_signals(void)
{
    const sigset_t set = stops();
    struct sigaction action = {.sa_handler =
                                   SIG_IGN}; /* a write fails with EFBIG, and that is said */
    pthread_sigmask(SIG_BLOCK, &set, NULL);
    sigaction(SIGXFSZ, &action, NULL);
}

int simulate_catch_signals(void)
{
    pthread_t thread;
    if (pthread_create(&thread, NULL, wait_for_stops, NULL) != 0)
        return -1;
    pthread_detach(thread);
    return 0;
}

void simulate_stop_by_step(void)
{
    pthread_mutex_lock(&lock);
    ends_at_once = false;
    pthread_mutex_unlock(&lock);
}
