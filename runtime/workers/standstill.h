#ifndef DUITE_WORKERS_STANDSTILL_H
#define DUITE_WORKERS_STANDSTILL_H

#include "runtime/base/monitor.h"
#include "runtime/data/packet.h"

#include <stdint.h>

/* The monitor looks, eight times in so many seconds, whether the main program waits and nothing of
 * this rank moves. Then it reports on standard error, once, who waits for what. Another standstill
 * is reported if it lasts twice as long, and so on, so that slow tasks do not fill the screen. */

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

struct work_standstill {
    struct base_look look;
    double patience; /* seconds of a standstill until it is reported */
    double since;    /* when something moved last, as far as was seen; */
    uint64_t before; /* what was read then */
    bool reported;
    pthread_mutex_t lock; /* held while it reports, see work_leaves */
    struct work_waits waits;
};

/* Begins and ends the looks; 0 seconds: there are none; else the workers are there. Errors: memory,
 * DUITE_E_SYSTEM. */
int work_standstill_start(struct work_pool *pool, double seconds);
void work_standstill_stop(struct work_pool *pool);

/* A worker whose task is over waits here for the end of a report. */
void work_standstill_passes(struct work_pool *pool);

#endif
