/* steal: a worker keeps what it makes ready and works on the newest, whose data are warm; an idle
 * one takes the oldest of a random victim. After Blumofe & Leiserson, Scheduling multithreaded
 * computations by work stealing, JACM 46(5), 1999. */
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
    (void)task;
    return ((struct state *)state)->worker;
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
    (void)state;
    (void)task;
    return 1;
}

const duite_scheduler sched_steal = {
    .name = "steal",
    .summary = "own newest first, steal the oldest of a random victim",
    .state_size = sizeof(struct state),
    .start = start,
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
