/* locality: as `steal`, but an idle worker tries the others by their distance in the machine. The
 * ring of those that share most with it (a core, a cache, a package) comes first, from a random one
 * on; then the next ring. So data leave a cache or a package only when no work is left in it.
 * Without distances all others are one ring. After Quintin & Wagner, Hierarchical work-stealing,
 * Euro-Par 2010. */
#include "runtime/sched/sched.h"

struct locality_state {
    struct sched_state own; /* first */
    const duite_near *near;
    unsigned begin, end; /* the attempts of the ring that is tried */
};

static void locality_locate(void *state, const duite_near *near)
{
    ((struct locality_state *)state)->near = near;
}

static unsigned locality_victim(void *state, unsigned attempt)
{
    struct locality_state *own = state;
    const duite_near *near = own->near;
    if (attempt >= near->n)
        return DUITE_NO_QUEUE;
    if (attempt == 0)
        own->end = 0;
    if (attempt == own->end) {
        own->begin = attempt;
        while (own->end < near->n && near->distance[own->end] == near->distance[attempt])
            own->end++;
        own->own.first = (unsigned)(duite_random(&own->own.random) % (own->end - own->begin));
    }
    unsigned size = own->end - own->begin;
    return near->worker[own->begin + (own->own.first + attempt - own->begin) % size];
}

const duite_scheduler sched_locality = {
    .name = "locality",
    .summary = "own newest first, steal the oldest of the nearest in the machine",
    .state_size = sizeof(struct locality_state),
    .start = sched_start,
    .place = sched_place_affinity,
    .serve = sched_serve_newest,
    .victim = locality_victim,
    .chain = sched_chain_affinity,
    .locate = locality_locate,
};
