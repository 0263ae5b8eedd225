/* Conjugate gradients by tasks (Zara 2001), recorded once a run and replayed in each step until its
 * scalars say that it is done. A round is two passes, which read the rims of q in turn: the one
 * that others still read is not the one that is written. Passes go to and fro over the blocks:
 * those that come last in one, whose rows the caches still have, come first in the next. When the
 * solve is done with the first pass of a round, the second one does nothing. */
#include "cloth/flow/tasks.h"

/* Pass number `from` of a round: a task a block, and the one that makes the next factors. */
static int fork_pass(struct flow_state *state, int from)
{
    const struct flow_tables *tables = &state->flow->tables;
    const int to = 1 - from;
    struct flow_args args = {0};
    int code = duite_set(state->rt, state->run.sums[from], NULL);
    for (uint32_t i = 0; i < tables->n_blocks && !code; i++) {
        args.block = from ? tables->n_blocks - 1 - i : i;
        const struct flow_objects *o = state->block + args.block;
        const struct flow_table *t = tables->block + args.block;
        const duite_object *q = state->far.read[from] + (t->slot - tables->slot);
        const duite_object own[] = {
            o->table,     state->run.scalars[from], o->a, o->f, o->dv, o->r, o->p, o->q, o->copies,
            o->rim_q[to], state->run.sums[from]};
        size_t n = 0;
        for (; n < sizeof own / sizeof *own; n++)
            state->refs[n] = own[n];
        for (uint32_t s = 0; s < t->n_slots; s++)
            state->refs[n++] = q[s];
        code = duite_fork(state->rt, &flow_pass, &args, n, state->refs);
        if (!code)
            code = flow_far_pack(state, args.block, to);
    }
    if (!code)
        code = DUITE_FORK(state->rt, &flow_scalars, NULL, state->run.sums[from],
                          state->run.scalars[from], state->run.scalars[to]);
    return code;
}

static int build(duite *rt, void *context)
{
    (void)rt;
    struct flow_state *state = context;
    const bool turned = flow_is_turned(state->flow);
    int code = DUITE_OK;
    for (int from = 0; from < 2 && !code; from++)
        code = turned ? flow_turned_pass(state, from) : fork_pass(state, from);
    return code;
}

int flow_cg_record(struct flow_state *state)
{
    return duite_graph_new(state->rt, build, state, &state->solve);
}

static int fork_start(struct flow_state *state, struct flow_args args)
{
    int code = DUITE_FORK(state->rt, &flow_begin, &args, state->run.scalars[0]);
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = args.guess != 0 ? flow_cg_guess(state, &args)
                               : DUITE_FORK(state->rt, &flow_start, &args, o->table, o->f, o->dv,
                                            o->r, o->p, o->q, o->copies, o->rim_q[0]);
        if (!code)
            code = flow_far_pack(state, args.block, 0);
    }
    return code;
}

int flow_cg_guess(struct flow_state *state, const struct flow_args *args)
{
    const struct flow_objects *o = state->block + args->block;
    return DUITE_FORK(state->rt, &flow_guess, args, o->table, o->f, o->a, o->dv, o->r, o->p, o->q,
                      o->rim_q[0]);
}

/* dv of the step before, as it is in a step of this length. */
static double guess_of(const struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const double h = model->h * state->attempt.length / FLOW_TICKS;
    const bool wanted = model->guess == MODEL_GUESS_PREVIOUS ||
                        (model->guess == MODEL_GUESS_AUTO && h < MODEL_GUESS_BELOW);
    return wanted && state->guessed ? (double)state->attempt.length / state->guessed : 0;
}

int flow_cg_start(struct flow_state *state)
{
    struct flow_args args = flow_attempt_args(state);
    args.guess = guess_of(state);
    return flow_is_turned(state->flow) ? flow_turned_start(state, args) : fork_start(state, args);
}

/* Takes out of dv what the solve left of the momentum of free pieces. */
static int fork_pieces(struct flow_state *state)
{
    struct flow_args here = flow_attempt_args(state);
    int code = duite_set(state->rt, state->run.pieces, NULL);
    for (here.block = 0; here.block < state->flow->tables.n_blocks && !code; here.block++) {
        const struct flow_objects *o = state->block + here.block;
        if (state->flow->tables.block[here.block].n_loose)
            code = DUITE_FORK(state->rt, &flow_piece_sums, &here, o->table, o->f, o->a, o->dv,
                              state->run.pieces);
    }
    for (here.block = 0; here.block < state->flow->tables.n_blocks && !code; here.block++) {
        const struct flow_objects *o = state->block + here.block;
        if (state->flow->tables.block[here.block].n_loose)
            code = DUITE_FORK(state->rt, &flow_piece_shift, &here, o->table, o->a,
                              state->run.pieces, o->dv, o->r);
    }
    return code;
}

int flow_cg_iterate(struct flow_state *state)
{
    const uint64_t passes = (uint64_t)state->flow->model->max_iterations + SOLVE_EXTRA;
    const uint64_t rounds = (passes + 1) / 2;
    const int code = duite_replay_while(state->rt, state->solve, state->run.scalars[0], rounds);
    return code || !state->head.n_pieces ? code : fork_pieces(state);
}

int flow_cg(struct flow_state *state)
{
    state->guessed = 0;
    const int code = flow_cg_start(state);
    return code ? code : flow_cg_iterate(state);
}
