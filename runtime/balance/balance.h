#ifndef DUITE_BALANCE_BALANCE_H
#define DUITE_BALANCE_BALANCE_H

#include <duite_policy.h>

/* The built-in balancers. */
extern const duite_balancer balance_none, balance_delegate, balance_migrate, balance_scatter,
    balance_wander;

#endif
