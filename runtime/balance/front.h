#ifndef DUITE_BALANCE_FRONT_H
#define DUITE_BALANCE_FRONT_H

#include "runtime/base/guard.h"

#include <duite_policy.h>

/* A front: a balancer that asks another one, which is not ours, under a guard. Once that is over
 * nothing moves. Built-in balancers need none. */
struct balance_front {
    duite_balancer table;
    const duite_balancer *own;
};

/* Whether it is none of the built-in ones. */
bool balance_is_foreign(const duite_balancer *balancer);

/* The front of a balancer, with larger states, each of which belongs to the caller of a guard. */
const duite_balancer *balance_front(struct balance_front *front, const duite_balancer *own);

/* A state of a balancer that is a front belongs to that caller from now on; of any other nothing is
 * done. */
void balance_front_state(const duite_balancer *balancer, void *state, struct base_caller *caller);

#endif
