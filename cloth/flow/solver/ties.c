/* What a solve shows of the corners of ties (cloth/flow/state/ties.h): rows of s to the blocks that
 * they lead to, after each pass, and once a solve the coarse functions there. */
#include "cloth/flow/solver/solver.h"

/* Rows that others see; zero where there are none. */
static void pack(const struct flow_ties *ties, const phys_vec *y, double *to)
{
    solve_pack(ties->n_shown, ties->shown, y, to);
    memset(to + 3 * (size_t)ties->n_shown, 0,
           3 * (flow_ties_rows(ties) - ties->n_shown) * sizeof *to);
}

/* What the first pass of a solve reads; q: what the fork gives for it. */
FLOW_KERNEL(tie_pack, FLOW_CG, struct flow_block_args, (R(tie_table), R(q), W(tie_q)))
static int tie_pack_body(const duite_call *call, const struct tie_pack_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    pack(&ties, on->q, on->tie_q);
    return 0;
}

/* What the next one does, when the pass with these scalars is over. */
FLOW_KERNEL(tie_pack_pass, FLOW_CG, struct flow_block_args,
            (R(tie_table), R(scalars), R(dv), R(q), W(tie_q_next)))
static int tie_pack_pass_body(const duite_call *call, const struct tie_pack_pass_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    pack(&ties, on->scalars->phase == SOLVE_SHOW ? on->dv : on->q, on->tie_q_next);
    return 0;
}

FLOW_KERNEL(tie_show_basis, FLOW_CG, struct flow_block_args, (R(tie_table), R(basis), W(tie_basis)))
static int tie_show_basis_body(const duite_call *call, const struct tie_show_basis_fields *on)
{
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    (void)call;
    memset(on->tie_basis, 0, flow_ties_rows(&ties) * sizeof *on->tie_basis);
    for (uint32_t i = 0; i < ties.n_shown; i++)
        on->tie_basis[i] = on->basis[ties.shown[i]];
    return 0;
}

/* ---- Forks ---- */

static bool is_tied(const struct flow_state *state, uint32_t block)
{
    const uint32_t *first = state->tied.now.first;
    return first && first[block] < first[block + 1];
}

/* Where there is a preconditioner, s is what others need of q. */
static enum flow_field_id product_of(const struct flow_state *state)
{
    return flow_is_preconditioned(state->flow) ? FLOW_FIELD_s : FLOW_FIELD_q;
}

int flow_ties_pack_start(struct flow_state *state, uint32_t block, bool guess)
{
    const struct flow_block_args args = {block};
    const struct flow_as as[] = {{FLOW_FIELD_q, guess ? FLOW_FIELD_dv : product_of(state)},
                                 {FLOW_FIELDS_OF_ALL, FLOW_FIELDS_OF_ALL}};
    return is_tied(state, block) ? flow_fork_one_as(state, &flow_kernel_tie_pack, &args, as)
                                 : DUITE_OK;
}

int flow_ties_pack(struct flow_state *state, uint32_t block)
{
    const struct flow_block_args args = {block};
    const struct flow_as as[] = {{FLOW_FIELD_q, product_of(state)},
                                 {FLOW_FIELDS_OF_ALL, FLOW_FIELDS_OF_ALL}};
    return is_tied(state, block) ? flow_fork_one_as(state, &flow_kernel_tie_pack_pass, &args, as)
                                 : DUITE_OK;
}

int flow_ties_show_basis(struct flow_state *state)
{
    struct flow_block_args args = {0};
    int code = DUITE_OK;
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++)
        if (is_tied(state, args.block))
            code = flow_fork_one(state, &flow_kernel_tie_show_basis, &args);
    return code;
}
