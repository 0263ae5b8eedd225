/* The built-in balancers by name, the default first. */
#include "runtime/balance/balance.h"

#include "runtime/balance/front.h"
#include "runtime/base/policy.h"

#include <duite.h>

static const char *const names[] = {"none", "delegate", "migrate", "scatter", "wander", NULL};
static const void *const tables[] = {&balance_none, &balance_delegate, &balance_migrate,
                                     &balance_scatter, &balance_wander};

static const struct base_policies all = {"balancer", "duite_own_balancer", names, tables};

const duite_balancer *duite_balancer_find(const char *name)
{
    return base_policy_find(&all, name);
}

const char *const *duite_balancer_names(void)
{
    return names;
}

bool balance_is_foreign(const duite_balancer *balancer)
{
    return !base_policy_is_ours(&all, balancer);
}
