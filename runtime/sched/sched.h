#ifndef DUITE_SCHED_SCHED_H
#define DUITE_SCHED_SCHED_H

#include <duite_policy.h>

/* The built-in schedulers. */
extern const duite_scheduler sched_steal, sched_fifo, sched_lifo, sched_priority, sched_static,
    sched_shuffle;

#endif
