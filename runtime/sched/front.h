#ifndef DUITE_SCHED_FRONT_H
#define DUITE_SCHED_FRONT_H

#include "runtime/base/guard.h"

#include <duite_policy.h>

/* A front: a scheduler that asks another one, which is not ours, under a guard. Once that is over
 * it decides by itself: all tasks in the shared queue. Built-in schedulers need none. */
struct sched_front {
    duite_scheduler table;
    const duite_scheduler *own;
};

/* Whether it is none of the built-in ones. */
bool sched_is_foreign(const duite_scheduler *scheduler);

/* The front of a scheduler, with larger states, each of which belongs to the caller of a guard. */
const duite_scheduler *sched_front(struct sched_front *front, const duite_scheduler *own);

/* A front's zeroed state, or one that another caller had so far, is the caller's; nothing is done
 * with that of another scheduler. */
void sched_front_state(const duite_scheduler *scheduler, void *state, struct base_caller *caller);

#endif
