/* The built-in balancers by name: the rows of balance.h; and all of them but migrate. */
#include "runtime/balance/balance.h"

#include "runtime/base/policy.h"

#include <duite.h>

#define BALANCE_TABLE(name) &balance_##name,

static const char *const balance_names[] = {BALANCE_ROWS(BASE_POLICY_NAME) NULL,
                                            BALANCE_TEST_ROWS(BASE_POLICY_NAME) NULL};
static const void *const balance_tables[] = {BALANCE_ROWS(BALANCE_TABLE) NULL,
                                             BALANCE_TEST_ROWS(BALANCE_TABLE) NULL};
const struct base_policies balance_policies = {.kind = "balancer",
                                               .type = "duite_balancer",
                                               .symbol = "duite_own_balancer",
                                               .size = sizeof(duite_balancer),
                                               .names = balance_names,
                                               .tables = balance_tables};

const duite_balancer *duite_balancer_find(const char *name)
{
    return base_policy_find(&balance_policies, name);
}

const char *const *duite_balancer_names(void)
{
    return balance_names;
}

const char *const *balance_test_names(void)
{
    return base_policy_test_names(&balance_policies);
}

/* ---- What several share ---- */

/* The state of those that choose at random: numbers of its own for each worker. */
struct balance_chance {
    uint64_t random;
    int rank, n_ranks;
};

static void chance_start(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    *(struct balance_chance *)state =
        (struct balance_chance){.random = (seed * 1000003 + (uint64_t)rank) * 4099 + worker,
                                .rank = rank,
                                .n_ranks = n_ranks};
}

/* A rank from 0 to n - 1. */
static int chance_draw(struct balance_chance *own, int n)
{
    return (int)(duite_random(&own->random) % (uint64_t)n);
}

/* ---- The balancers ---- */

/* none: every task runs where the owner rule says, and no rank requests tasks of another. */
const duite_balancer balance_none = {
    .size = sizeof(duite_balancer),
    .name = "none",
    .summary = "tasks run where the objects they write live",
};

/* delegate: an idle rank requests tasks of one other, the one that granted last or a random one,
 * and waits ever longer before its next request. The granter grants up to half of its ready tasks,
 * and only those that cost more than their transfer. It keeps half, because it works on meanwhile,
 * and the last ready task, since its own worker takes it next. It grants one task with a subtree of
 * unknown size, the oldest: that is nearest to the root, so probably the largest. A rank that got
 * too much grants in turn. After Blumofe & Leiserson (1999), with half of a queue instead of one
 * task: Hendler & Shavit, Non-blocking steal-half work queues, PODC 2002. */

/* Seconds that a request stands: the first, and the longest. */
#define FIRST_SECONDS   5e-4
#define LONGEST_SECONDS 5e-2

static int delegate_victim(void *state, unsigned attempt, int granter, double *seconds)
{
    struct balance_chance *own = state;
    double pause = FIRST_SECONDS;
    for (unsigned i = 0; i < attempt && pause < LONGEST_SECONDS; i++)
        pause *= 2;
    *seconds = pause < LONGEST_SECONDS ? pause : LONGEST_SECONDS;
    if (own->n_ranks == 1)
        return DUITE_NO_RANK;
    if (!attempt && granter != DUITE_NO_RANK)
        return granter;
    return (own->rank + 1 + chance_draw(own, own->n_ranks - 1)) % own->n_ranks;
}

static int delegate_grant(void *state, const duite_request *request, const duite_leaf *leaf)
{
    const bool has_more = request->granted < request->ready / 2;
    (void)state;
    if (leaf->forks && leaf->cost <= 0)
        return has_more && !request->granted;
    return has_more && !request->unknown && leaf->cost > leaf->transfer;
}

const duite_balancer balance_delegate = {
    .size = sizeof(duite_balancer),
    .name = "delegate",
    .summary = "idle ranks get ready tasks that cost more than their transfer",
    .state_size = sizeof(struct balance_chance),
    .start = chance_start,
    .victim = delegate_victim,
    .grant = delegate_grant,
};

/* scatter: an adversary for tests. Every task that may go runs on a random rank from the seed,
 * regardless of costs and loads. */
static int scatter_place(void *state, const duite_leaf *leaf)
{
    struct balance_chance *own = state;
    (void)leaf;
    return chance_draw(own, own->n_ranks);
}

const duite_balancer balance_scatter = {
    .size = sizeof(duite_balancer),
    .name = "scatter",
    .summary = "tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct balance_chance),
    .start = chance_start,
    .place = scatter_place,
};

/* wander: an adversary for tests. At random replays random blocks move to random ranks, and leaf
 * tasks run on any rank, regardless of costs and loads.
 *
 * Moves none, some, or all blocks; mostly asks to be called at the next replay again. */
static uint64_t wander_migrate(void *state, const duite_blocks *blocks, int *home)
{
    struct balance_chance *own = state;
    uint64_t of_four = duite_random(&own->random) % 5;
    for (size_t i = 0; i < blocks->graph.n; i++)
        if (!blocks->fixed[i] && duite_random(&own->random) % 4 < of_four)
            home[i] = chance_draw(own, own->n_ranks);
    return 1 + duite_random(&own->random) % 5 / 3;
}

const duite_balancer balance_wander = {
    .size = sizeof(duite_balancer),
    .name = "wander",
    .summary = "blocks of objects and tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct balance_chance),
    .start = chance_start,
    .place = scatter_place,
    .migrate = wander_migrate,
};
