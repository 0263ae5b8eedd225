#ifndef DUITE_SCHED_SCHED_H
#define DUITE_SCHED_SCHED_H

#include <duite_policy.h>

/* The built-in schedulers. */
extern const duite_scheduler sched_steal, sched_owner, sched_fifo, sched_lifo, sched_priority,
    sched_static, sched_shuffle;

/* The victim of a worker's attempt: once around all others, from a random one on, which is kept in
 * *first. */
static inline unsigned sched_random_victim(uint64_t *random, unsigned worker, unsigned n_workers,
                                           unsigned attempt, unsigned *first)
{
    unsigned others = n_workers - 1;
    if (attempt >= others)
        return DUITE_NO_QUEUE;
    if (attempt == 0)
        *first = (unsigned)(duite_random(random) % others);
    return (worker + 1 + (*first + attempt) % others) % n_workers;
}

#endif
