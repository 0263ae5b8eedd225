/* A block's objects live where its positions live; the graph that mappings see is the one of the
 * blocks: a block weighs its vertices, and two blocks exchange what each has copies of. */
#include "cloth/flow/bodies.h"

#include <stddef.h>

/* Makes an object of some numbers (at least one) beside a block's x. A failure is returned once
 * more by the next get. */
static void make_numbers(duite *rt, size_t n, duite_object x, duite_object *object)
{
    duite_new(rt, DUITE_F64, n ? n : 1, object);
    duite_colocate(rt, *object, x);
}

static void make(duite *rt, size_t rows, duite_object x, duite_object *object)
{
    make_numbers(rt, 4 * (rows ? rows : 1), x, object);
}

static void make_block(duite *rt, const struct flow_table *t, struct flow_objects *o)
{
    duite_new(rt, DUITE_F64, 4 * (size_t)t->n, &o->x);
    make(rt, t->n, o->x, &o->v);
    make(rt, t->n, o->x, &o->f);
    make(rt, t->n_rim, o->x, &o->rim_x);
    make(rt, t->n_rim, o->x, &o->rim_v);
    duite_new(rt, DUITE_BYTE, flow_table_bytes(t), &o->table);
    duite_colocate(rt, o->table, o->x);
}

static void make_implicit(duite *rt, const struct flow_table *t, bool filtered,
                          struct flow_objects *o)
{
    const size_t filter = filtered ? 4 * (size_t)t->n : 0;
    make_numbers(rt, 4 * flow_diagonal_rows(t) + filter + flow_table_doubles(t), o->x, &o->a);
    if (filtered)
        make(rt, t->n, o->x, &o->filter);
    make(rt, t->n, o->x, &o->dv);
    make(rt, t->n, o->x, &o->r);
    make(rt, t->n, o->x, &o->p);
    make(rt, t->n, o->x, &o->q);
    make(rt, 2 * (size_t)t->n_copies, o->x, &o->copies);
    for (int i = 0; i < 2; i++)
        make_numbers(rt, 3 * (size_t)t->n_rim, o->x, o->rim_q + i);
}

/* What the integrator of the run keeps of a block besides its state. */
static void make_integrator(struct flow_state *state, const struct flow_table *t,
                            struct flow_objects *o)
{
    const struct model *model = state->flow->model;
    const bool runge = model->integrator == MODEL_RK4;
    if (model_is_implicit(model)) {
        make_implicit(state->rt, t, model_is_filtered(model), o);
    } else {
        make(state->rt, t->n_rim, o->x, &o->spare_rim_x);
        make(state->rt, t->n_rim, o->x, &o->spare_rim_v);
    }
    if (model->integrator == MODEL_BDF2 || (model_is_implicit(model) && model->newton_steps > 1)) {
        make(state->rt, t->n, o->x, &o->base_x);
        make(state->rt, t->n, o->x, &o->base_v);
    }
    if (model->integrator == MODEL_BDF2) {
        make(state->rt, t->n, o->x, &o->last_x);
        make(state->rt, t->n, o->x, &o->last_v);
    }
    if (runge || model->integrator == MODEL_VERLET)
        make(state->rt, t->n, o->x, &o->v0);
    if (!runge)
        return;
    make(state->rt, t->n, o->x, &o->x0);
    make(state->rt, t->n, o->x, &o->sum_x);
    make(state->rt, t->n, o->x, &o->sum_v);
}

static void hint(struct flow_state *state, uint32_t b)
{
    double *bytes = state->rows;
    const struct flow_tables *tables = &state->flow->tables;
    const struct flow_table *t = tables->block + b;
    for (uint32_t s = 0; s < t->n_slots; s++) {
        state->refs[s] = state->block[t->slot[s]].x;
        bytes[s] = 3.0 * sizeof(double) * (t->copies[s + 1] - t->copies[s]);
    }
    duite_hint(state->rt, state->block[b].x, t->n, t->n_slots, state->refs, bytes);
}

/* An object of the whole run, beside the first block. */
static void make_shared(struct flow_state *state, duite_type type, size_t count,
                        duite_object *object)
{
    duite_new(state->rt, type, count, object);
    duite_colocate(state->rt, *object, state->block[0].x);
}

void flow_objects_make(struct flow_state *state)
{
    const struct flow_tables *tables = &state->flow->tables;
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        struct flow_objects *o = state->block + b;
        make_block(state->rt, tables->block + b, o);
        if (!model_keeps(state->flow->model))
            continue;
        make(state->rt, tables->block[b].n, o->x, &o->kept_x);
        make(state->rt, tables->block[b].n, o->x, &o->kept_v);
    }
    for (uint32_t b = 0; b < tables->n_blocks; b++)
        make_integrator(state, tables->block + b, state->block + b);
    for (uint32_t b = 0; b < tables->n_blocks; b++)
        hint(state, b);
    for (int i = 0; i < 2; i++) {
        make_shared(state, DUITE_F64, flow_dots(state->flow->model), state->sums + i);
        make_shared(state, DUITE_F64, SOLVE_SCALARS, state->scalars + i);
        make_shared(state, DUITE_F64, FLOW_STATUS, state->status + i);
        make_shared(state, DUITE_F64, 1, state->stretch + i);
    }
    flow_turned_make(state);
    flow_watch_make(state);
    make_shared(state, DUITE_I64, 1, &state->token);
    make_shared(state, DUITE_F64, FLOW_PARTS, &state->seconds);
    make_shared(state, DUITE_F64, FLOW_SUMS, &state->energy);
    for (int i = 0; i < 2; i++)
        make_shared(state, DUITE_F64, FLOW_SUMS, state->energies + i);
    make_shared(state, DUITE_F64, FLOW_STATUS, &state->trial);
    make_shared(state, DUITE_F64, 1, &state->slope);
    if (state->head.n_pieces)
        make_shared(state, DUITE_F64, FLOW_PIECE_SUMS * (size_t)state->head.n_pieces,
                    &state->pieces);
    make_shared(state, DUITE_I64, FLOW_TELL, &state->told);
}

/* Frees what was made; the others are the zero object. Returns the first failure. */
static int release(duite *rt, size_t n, const duite_object *object)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < n; i++) {
        const int failed = object[i].generation ? duite_free(rt, object[i]) : DUITE_OK;
        code = code ? code : failed;
    }
    return code;
}

int flow_objects_free(struct flow_state *state)
{
    int code = state->solve.generation ? duite_graph_free(state->rt, state->solve) : DUITE_OK;
    for (uint32_t i = 0; i < state->far.n; i++) {
        const int failed = release(state->rt, 2, state->far.rim[i].object);
        code = code ? code : failed;
    }
    for (uint32_t b = 0; state->block && b < state->flow->tables.n_blocks; b++) {
        const struct flow_objects *o = state->block + b;
        const duite_object all[] = {
            o->x,        o->v,           o->f,           o->a,         o->dv,
            o->r,        o->p,           o->q,           o->copies,    o->rim_x,
            o->rim_v,    o->spare_rim_x, o->spare_rim_v, o->rim_q[0],  o->rim_q[1],
            o->kept_x,   o->filter,      o->kept_v,      o->z,         o->s,
            o->factor,   o->part,        o->basis,       o->rim_basis, o->basis_copies,
            o->coupling, o->x0,          o->v0,          o->sum_x,     o->sum_v,
            o->felt,     o->seen,        o->table};
        const int failed = release(state->rt, sizeof all / sizeof *all, all);
        const duite_object steps[] = {o->base_x, o->base_v, o->last_x, o->last_v};
        const int too = release(state->rt, sizeof steps / sizeof *steps, steps);
        code = code ? code : failed ? failed : too;
    }
    const duite_object integrator[] = {state->trial, state->slope, state->energies[0],
                                       state->energies[1], state->pieces};
    const int first = release(state->rt, 5, integrator);
    code = code ? code : first;
    const duite_object all[] = {
        state->sums[0],   state->sums[1], state->scalars[0], state->scalars[1], state->status[0],
        state->status[1], state->token,   state->stretch[0], state->stretch[1], state->seconds,
        state->told,      state->coarse,  state->motion[0],  state->motion[1],  state->peaks[0],
        state->peaks[1],  state->energy};
    const int failed = release(state->rt, sizeof all / sizeof *all, all);
    return code ? code : failed;
}

static duite_object at_offset(const struct flow_objects *objects, long offset)
{
    return *(const duite_object *)(const void *)((const char *)objects + offset);
}

int flow_fork(struct flow_state *state, const duite_kernel *kernel, const struct flow_args *args,
              size_t n, const duite_object *objects, long offset, long offset2)
{
    const struct flow_table *t = state->flow->tables.block + args->block;
    size_t count = 0;
    state->refs[count++] = state->block[args->block].table;
    for (size_t i = 0; i < n; i++)
        state->refs[count++] = objects[i];
    for (uint32_t s = 0; offset != FLOW_NO_RIM && s < t->n_slots; s++)
        state->refs[count++] = at_offset(state->block + t->slot[s], offset);
    for (uint32_t s = 0; offset2 != FLOW_NO_RIM && s < t->n_slots; s++)
        state->refs[count++] = at_offset(state->block + t->slot[s], offset2);
    return duite_fork(state->rt, kernel, args, count, state->refs);
}
