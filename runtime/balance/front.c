/* A front's state begins with what it needs itself, the balancer's own follows. */
#include "runtime/balance/front.h"

#include "runtime/base/memory.h"

struct state {
    const duite_balancer *own;
    struct base_caller *caller;
    _Alignas(BASE_LINE) unsigned char rest[];
};

static void start(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed)
{
    static const struct base_guarded what = {"balancer", "start"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return;
    s->own->start(s->rest, rank, n_ranks, worker, seed);
    base_guard_leaves(s->caller);
}

static int victim(void *state, unsigned attempt, int giver, double *seconds)
{
    static const struct base_guarded what = {"balancer", "victim"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return DUITE_NO_RANK;
    int rank = s->own->victim(s->rest, attempt, giver, seconds);
    base_guard_leaves(s->caller);
    return rank;
}

static int give(void *state, const duite_asked *asked, const duite_leaf *leaf)
{
    static const struct base_guarded what = {"balancer", "give"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return 0;
    int given = s->own->give(s->rest, asked, leaf);
    base_guard_leaves(s->caller);
    return given;
}

static int place(void *state, const duite_leaf *leaf)
{
    static const struct base_guarded what = {"balancer", "place"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return DUITE_NO_RANK;
    int rank = s->own->place(s->rest, leaf);
    base_guard_leaves(s->caller);
    return rank;
}

static uint64_t migrate(void *state, const duite_blocks *blocks, int *home)
{
    static const struct base_guarded what = {"balancer", "migrate"};
    struct state *s = state;
    if (sigsetjmp(s->caller->back, 0) || !base_guard_enters(s->caller, &what, s->own->name))
        return 0;
    uint64_t next = s->own->migrate(s->rest, blocks, home);
    base_guard_leaves(s->caller);
    return next;
}

const duite_balancer *balance_front(struct balance_front *front, const duite_balancer *own)
{
    front->own = own;
    front->table = (duite_balancer){.name = own->name,
                                    .summary = own->summary,
                                    .state_size = sizeof(struct state) + own->state_size,
                                    .start = own->start ? start : NULL,
                                    .victim = own->victim ? victim : NULL,
                                    .give = own->give ? give : NULL,
                                    .place = own->place ? place : NULL,
                                    .migrate = own->migrate ? migrate : NULL};
    return &front->table;
}

void balance_front_state(const duite_balancer *balancer, void *state, struct base_caller *caller)
{
    struct state *s = state;
    const struct balance_front *front = (const struct balance_front *)balancer;
    bool is_front = balancer->start == start || balancer->victim == victim ||
                    balancer->give == give || balancer->place == place ||
                    balancer->migrate == migrate;
    if (!is_front)
        return;
    s->own = front->own;
    s->caller = caller;
}
