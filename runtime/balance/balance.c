/* The built-in balancers by name: the rows of balance.h. */
#include "runtime/balance/balance.h"

#include "runtime/base/policy.h"

#include <duite.h>

#define BALANCE_TABLE(name) &balance_##name,

static const char *const balance_names[] = {BALANCE_ROWS(BASE_POLICY_NAME) NULL,
                                            BALANCE_TEST_ROWS(BASE_POLICY_NAME) NULL};
static const void *const balance_tables[] = {BALANCE_ROWS(BALANCE_TABLE) NULL,
                                             BALANCE_TEST_ROWS(BALANCE_TABLE) NULL};
static const struct base_policies balancers = {"balancer", "duite_own_balancer", balance_names,
                                               balance_tables};

void balance_start_chance(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    *(struct balance_chance *)state =
        (struct balance_chance){.random = (seed * 1000003 + (uint64_t)rank) * 4099 + worker,
                                .rank = rank,
                                .n_ranks = n_ranks};
}

int balance_draw(struct balance_chance *own, int n)
{
    return (int)(duite_random(&own->random) % (uint64_t)n);
}

const duite_balancer *duite_balancer_find(const char *name)
{
    return base_policy_find(&balancers, name);
}

const char *const *duite_balancer_names(void)
{
    return balance_names;
}

const char *const *balance_test_names(void)
{
    return base_policy_test_names(&balancers);
}

bool balance_is_foreign(const duite_balancer *balancer)
{
    return !base_policy_is_ours(&balancers, balancer);
}
