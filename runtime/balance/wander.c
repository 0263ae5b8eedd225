/* wander: an adversary for tests. At random replays random blocks move to random ranks, and leaf
 * tasks run on any rank, regardless of costs and loads. */
#include "runtime/balance/balance.h"

struct wander_state {
    uint64_t random;
    int n_ranks;
};

static void wander_start(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    *(struct wander_state *)state = (struct wander_state){
        .random = (seed * 1000033 + (uint64_t)rank) * 4099 + worker, .n_ranks = n_ranks};
}

static int wander_rank(struct wander_state *own)
{
    return (int)(duite_random(&own->random) % (uint64_t)own->n_ranks);
}

static int wander_place(void *state, const duite_leaf *leaf)
{
    (void)leaf;
    return wander_rank(state);
}

/* Moves none, some, or all blocks; mostly asks to be called at the next replay again. */
static uint64_t wander_migrate(void *state, const duite_blocks *blocks, int *home)
{
    struct wander_state *own = state;
    uint64_t of_four = duite_random(&own->random) % 5;
    for (size_t i = 0; i < blocks->graph.n; i++)
        if (!blocks->fixed[i] && duite_random(&own->random) % 4 < of_four)
            home[i] = wander_rank(own);
    return 1 + duite_random(&own->random) % 5 / 3;
}

const duite_balancer balance_wander = {
    .name = "wander",
    .summary = "blocks of objects and tasks on random ranks from the seed, for tests",
    .state_size = sizeof(struct wander_state),
    .start = wander_start,
    .place = wander_place,
    .migrate = wander_migrate,
};
