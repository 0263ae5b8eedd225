/* Preconditioners of a solve: none, one of each block alone (cloth/solve/local.h), or that with a
 * coarse part (coarse.c).
 *
 * In reading order: the choice for a run, the factor of a block in each step, its use in a pass. */
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

/* ---- The choice ---- */

void flow_preconditioner_choose(struct flow *flow, uint32_t n_blocks)
{
    flow->preconditioner =
        model_is_implicit(flow->model) ? flow->model->preconditioner : MODEL_PLAIN;
    flow->patches = model_patches(flow->model, n_blocks);
}

int flow_preconditioner_prepare(struct flow_state *state)
{
    struct flow *flow = state->flow;
    flow_preconditioner_choose(flow, flow->tables.n_blocks);
    return flow_is_coarse(flow) ? flow_coarse_prepare(state) : DUITE_OK;
}

void flow_preconditioner_free(struct flow *flow)
{
    flow_coarse_free(flow);
}

/* ---- The factor of a block, of each step's matrix ---- */

FLOW_KERNEL(factor, FLOW_CG, struct flow_block_args,
            (R(table), R(a), W(factor), SUM(status), IF_MADE(tie_table)))
static int factor_body(const duite_call *call, const struct factor_fields *on)
{
    const enum solve_local local = flow_local(flow_of(call));
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *values = flow_matrix_in(call, t, on->a);
    const struct flow_ties ties = flow_ties_open(on->tie_table);
    const struct solve_ties solved = flow_ties_solved(&ties, flow_tie_values(t, values), NULL);
    struct solve_cut cut = flow_table_cut_entries(t);
    cut.ties = &solved;
    const int tried = solve_local_factor(&t->matrix, &cut, values, local, on->factor);
    /* The object also has room for double entries (flow_table): zeros. */
    const size_t used = solve_local_doubles(t->n, t->matrix.row[t->n], local);
    memset(on->factor + used, 0,
           (solve_local_doubles(t->n, t->n_entries, local) - used) * sizeof *on->factor);
    on->status[FLOW_SHIFTED] = tried > 0;
    return 0;
}

int flow_preconditioner_factor(struct flow_state *state, uint32_t first, uint32_t end)
{
    struct flow_block_args args;
    return flow_is_preconditioned(state->flow)
               ? flow_fork_range_as(state, &flow_kernel_factor, first, end, &args, NULL)
               : DUITE_OK;
}

/* ---- In a pass ---- */

double flow_precondition(const struct flow_preconditioner *m, const phys_vec *q, phys_vec *s,
                         double *right)
{
    const double product =
        solve_local_apply(&m->table->matrix, flow_local(m->flow), m->factor, q, s);
    if (m->basis)
        flow_coarse_restrict(m, q, right);
    return product;
}
