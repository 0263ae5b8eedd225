/* Decisions that several schedulers share. A function that reads its state expects a sched_state
 * there, or a structure that begins with one. */
#include "runtime/sched/sched.h"

void sched_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    struct sched_state *own = state;
    *own = (struct sched_state){.random = seed + worker, .worker = worker, .n_workers = n_workers};
}

unsigned sched_place_shared(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return DUITE_SHARED_QUEUE;
}

unsigned sched_place_affinity(void *state, const duite_ready *task)
{
    const struct sched_state *own = state;
    return task->affinity ? task->affinity - 1 : own->worker;
}

unsigned sched_place_owner(void *state, const duite_ready *task)
{
    return task->block % ((const struct sched_state *)state)->n_workers;
}

duite_end sched_serve_newest(void *state)
{
    (void)state;
    return DUITE_NEWEST;
}

duite_end sched_serve_oldest(void *state)
{
    (void)state;
    return DUITE_OLDEST;
}

duite_end sched_serve_highest(void *state)
{
    (void)state;
    return DUITE_HIGHEST;
}

unsigned sched_no_victim(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

unsigned sched_any_victim(void *state, unsigned attempt)
{
    struct sched_state *own = state;
    unsigned others = own->n_workers - 1;
    if (attempt >= others)
        return DUITE_NO_QUEUE;
    if (attempt == 0)
        own->first = (unsigned)(duite_random(&own->random) % others);
    return (own->worker + 1 + (own->first + attempt) % others) % own->n_workers;
}

int sched_never_chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return 0;
}

int sched_chain_affinity(void *state, const duite_ready *task)
{
    return sched_place_affinity(state, task) == ((const struct sched_state *)state)->worker;
}

int sched_chain_owner(void *state, const duite_ready *task)
{
    return sched_place_owner(state, task) == ((const struct sched_state *)state)->worker;
}
