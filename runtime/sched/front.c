/* A front's state begins with what it needs itself, the scheduler's own follows. */
#include "runtime/sched/front.h"

#include "runtime/base/memory.h"

struct state {
    const duite_scheduler *own;
    struct base_caller *caller;
    _Alignas(BASE_LINE) unsigned char rest[];
};

static void start(void *state, unsigned worker, unsigned n_workers, uint64_t seed)
{
    static const struct base_guarded what = {"scheduler", "start"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return;
    s->own->start(s->rest, worker, n_workers, seed);
    base_guard_leaves(s->caller);
}

static unsigned place(void *state, const duite_ready *task)
{
    static const struct base_guarded what = {"scheduler", "place"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return DUITE_SHARED_QUEUE;
    unsigned queue = s->own->place(s->rest, task);
    base_guard_leaves(s->caller);
    return queue;
}

static duite_end serve(void *state)
{
    static const struct base_guarded what = {"scheduler", "serve"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return DUITE_OLDEST;
    duite_end end = s->own->serve(s->rest);
    base_guard_leaves(s->caller);
    return end;
}

static unsigned victim(void *state, unsigned attempt)
{
    static const struct base_guarded what = {"scheduler", "victim"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return DUITE_NO_QUEUE;
    unsigned queue = s->own->victim(s->rest, attempt);
    base_guard_leaves(s->caller);
    return queue;
}

static int chain(void *state, const duite_ready *task)
{
    static const struct base_guarded what = {"scheduler", "chain"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return 0;
    int chained = s->own->chain(s->rest, task);
    base_guard_leaves(s->caller);
    return chained;
}

static void look(void *state, const duite_near *near)
{
    static const struct base_guarded what = {"scheduler", "look"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return;
    s->own->look(s->rest, near);
    base_guard_leaves(s->caller);
}

const duite_scheduler *sched_front(struct sched_front *front, const duite_scheduler *own)
{
    front->own = own;
    front->table = (duite_scheduler){.name = own->name,
                                     .summary = own->summary,
                                     .state_size = sizeof(struct state) + own->state_size,
                                     .start = own->start ? start : NULL,
                                     .place = place,
                                     .serve = serve,
                                     .victim = victim,
                                     .chain = chain,
                                     .look = own->look ? look : NULL,
                                     .paths = own->paths};
    return &front->table;
}

void sched_front_state(const duite_scheduler *scheduler, void *state, struct base_caller *caller)
{
    struct state *s = state;
    if (scheduler->place != place)
        return;
    s->own = ((const struct sched_front *)scheduler)->own;
    s->caller = caller;
}
