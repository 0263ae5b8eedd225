/* scatter: an adversary for tests. Every leaf runs on a random rank from the seed, whatever it
 * costs and whoever has time. */
#include "runtime/balance/balance.h"

struct state {
    uint64_t random;
    int n_ranks;
};

static void start(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    *(struct state *)state = (struct state){
        .random = (seed * 1000003 + (uint64_t)rank) * 4099 + worker, .n_ranks = n_ranks};
}

static int place(void *state, const duite_leaf *leaf)
{
    struct state *own = state;
    (void)leaf;
    return (int)(duite_random(&own->random) % (uint64_t)own->n_ranks);
}

const duite_balancer balance_scatter = {
    .name = "scatter",
    .summary = "leaf tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct state),
    .start = start,
    .place = place,
};
