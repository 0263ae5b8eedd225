/* Conjugate gradients, a body a block and vector operation. Scalars are shared objects: every body
 * reads the same bits and decides the same. */
#include "cloth/flow/tasks/bodies.h"

#include <string.h>

static int start(const duite_call *call)
{
    const struct flow_table *t = flow_table_of(call);
    phys_vec *p = duite_out(call, 3, phys_vec);
    *duite_out(call, 5, double) =
        solve_start(t->n, t->free, duite_in(call, 0, phys_vec), duite_out(call, 1, phys_vec),
                    duite_out(call, 2, phys_vec), p);
    flow_write_rim(t, p, duite_out(call, 4, phys_vec));
    return 0;
}
FLOW_TIMED(start, FLOW_CG)
const duite_kernel flow_start = {.name = "cg_start",
                                 .body = start_timed,
                                 .access = {DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_CW},
                                 .args_size = sizeof(struct flow_args)};

static int matvec(const duite_call *call)
{
    const struct flow_table *t = flow_table_of(call);
    const phys_vec *p = duite_in(call, 0, phys_vec), *value = duite_in(call, 1, phys_vec);
    phys_vec *q = duite_out(call, 2, phys_vec);
    memset(q, 0, t->n * sizeof *q);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->n_inner + t->cut[s];
        const struct solve_cut cut = {t->cut[s + 1] - t->cut[s], t->end + from};
        solve_matvec_cut(&cut, value + from, p, duite_in(call, 4 + s, phys_vec), q);
    }
    *duite_out(call, 3, double) = solve_matvec(&t->matrix, value, p, q);
    return 0;
}
FLOW_TIMED(matvec, FLOW_CG)
const duite_kernel flow_matvec = {.name = "cg_matvec",
                                  .body = matvec_timed,
                                  .access = {DUITE_R, DUITE_R, DUITE_W, DUITE_CW},
                                  .rest = DUITE_R,
                                  .args_size = sizeof(struct flow_args)};

/* Where r is nothing, nothing is left to do. */
static int update(const duite_call *call)
{
    const struct flow_table *t = flow_table_of(call);
    const double pq = *duite_in(call, 0, double), rho = *duite_in(call, 1, double);
    const bool done = rho < FLOW_NOTHING;
    if (!(pq > 0) && !done)
        return duite_fail(call, FLOW_INDEFINITE,
                          "step %u: conjugate gradients broke down (p.Ap = %g, r.r = %g): the "
                          "matrix is not positive definite, or forces are beyond "
                          "all measure",
                          flow_args_of(call)->step + 1, pq, rho);
    *duite_out(call, 6, double) = solve_update(
        t->n, done ? 0 : rho / pq, duite_in(call, 2, phys_vec), duite_in(call, 3, phys_vec),
        duite_out(call, 4, phys_vec), duite_out(call, 5, phys_vec));
    return 0;
}
FLOW_TIMED(update, FLOW_CG)
const duite_kernel flow_update = {
    .name = "cg_update",
    .body = update_timed,
    .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_RW, DUITE_CW},
    .args_size = sizeof(struct flow_args)};

static int direction(const duite_call *call)
{
    const struct flow_table *t = flow_table_of(call);
    const double rho_new = *duite_in(call, 0, double), rho = *duite_in(call, 1, double);
    phys_vec *p = duite_out(call, 3, phys_vec);
    solve_direction(t->n, rho < FLOW_NOTHING ? 0 : rho_new / rho, duite_in(call, 2, phys_vec), p);
    flow_write_rim(t, p, duite_out(call, 4, phys_vec));
    return 0;
}
FLOW_TIMED(direction, FLOW_CG)
const duite_kernel flow_direction = {.name = "cg_direction",
                                     .body = direction_timed,
                                     .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_W},
                                     .args_size = sizeof(struct flow_args)};
