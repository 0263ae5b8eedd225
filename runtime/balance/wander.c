/* wander: an adversary for tests. At random replays random blocks move to random ranks, and leaf
 * tasks run on any rank, regardless of costs and loads. */
#include "runtime/balance/balance.h"

static int wander_place(void *state, const duite_leaf *leaf)
{
    struct balance_chance *own = state;
    (void)leaf;
    return balance_draw(own, own->n_ranks);
}

/* Moves none, some, or all blocks; mostly asks to be called at the next replay again. */
static uint64_t wander_migrate(void *state, const duite_blocks *blocks, int *home)
{
    struct balance_chance *own = state;
    uint64_t of_four = duite_random(&own->random) % 5;
    for (size_t i = 0; i < blocks->graph.n; i++)
        if (!blocks->fixed[i] && duite_random(&own->random) % 4 < of_four)
            home[i] = balance_draw(own, own->n_ranks);
    return 1 + duite_random(&own->random) % 5 / 3;
}

const duite_balancer balance_wander = {
    .name = "wander",
    .summary = "blocks of objects and tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct balance_chance),
    .start = balance_start_chance,
    .place = wander_place,
    .migrate = wander_migrate,
};
