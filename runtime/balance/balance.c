/* The built-in balancers by name, the default first. */
#include "runtime/balance/balance.h"

#include <duite.h>
#include <string.h>

static const duite_balancer *const balancers[] = {&balance_none, &balance_delegate,
                                                  &balance_scatter};
enum { N_BALANCERS = sizeof balancers / sizeof balancers[0] };

const duite_balancer *duite_balancer_find(const char *name)
{
    for (int i = 0; i < N_BALANCERS; i++)
        if (name && !strcmp(balancers[i]->name, name))
            return balancers[i];
    return NULL;
}

const char *const *duite_balancer_names(void)
{
    static const char *const names[N_BALANCERS + 1] = {"none", "delegate", "scatter"};
    return names;
}
