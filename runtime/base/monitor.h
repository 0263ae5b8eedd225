#ifndef DUITE_BASE_MONITOR_H
#define DUITE_BASE_MONITOR_H

#include <pthread.h>
#include <stdbool.h>

/* The monitor: the one service thread of a rank. It makes looks, each with a period of its own, and
 * sleeps in between: the heartbeat of comm, the standstill of workers.
 *
 * The thread starts with the first look that is added and ends with the last one that is removed; a
 * monitor that is all zero has none. It takes no signals. One look is made at a time, so a look
 * that takes long delays the others: it may wait for milliseconds, not for a task or a message. */

/* A look. Its memory is the caller's, and stays in place from base_monitor_add to
 * base_monitor_remove. */
struct base_look {
    /* Looks once. False: it could not look now, and is called again in a moment (0.1 ms). By the
     * monitor's thread. It adds and removes no look. */
    bool (*look)(void *context);
    void *context;
    double seconds; /* between two looks, and before the first; INFINITY: none so far */
    /* The monitor's: */
    double due; /* by base_seconds */
    bool added;
    struct base_look *next;
};

struct base_monitor {
    struct base_look *looks; /* this and the next four under the lock */
    struct base_look *looking;
    bool stop;
    pthread_cond_t wake; /* of the thread: looks have changed */
    pthread_cond_t done; /* of base_monitor_remove: a look is over */
    pthread_mutex_t lock;
    pthread_t thread;
};

/* The functions below are for one thread, the one that starts and stops the runtime. */

/* Adds a look, which is made from now on. The first one starts the thread; where that fails nothing
 * was added. Errors: memory, DUITE_E_SYSTEM. */
int base_monitor_add(struct base_monitor *monitor, struct base_look *look);

/* Changes the period of a look, in seconds. */
void base_monitor_set_period(struct base_monitor *monitor, struct base_look *look, double seconds);

/* Removes a look; when this returns it is not being made. Removing the last one ends the thread.
 * Does nothing with a look that was not added. */
void base_monitor_remove(struct base_monitor *monitor, struct base_look *look);

#endif
