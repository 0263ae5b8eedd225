/* owner: each block of objects has a worker, which gets the tasks of these objects, the newest
 * first; an idle one takes the oldest of a random other. Data stay in the caches where they are
 * warm, as with `static`, and what was dealt unevenly is evened out by stealing. After Markatos &
 * LeBlanc, Using processor affinity in loop scheduling on shared-memory multiprocessors, IEEE TPDS
 * 5(4), 1994. */
#include "runtime/sched/sched.h"

struct state {
    uint64_t random;
    unsigned worker, n_workers, first;
};

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    struct state *own = state;
    *own = (struct state){.random = seed + worker, .worker = worker, .n_workers = n_workers};
}

static unsigned place(void *state, const duite_ready *task)
{
    return task->block % ((const struct state *)state)->n_workers;
}

static duite_end serve(void *state)
{
    (void)state;
    return DUITE_NEWEST;
}

static unsigned victim(void *state, unsigned attempt)
{
    struct state *own = state;
    return sched_random_victim(&own->random, own->worker, own->n_workers, attempt, &own->first);
}

static int chain(void *state, const duite_ready *task)
{
    return place(state, task) == ((const struct state *)state)->worker;
}

const duite_scheduler sched_owner = {
    .name = "owner",
    .summary = "the worker of each block of objects, newest first; idle ones steal",
    .state_size = sizeof(struct state),
    .start = start,
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
