/* static: the worker of each block is fixed, its tasks run in the order in which they became ready,
 * and nobody steals. The baseline of every comparison: data stay where they are, and nothing evens
 * out what the blocks were dealt unevenly. */
#include "runtime/sched/sched.h"

struct state {
    unsigned worker, n_workers;
};

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    (void)seed;
    *(struct state *)state = (struct state){.worker = worker, .n_workers = n_workers};
}

static unsigned place(void *state, const duite_ready *task)
{
    return task->block % ((const struct state *)state)->n_workers;
}

static duite_end serve(void *state)
{
    (void)state;
    return DUITE_OLDEST;
}

static unsigned victim(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

static int chain(void *state, const duite_ready *task)
{
    return place(state, task) == ((const struct state *)state)->worker;
}

const duite_scheduler sched_static = {
    .name = "static",
    .summary = "a fixed worker for each block of objects, no stealing",
    .state_size = sizeof(struct state),
    .start = start,
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
