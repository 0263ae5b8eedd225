/* shuffle: an adversary for tests. Every decision is a coin toss from the seed: any queue, any
 * order, any victim or none, so that tasks run in orders that no sensible scheduler would choose.
 */
#include "runtime/sched/sched.h"

static void shuffle_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    sched_start(state, worker, n_workers, seed * 1000003);
}

static unsigned shuffle_draw(void *state, unsigned below)
{
    return (unsigned)(duite_random(&((struct sched_state *)state)->random) % below);
}

static unsigned shuffle_place(void *state, const duite_ready *task)
{
    (void)task;
    unsigned n_workers = ((struct sched_state *)state)->n_workers;
    unsigned queue = shuffle_draw(state, n_workers + 1);
    return queue == n_workers ? DUITE_SHARED_QUEUE : queue;
}

static duite_end shuffle_serve(void *state)
{
    return (duite_end)shuffle_draw(state, DUITE_HIGHEST + 1);
}

static unsigned shuffle_victim(void *state, unsigned attempt)
{
    unsigned n_workers = ((struct sched_state *)state)->n_workers;
    if (attempt >= n_workers || shuffle_draw(state, 8) == 0)
        return DUITE_NO_QUEUE;
    return shuffle_draw(state, n_workers);
}

static int shuffle_chain(void *state, const duite_ready *task)
{
    (void)task;
    return (int)shuffle_draw(state, 2);
}

const duite_scheduler sched_shuffle = {
    .name = "shuffle",
    .summary = "random decisions from the seed, for tests",
    .state_size = sizeof(struct sched_state),
    .start = shuffle_start,
    .place = shuffle_place,
    .serve = shuffle_serve,
    .victim = shuffle_victim,
    .chain = shuffle_chain,
};
