/* shuffle: an adversary for tests. Every decision is a coin toss from the seed: any queue, any
 * order, any victim or none, so that tasks run in orders that no sensible scheduler would choose.
 */
#include "runtime/sched/sched.h"

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    sched_start(state, worker, n_workers, seed * 1000003);
}

static unsigned draw(void *state, unsigned below)
{
    return (unsigned)(duite_random(&((struct sched_state *)state)->random) % below);
}

static unsigned place(void *state, const duite_ready *task)
{
    (void)task;
    unsigned n_workers = ((struct sched_state *)state)->n_workers;
    unsigned queue = draw(state, n_workers + 1);
    return queue == n_workers ? DUITE_SHARED_QUEUE : queue;
}

static duite_end serve(void *state)
{
    return (duite_end)draw(state, DUITE_HIGHEST + 1);
}

static unsigned victim(void *state, unsigned attempt)
{
    unsigned n_workers = ((struct sched_state *)state)->n_workers;
    if (attempt >= n_workers || draw(state, 8) == 0)
        return DUITE_NO_QUEUE;
    return draw(state, n_workers);
}

static int chain(void *state, const duite_ready *task)
{
    (void)task;
    return (int)draw(state, 2);
}

const duite_scheduler sched_shuffle = {
    .name = "shuffle",
    .summary = "random decisions from the seed, for tests",
    .state_size = sizeof(struct sched_state),
    .start = start,
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
