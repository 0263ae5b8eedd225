/* The main program's side of a preconditioned solve: what is forked once a run, what in each step
 * before the solve, and a pass of the recorded round. */
#include "cloth/flow/solver/patches.h"

#include "cloth/base/memory.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- Memory ---- */

static void without_coarse(struct flow *flow, uint32_t n_blocks)
{
    const bool ic0 = flow->preconditioner == MODEL_IC0_COARSE;
    flow->preconditioner = ic0 ? MODEL_IC0 : MODEL_JACOBI;
    snprintf(
        flow->warning[3], sizeof flow->warning[3],
        "%u blocks are too many for a coarse space, which has at most %d: conjugate gradients do "
        "without; a grain of %u would have one",
        n_blocks, SOLVE_MOST_BLOCKS, flow->n_vertices / SOLVE_MOST_BLOCKS * 5 / 4 + 1);
}

void flow_turned_choose(struct flow *flow, uint32_t n_blocks)
{
    flow->preconditioner =
        model_is_implicit(flow->model) ? flow->model->preconditioner : MODEL_PLAIN;
    if (flow_is_coarse(flow) && n_blocks > SOLVE_MOST_BLOCKS)
        without_coarse(flow, n_blocks);
    flow->patches = model_patches(flow->model, n_blocks);
}

/* Appends to `to` the patches of block `other` that patch k is joined with. */
static uint32_t *add_joined(const struct flow *flow, uint32_t joins, uint32_t k, uint32_t other,
                            uint32_t *to)
{
    for (uint32_t l = 0; l < flow->patches; l++)
        if (joins & solve_patch_bit(k, l))
            *to++ = flow->patches * other + l;
    return to;
}

/* Those of patch k of block b, ascending. Returns the end. */
static uint32_t *add_neighbours(const struct flow *flow, uint32_t b, uint32_t k, uint32_t *to)
{
    const struct flow_table *t = flow->tables.block + b;
    const uint32_t itself = solve_patch_bit(k, k);
    uint32_t s = 0;
    for (; s < t->n_slots && t->slot[s] < b; s++)
        to = add_joined(flow, t->joins[s], k, t->slot[s], to);
    to = add_joined(flow, t->joined & ~itself, k, b, to);
    for (; s < t->n_slots; s++)
        to = add_joined(flow, t->joins[s], k, t->slot[s], to);
    return to;
}

/* How many neighbours all patches can have. */
static size_t most_beside(const struct flow *flow)
{
    size_t slots = 0;
    for (uint32_t b = 0; b < flow->tables.n_blocks; b++)
        slots += 1 + (size_t)flow->tables.block[b].n_slots;
    return slots * flow->patches * flow->patches;
}

static void make_pattern(struct flow *flow)
{
    const uint32_t n_blocks = flow->tables.n_blocks, n = flow->patches * n_blocks;
    struct cloth_error *trouble = &flow->trouble;
    flow->first_beside = cloth_alloc((size_t)n + 1, sizeof *flow->first_beside, trouble);
    flow->beside = cloth_alloc(most_beside(flow), sizeof *flow->beside, trouble);
    if (!flow->first_beside || !flow->beside)
        return;
    for (uint32_t b = 0; b < n_blocks; b++)
        for (uint32_t k = 0; k < flow->patches; k++) {
            uint32_t *first = flow->first_beside + flow->patches * b + k;
            first[1] = (uint32_t)(add_neighbours(flow, b, k, flow->beside + *first) - flow->beside);
        }
    solve_pattern_make(&flow->pattern, n, flow->first_beside, flow->beside, trouble);
}

/* How many neighbours of patch p are behind it and before `end`. */
static size_t count_later(const struct flow *flow, uint32_t p, uint32_t end)
{
    size_t count = 0;
    for (uint32_t i = flow->first_beside[p]; i < flow->first_beside[p + 1]; i++)
        count += flow->beside[i] > p && flow->beside[i] < end;
    return count;
}

size_t flow_coupling_at(const struct flow *flow, uint32_t p, uint32_t q)
{
    size_t at = q > p ? 1 + count_later(flow, p, q) : 0;
    for (uint32_t before = p - p % flow->patches; before < p; before++)
        at += 1 + count_later(flow, before, UINT32_MAX);
    return at;
}

int flow_turned_prepare(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow_turned_choose(flow, flow->tables.n_blocks);
    if (!flow_is_coarse(flow))
        return DUITE_OK;
    make_pattern(flow);
    return flow_memory_agree(state);
}

void flow_turned_free(struct flow *flow)
{
    solve_pattern_free(&flow->pattern);
    free(flow->first_beside);
    free(flow->beside);
    flow->first_beside = flow->beside = NULL;
}

/* ---- Tasks ---- */

int flow_turned_initialise(struct flow_state *state)
{
    struct flow_args args = {0};
    const uint32_t n = flow_is_coarse(state->flow) ? state->flow->tables.n_blocks : 0;
    const size_t objects = model_is_filtered(state->flow->model) ? 3 : 2;
    int code = DUITE_OK;
    for (; args.block < n && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_basis, &args, objects,
                         (duite_object[]){o->basis, o->rim_basis, o->filter}, FLOW_NO_RIM,
                         FLOW_NO_RIM);
    }
    for (args.block = 0; args.block < n && !code; args.block++)
        code = flow_fork(state, &flow_basis_copies, &args, 1,
                         &state->block[args.block].basis_copies, FLOW_RIM(rim_basis), FLOW_NO_RIM);
    return code;
}

/* The coarse factor; it is on its way while blocks factorise theirs. */
static int fork_coarse(struct flow_state *state, struct flow_args args)
{
    const uint32_t n = state->flow->tables.n_blocks;
    int code = DUITE_OK;
    for (; args.block < n && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        const duite_object objects[] = {o->a, o->basis, o->basis_copies, o->coupling};
        code = flow_fork(state, &flow_couple, &args, 4, objects, FLOW_NO_RIM, FLOW_NO_RIM);
    }
    args.block = 0;
    state->refs[0] = state->run.coarse;
    for (uint32_t b = 0; b < n; b++)
        state->refs[1 + b] = state->block[b].coupling;
    return code ? code
                : duite_fork(state->rt, &flow_factor_coarse, &args, 1 + (size_t)n, state->refs);
}

/* Appends the part of every block to refs. */
static size_t add_parts(struct flow_state *state, size_t n)
{
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        state->refs[n++] = state->block[b].part;
    return n;
}

static int fork_begin(struct flow_state *state, struct flow_args args)
{
    if (!flow_is_coarse(state->flow) || args.guess != 0)
        return DUITE_FORK(state->rt, &flow_begin, &args, state->run.scalars[0]);
    args.block = 0;
    state->refs[0] = state->run.scalars[0];
    state->refs[1] = state->run.motion[0];
    state->refs[2] = state->run.coarse;
    return duite_fork(state->rt, &flow_begin_coarse, &args, add_parts(state, 3), state->refs);
}

/* Vectors of a block. */
static int fork_vectors(struct flow_state *state, const struct flow_args *args)
{
    const struct flow_objects *o = state->block + args->block;
    const duite_object start[] = {o->f, o->factor, o->dv,     o->r,        o->p,    o->q,
                                  o->z, o->s,      o->copies, o->rim_q[0], o->part, o->basis};
    if (args->guess != 0)
        return flow_cg_guess(state, args);
    return flow_fork(state, &flow_start_turned, args, flow_is_coarse(state->flow) ? 12 : 11, start,
                     FLOW_NO_RIM, FLOW_NO_RIM);
}

int flow_turned_start(struct flow_state *state, struct flow_args args)
{
    const struct flow_tables *tables = &state->flow->tables;
    const bool coarse = flow_is_coarse(state->flow);
    int code = model_is_filtered(state->flow->model) ? flow_turned_initialise(state) : DUITE_OK;
    if (!code && coarse)
        code = fork_coarse(state, args);
    for (; args.block < tables->n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        const duite_object factor[] = {o->a, o->factor, state->run.status[state->attempt.parity]};
        code = flow_fork(state, &flow_factor, &args, 3, factor, FLOW_NO_RIM, FLOW_NO_RIM);
        if (!code)
            code = fork_vectors(state, &args);
        if (!code)
            code = flow_far_pack(state, args.block, 0);
    }
    return code ? code : fork_begin(state, args);
}

static int fork_block(struct flow_state *state, const struct flow_args *args, int from)
{
    const struct flow_tables *tables = &state->flow->tables;
    const struct flow_objects *o = state->block + args->block;
    const struct flow_table *t = tables->block + args->block;
    const duite_object *s = state->far.read[from] + (t->slot - tables->slot);
    const duite_object own[] = {
        o->table,  state->run.scalars[from], o->a,    o->f,     o->dv, o->r, o->p, o->q, o->z, o->s,
        o->copies, o->rim_q[1 - from],       o->part, o->factor};
    const duite_object coarse[] = {o->basis, o->basis_copies, state->run.motion[from]};
    size_t n = 0;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        state->refs[n++] = own[i];
    for (uint32_t i = 0; i < t->n_slots; i++)
        state->refs[n++] = s[i];
    for (size_t i = 0; i < 3 && flow_is_coarse(state->flow); i++)
        state->refs[n++] = coarse[i];
    return duite_fork(state->rt, &flow_pass_turned, args, n, state->refs);
}

static int fork_scalars(struct flow_state *state, int from)
{
    const struct flow_args args = {0};
    const int to = 1 - from;
    size_t n = 0;
    state->refs[n++] = state->run.scalars[to];
    if (flow_is_coarse(state->flow))
        state->refs[n++] = state->run.motion[to];
    state->refs[n++] = state->run.scalars[from];
    if (flow_is_coarse(state->flow))
        state->refs[n++] = state->run.coarse;
    n = add_parts(state, n);
    return duite_fork(state->rt,
                      flow_is_coarse(state->flow) ? &flow_scalars_coarse : &flow_scalars_turned,
                      &args, n, state->refs);
}

int flow_turned_pass(struct flow_state *state, int from)
{
    const uint32_t n = state->flow->tables.n_blocks;
    struct flow_args args = {0};
    int code = DUITE_OK;
    for (uint32_t i = 0; i < n && !code; i++) {
        args.block = from ? n - 1 - i : i;
        code = fork_block(state, &args, from);
        if (!code)
            code = flow_far_pack(state, args.block, 1 - from);
    }
    return code ? code : fork_scalars(state, from);
}
