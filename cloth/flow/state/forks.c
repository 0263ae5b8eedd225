/* Forks of kernels that declare their fields (kernel.h): the objects follow from the declaration.
 * All forks of a run are here, so its first failure is, too. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/state/bodies.h"

/* The field that the fork gives for a declared one. */
static enum flow_field_id given_for(const struct flow_as *as, enum flow_field_id declared)
{
    for (; as && as->declared != FLOW_FIELDS_OF_ALL; as++)
        if (as->declared == declared)
            return as->given;
    return declared;
}

/* The places of a kernel's objects: the same in all blocks. */
struct places {
    size_t n;
    struct {
        enum flow_whose whose;
        enum flow_field_id field;
        size_t at;
    } of[FLOW_MAX_PARAMETERS];
};

static bool is_there(const struct flow_state *state, enum flow_whose whose,
                     enum flow_field_id field)
{
    if (whose == FLOW_OF_TIED && !state->tied.now.first)
        return false;
    return whose == FLOW_OWN || whose == FLOW_OF_NEIGHBOURS || whose == FLOW_OF_ALL ||
           flow_fields[field].exists(state, 0);
}

static void forks_find_places(const struct flow_state *state, const struct flow_kernel *kernel,
                              const struct flow_as *as, struct places *places)
{
    places->n = 0;
    for (const struct flow_parameter *p = kernel->parameter; p->whose != FLOW_NOBODY; p++) {
        const enum flow_field_id field = given_for(as, p->field);
        if (p->whose == FLOW_REST_OF_FORK)
            continue;
        const bool given = p->whose == FLOW_OF_FORK;
        if (!given && !is_there(state, p->whose, field))
            continue;
        places->of[places->n].whose = p->whose;
        places->of[places->n].field = field;
        places->of[places->n++].at =
            given ? field - FLOW_FIELDS_OF_ALL : flow_field_place(state, field);
    }
}

static duite_object object_at(const struct flow_state *state, size_t at, uint32_t block)
{
    return at < FLOW_FIELDS_OF_BLOCK ? state->block[block].of[at]
                                     : state->run.of[at - FLOW_FIELDS_OF_BLOCK];
}

/* Appends a field's objects in blocks other than the task's to `refs`. Returns the end. */
static duite_object *forks_add_others(const struct flow_state *state, uint32_t block,
                                      enum flow_whose whose, enum flow_field_id field, size_t at,
                                      duite_object *refs)
{
    const struct flow_table *t = state->flow->tables.block + block;
    const struct flow_tied_blocks *tied = &state->tied.now;
    if (whose == FLOW_OF_NEIGHBOURS)
        for (uint32_t s = 0; s < t->n_neighbours; s++)
            *refs++ = object_at(state, at, t->neighbour[s]);
    else if (whose == FLOW_OF_TIED)
        for (uint32_t i = tied->first[block]; i < tied->first[block + 1]; i++)
            *refs++ = object_at(state, at, tied->other[i]);
    else if (whose == FLOW_OF_KEEPERS) {
        flow_contact_keepers(state, block, state->contact.mark);
        for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
            if (state->contact.mark[b])
                *refs++ = object_at(state, at, b);
    } else
        for (uint32_t b = 0; b < state->flow->made[field]; b++)
            if (flow_fields[field].exists(state, b))
                *refs++ = object_at(state, at, b);
    return refs;
}

/* Puts the objects of a fork into `refs`, but those of REST. Returns how many. with: NULL, or those
 * of GIVEN. */
static size_t list_objects(const struct flow_state *state, const struct places *places,
                           uint32_t block, const struct flow_with *with, duite_object *refs)
{
    duite_object *end = refs;
    for (size_t i = 0; i < places->n; i++) {
        const enum flow_whose whose = places->of[i].whose;
        const size_t at = places->of[i].at;
        if (whose == FLOW_OWN || whose == FLOW_OWN_IF_MADE || whose == FLOW_IF_MADE)
            *end++ = object_at(state, at, block);
        else if (whose == FLOW_OF_FORK)
            *end++ = with->of[at];
        else
            end = forks_add_others(state, block, whose, places->of[i].field, at, end);
    }
    return (size_t)(end - refs);
}

const duite_kernel *flow_task_of(const struct flow_state *state, const struct flow_kernel *kernel)
{
    return kernel->less && !state->flow->made[kernel->with] ? kernel->less : &kernel->task;
}

size_t flow_kernel_objects(struct flow_state *state, const struct flow_kernel *kernel,
                           uint32_t block, const struct flow_as *as)
{
    struct places places;
    forks_find_places(state, kernel, as, &places);
    return list_objects(state, &places, block, NULL, state->refs);
}

/* rank NULL: where the runtime chooses. */
static int fork_task(struct flow_state *state, const int *rank, const duite_kernel *task,
                     const void *args, size_t n, const duite_object *objects)
{
    const duite_task_options options = {.at = rank};
    return state->code
               ? state->code
               : flow_noted(state, duite_fork_with(state->rt, &options, task, args, n, objects));
}

int flow_fork_listed(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                     size_t n)
{
    return fork_task(state, NULL, flow_task_of(state, kernel), args, n, state->refs);
}

int flow_fork_one_as(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                     const struct flow_as *as)
{
    const uint32_t *block = args;
    const size_t n = flow_kernel_objects(state, kernel, *block, as);
    return flow_fork_listed(state, kernel, args, n);
}

int flow_fork_one(struct flow_state *state, const struct flow_kernel *kernel, const void *args)
{
    return flow_fork_one_as(state, kernel, args, NULL);
}

/* True if a kernel reads x and v at the other ends of ties. */
static bool sees_ties(const struct flow_kernel *kernel)
{
    const struct flow_parameter *p = kernel->parameter;
    while (p->whose != FLOW_NOBODY && (p->whose != FLOW_OF_TIED || p->field != FLOW_FIELD_tie_halo))
        p++;
    return p->whose == FLOW_OF_TIED;
}

/* Fetches the names of a block's objects, and its neighbours, into the cache. */
static void fetch_names(const struct flow_state *state, const struct places *places, uint32_t block)
{
    __builtin_prefetch(&state->flow->tables.block[block].neighbour);
    for (size_t i = 0; i < places->n; i++)
        if (places->of[i].at < FLOW_FIELDS_OF_BLOCK)
            __builtin_prefetch(&state->block[block].of[places->of[i].at]);
}

/* With thousands of blocks the runtime's data of objects lie far apart: they are fetched some
 * blocks ahead. The objects of these blocks have a ring in state->refs. */
int flow_fork_range_as(struct flow_state *state, const struct flow_kernel *kernel, uint32_t first,
                       uint32_t end, void *args, const struct flow_as *as)
{
    struct flow_block_args alone;
    uint32_t *block = args ? args : &alone.block;
    const duite_kernel *task = flow_task_of(state, kernel);
    size_t n[FLOW_FORKS_AHEAD];
    struct places places;
    forks_find_places(state, kernel, as, &places);
    for (uint32_t b = first; b < end + FLOW_FORKS_AHEAD && !state->code; b++) {
        const uint32_t turn = (b - first) % FLOW_FORKS_AHEAD;
        duite_object *refs = state->refs + turn * state->max_refs;
        if (b >= first + FLOW_FORKS_AHEAD) {
            *block = b - FLOW_FORKS_AHEAD;
            flow_noted(state, duite_fork(state->rt, task, block, n[turn], refs));
        }
        if (b >= end)
            continue;
        if (b + FLOW_FORKS_AHEAD < end)
            fetch_names(state, &places, b + FLOW_FORKS_AHEAD);
        n[turn] = list_objects(state, &places, b, NULL, refs);
        duite_prefetch(state->rt, n[turn], refs);
    }
    return state->code;
}

int flow_fork_each_as(struct flow_state *state, const struct flow_kernel *kernel, void *args,
                      const struct flow_as *as)
{
    if (sees_ties(kernel))
        flow_ties_show(state);
    return flow_fork_range_as(state, kernel, 0, state->flow->tables.n_blocks, args, as);
}

int flow_fork_each(struct flow_state *state, const struct flow_kernel *kernel, void *args)
{
    return flow_fork_each_as(state, kernel, args, NULL);
}

int flow_fork_at(struct flow_state *state, int rank, const struct flow_kernel *kernel,
                 const void *args, const struct flow_as *as)
{
    const uint32_t *block = args;
    const size_t n = flow_kernel_objects(state, kernel, *block, as);
    return fork_task(state, &rank, flow_task_of(state, kernel), args, n, state->refs);
}

static int fork_with(struct flow_state *state, const int *rank, const struct flow_kernel *kernel,
                     const void *args, const struct flow_with *with)
{
    const uint32_t *block = args;
    duite_object room[FLOW_MAX_PARAMETERS];
    struct places places;
    forks_find_places(state, kernel, NULL, &places);
    duite_object *first = with->rest ? with->rest - places.n : room;
    const size_t n = list_objects(state, &places, *block, with, first);
    return fork_task(state, rank, &kernel->task, args, n + with->n, first);
}

int flow_fork_with(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                   const struct flow_with *with)
{
    return fork_with(state, NULL, kernel, args, with);
}

int flow_fork_with_at(struct flow_state *state, int rank, const struct flow_kernel *kernel,
                      const void *args, const struct flow_with *with)
{
    return fork_with(state, &rank, kernel, args, with);
}
