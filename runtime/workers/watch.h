#ifndef DUITE_WORKERS_WATCH_H
#define DUITE_WORKERS_WATCH_H

#include "runtime/base/lookout.h"
#include "runtime/data/packet.h"

#include <stdint.h>

/* A thread that looks, a few times in so many seconds, whether the main program waits and nothing
 * of this rank moves: then it tells on standard error, once, who waits for what. Another standstill
 * is told if it lasts twice as long, and so on, so that slow tasks do not fill the screen. */

struct work_pool;

/* What the main program waits for; atomic, so that nobody has to stop for the look at it. */
struct work_waits {
    _Atomic(const char *) call; /* NULL: it does not wait; written last */
    _Atomic(const char *) what; /* NULL: an object's version, the next three */
    _Atomic uint32_t slot, generation;
    _Atomic uint64_t number;
    _Atomic uint64_t tasks; /* of this rank then, with those that are over */
    _Atomic uint64_t turn;  /* how often it began or ended to wait */
};

struct work_watch {
    struct base_lookout lookout;
    double patience; /* seconds of a standstill until it is told */
    double since;    /* when something moved last, as far as was seen; */
    uint64_t before; /* what was read then */
    bool told;
    pthread_mutex_t lock; /* held while it tells, see work_leaves */
    struct work_waits waits;
};

/* Starts and ends the thread; 0 seconds: nobody watches; else the workers are there. Errors:
 * DUITE_E_SYSTEM. */
int work_watch_start(struct work_pool *pool, double seconds);
void work_watch_stop(struct work_pool *pool);

/* A worker whose task is over waits here for the end of a look. */
void work_watch_passes(struct work_pool *pool);

/* Writes who waits for what since so many seconds. */
void work_tell(struct work_pool *pool, double seconds);

#endif
