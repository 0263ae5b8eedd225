#ifndef DUITE_WORKERS_PARK_H
#define DUITE_WORKERS_PARK_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

/* A place where one worker sleeps. To sleep without missing a wake-up: announce, look once more for
 * what to wait for, then sleep or cancel. Whoever makes something available looks at `asleep`
 * afterwards; both sides are sequentially consistent, so at least one sees the other. */
struct work_park {
    _Atomic int asleep;
    pthread_mutex_t lock;
    pthread_cond_t wake;
};

bool work_park_start(struct work_park *park);
void work_park_stop(struct work_park *park);

void work_park_announce(struct work_park *park);
void work_park_cancel(struct work_park *park);
/* Sleeps until woken, or for so many seconds if they are > 0. */
void work_park_sleep(struct work_park *park, double seconds);

/* Wakes the worker if it sleeps or is about to. Returns whether it did. */
bool work_park_wake(struct work_park *park);

#endif
