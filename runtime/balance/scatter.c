/* scatter: an adversary for tests. Every task that may go runs on a random rank from the seed,
 * regardless of costs and loads. */
#include "runtime/balance/balance.h"

static int scatter_place(void *state, const duite_leaf *leaf)
{
    struct balance_chance *own = state;
    (void)leaf;
    return balance_draw(own, own->n_ranks);
}

const duite_balancer balance_scatter = {
    .name = "scatter",
    .summary = "tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct balance_chance),
    .start = balance_start_chance,
    .place = scatter_place,
};
