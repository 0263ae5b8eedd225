/* scatter: an adversary for tests. Every task that may go runs on a random rank from the seed,
 * regardless of costs and loads. */
#include "runtime/balance/balance.h"

struct scatter_state {
    uint64_t random;
    int n_ranks;
};

static void scatter_start(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    *(struct scatter_state *)state = (struct scatter_state){
        .random = (seed * 1000003 + (uint64_t)rank) * 4099 + worker, .n_ranks = n_ranks};
}

static int scatter_place(void *state, const duite_leaf *leaf)
{
    struct scatter_state *own = state;
    (void)leaf;
    return (int)(duite_random(&own->random) % (uint64_t)own->n_ranks);
}

const duite_balancer balance_scatter = {
    .name = "scatter",
    .summary = "tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct scatter_state),
    .start = scatter_start,
    .place = scatter_place,
};
