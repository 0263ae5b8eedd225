/* The passes that confirm a solve (cloth/solve/cg.h): neighbours are shown dv, so that the block
 * can multiply by it; then r is the true residual; if that refuses dv, all vectors are as before
 * the first pass, with the true residual for the right side. */
#include "cloth/flow/tasks/bodies.h"

#include <string.h>

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

void flow_pass_confirm(const duite_call *call, double phase, const struct flow_pass *pass,
                       double dots[SOLVE_DOTS])
{
    const struct flow_table *t = pass->table;
    if (phase == SOLVE_SHOW)
        flow_pack_rim(t, pass->rows.dv, pass->rim);
    if (phase == SOLVE_CHECK) {
        const struct solve_cut cut = flow_table_cut_entries(t);
        phys_vec *dv = pass->copies + t->n_copies;
        read_shown(call, pass, dv);
        solve_residual(&t->matrix, &cut, pass->value, pass->b, dv, &pass->rows, dots);
    }
    if (phase == SOLVE_AGAIN) {
        solve_again(t->n, pass->rows.r, pass->rows.p, pass->rows.q);
        memset(pass->copies, 0, 2 * (size_t)t->n_copies * sizeof *pass->copies);
    }
}
