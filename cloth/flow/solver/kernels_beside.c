/* The passes beside the iterations of a solve (cloth/solve/cg.h). One that confirms it: neighbours
 * are shown dv, so that the block can multiply by it; then r is the true residual; if that refuses
 * dv, all vectors are as before the first pass, with the true residual for the right side. One that
 * begins it with a guess does the same with the guess. */
#include "cloth/flow/bodies.h"

#include <string.h>

void flow_pass_open(const duite_call *call, struct flow_table *t, size_t copies, size_t neighbours,
                    struct flow_pass *pass)
{
    enum { MATRIX = 2, B, DV, R, P, Q };
    *pass = (struct flow_pass){.table = t,
                               .value = flow_open_matrix(call, t, MATRIX),
                               .b = duite_in(call, B, phys_vec),
                               .rows = {duite_out(call, DV, phys_vec), duite_out(call, R, phys_vec),
                                        duite_out(call, P, phys_vec), duite_out(call, Q, phys_vec)},
                               .copies = duite_out(call, copies, phys_vec),
                               .rim = duite_out(call, copies + 1, double),
                               .neighbours = neighbours};
}

/* dv of the copies, from the rims of the blocks that have them. */
static void read_shown(const duite_call *call, const struct flow_pass *pass, phys_vec *dv)
{
    const struct flow_table *t = pass->table;
    const uint32_t *at = flow_of(call)->at + (t->copy - flow_of(call)->tables.copy);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->copies[s];
        solve_unpack(t->copies[s + 1] - from, duite_in(call, pass->neighbours + s, double),
                     at + from, dv + from);
    }
}

static int guess(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *dv = duite_out(call, 3, phys_vec);
    flow_open_matrix(call, t, 2);
    solve_start_guess(t->n, t->free, t->matrix.filter, duite_in(call, 1, phys_vec),
                      flow_args_of(call)->guess, dv, duite_out(call, 4, phys_vec),
                      duite_out(call, 5, phys_vec), duite_out(call, 6, phys_vec));
    flow_pack_rim(t, dv, duite_out(call, 7, double));
    return 0;
}
FLOW_TIMED(guess, FLOW_CG)
const duite_kernel flow_guess = {
    .name = "cg_guess",
    .body = guess_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_W, DUITE_W, DUITE_W, DUITE_W},
    .args_size = sizeof(struct flow_args)};

/* The product with dv, or with the guess that is there. */
static void multiply(const duite_call *call, bool opens, const struct flow_pass *pass,
                     double dots[SOLVE_DOTS])
{
    const struct flow_table *t = pass->table;
    const struct solve_cut cut = flow_table_cut_entries(t);
    phys_vec *shown = pass->copies + t->n_copies;
    read_shown(call, pass, shown);
    if (opens)
        solve_open(&t->matrix, &cut, pass->value, shown, &pass->rows, dots);
    else
        solve_residual(&t->matrix, &cut, pass->value, pass->b, shown, &pass->rows, dots);
}

void flow_pass_beside(const duite_call *call, const struct solve_scalars *scalars,
                      const struct flow_pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = pass->table;
    const struct solve_rows *rows = &pass->rows;
    if (scalars->phase == SOLVE_SHOW)
        flow_pack_rim(t, rows->dv, pass->rim);
    if (scalars->phase == SOLVE_CHECK || scalars->phase == SOLVE_OPEN)
        multiply(call, scalars->phase == SOLVE_OPEN, pass, dots);
    if (scalars->phase != SOLVE_AGAIN)
        return;
    solve_finish(t->n, scalars->alpha, rows->q, rows->p, rows->dv, rows->r);
    solve_again(t->n, rows->r, rows->p, rows->q);
    memset(pass->copies, 0, 2 * (size_t)t->n_copies * sizeof *pass->copies);
}
