/* Forks of kernels that declare their fields (kernel.h): the objects follow from the declaration.
 */
#include "cloth/flow/bodies.h"

/* Of what a kernel declares, what the fork gives. */
static enum flow_field_id given_for(const struct flow_as *as, enum flow_field_id declared)
{
    for (; as && as->declared != FLOW_FIELDS_OF_ALL; as++)
        if (as->declared == declared)
            return as->given;
    return declared;
}

/* Appends the objects of one parameter to `refs`. Returns the end. */
static duite_object *add_parameter(const struct flow_state *state, uint32_t block,
                                   enum flow_whose whose, enum flow_field_id field,
                                   duite_object *refs)
{
    const struct flow_table *t = state->flow->tables.block + block;
    const struct flow_tied_blocks *tied = &state->tied.now;
    switch (whose) {
    case FLOW_OF_NEIGHBOURS:
        for (uint32_t s = 0; s < t->n_neighbours; s++)
            *refs++ = flow_field_object(state, field, t->neighbour[s]);
        return refs;
    case FLOW_OF_ALL:
        for (uint32_t b = 0; b < state->flow->made[field]; b++)
            if (flow_fields[field].exists(state, b))
                *refs++ = flow_field_object(state, field, b);
        return refs;
    case FLOW_OF_TIED:
        if (tied->first && flow_fields[field].exists(state, block))
            for (uint32_t i = tied->first[block]; i < tied->first[block + 1]; i++)
                *refs++ = flow_field_object(state, field, tied->other[i]);
        return refs;
    case FLOW_IF_MADE:
        if (!flow_fields[field].exists(state, block))
            return refs;
        break;
    case FLOW_OWN:
    case FLOW_NOBODY:
        break;
    }
    *refs++ = flow_field_object(state, field, block);
    return refs;
}

/* Appends the objects of a fork to `refs`. Returns the end. */
static duite_object *add_objects(const struct flow_state *state, const struct flow_kernel *kernel,
                                 uint32_t block, const struct flow_as *as, duite_object *refs)
{
    for (const struct flow_parameter *p = kernel->parameter; p->whose != FLOW_NOBODY; p++)
        refs = add_parameter(state, block, p->whose, given_for(as, p->field), refs);
    return refs;
}

size_t flow_kernel_objects(struct flow_state *state, const struct flow_kernel *kernel,
                           uint32_t block, const struct flow_as *as)
{
    return (size_t)(add_objects(state, kernel, block, as, state->refs) - state->refs);
}

int flow_fork_one_as(struct flow_state *state, const struct flow_kernel *kernel, const void *args,
                     const struct flow_as *as)
{
    const uint32_t *block = args;
    const size_t n = flow_kernel_objects(state, kernel, *block, as);
    return duite_fork(state->rt, &kernel->task, args, n, state->refs);
}

int flow_fork_one(struct flow_state *state, const struct flow_kernel *kernel, const void *args)
{
    return flow_fork_one_as(state, kernel, args, NULL);
}

/* Whether a kernel reads x and v at the other ends of ties. */
static bool sees_ties(const struct flow_kernel *kernel)
{
    const struct flow_parameter *p = kernel->parameter;
    while (p->whose != FLOW_NOBODY && (p->whose != FLOW_OF_TIED || p->field != FLOW_FIELD_tie_halo))
        p++;
    return p->whose == FLOW_OF_TIED;
}

/* Forks the tasks of some blocks in a row. What the runtime knows of their objects lies far apart
 * where there are thousands of blocks, and is fetched for all of them at once. */
static int fork_some(struct flow_state *state, const struct flow_kernel *kernel, uint32_t first,
                     uint32_t n_blocks, void *args, const struct flow_as *as)
{
    uint32_t *block = args;
    duite_object *end[FLOW_FORKS_AHEAD], *refs = state->refs;
    for (uint32_t i = 0; i < n_blocks; i++)
        refs = end[i] = add_objects(state, kernel, first + i, as, refs);
    duite_prefetch(state->rt, (size_t)(refs - state->refs), state->refs);
    int code = DUITE_OK;
    refs = state->refs;
    for (uint32_t i = 0; i < n_blocks && !code; refs = end[i++]) {
        *block = first + i;
        code = duite_fork(state->rt, &kernel->task, args, (size_t)(end[i] - refs), refs);
    }
    return code;
}

int flow_fork_each_as(struct flow_state *state, const struct flow_kernel *kernel, void *args,
                      const struct flow_as *as)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    int code = sees_ties(kernel) ? flow_ties_show(state) : DUITE_OK;
    for (uint32_t first = 0; first < n_blocks && !code; first += FLOW_FORKS_AHEAD) {
        const uint32_t left = n_blocks - first;
        code = fork_some(state, kernel, first, left < FLOW_FORKS_AHEAD ? left : FLOW_FORKS_AHEAD,
                         args, as);
    }
    return code;
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
    return duite_fork_at(state->rt, rank, &kernel->task, args, n, state->refs);
}
