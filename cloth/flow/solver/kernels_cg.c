/* Conjugate gradients, a body a block and pass (cloth/solve/cg.h). Factors and what comes next are
 * a shared object: every body reads the same bits and does the same. A block keeps copies of r and
 * p of the rows that its cut springs need, and changes them as their owner does: of a neighbour it
 * reads rows of q only. */
#include "cloth/flow/bodies.h"

#include <math.h>
#include <string.h>

static int begin(const duite_call *call)
{
    *duite_out(call, 0, struct solve_scalars) = flow_begin_scalars(call);
    return 0;
}
const duite_kernel flow_begin = {.name = "cg_begin",
                                 .body = begin,
                                 .access = {DUITE_W},
                                 .args_size = sizeof(struct flow_args),
                                 .replicated = 1};

static int start(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    phys_vec *q = duite_out(call, 5, phys_vec);
    solve_start(t->n, t->free, duite_in(call, 1, phys_vec), duite_out(call, 2, phys_vec),
                duite_out(call, 3, phys_vec), duite_out(call, 4, phys_vec), q);
    memset(duite_out(call, 6, phys_vec), 0, duite_count(call, 6) * sizeof(double));
    flow_pack_rim(t, q, duite_out(call, 7, double));
    return 0;
}
FLOW_TIMED(start, FLOW_CG)
const duite_kernel flow_start = {
    .name = "cg_start",
    .body = start_timed,
    .access = {DUITE_R, DUITE_R, DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_W, DUITE_W},
    .args_size = sizeof(struct flow_args)};

enum { SCALARS = 1, A, B, DV, R, P, Q, COPIES, RIM, SUMS, NEIGHBOURS }; /* parameters of a pass */

static void advance_copies(const duite_call *call, const struct flow_table *t,
                           const struct solve_scalars *scalars)
{
    phys_vec *r = duite_out(call, COPIES, phys_vec), *p = r + t->n_copies;
    const uint32_t *at = flow_of(call)->at + (t->copy - flow_of(call)->tables.copy);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const uint32_t from = t->copies[s];
        solve_advance_copies(t->copies[s + 1] - from, scalars->alpha, scalars->beta,
                             duite_in(call, NEIGHBOURS + s, double), at + from, r + from, p + from);
    }
}

static void advance(const duite_call *call, const struct solve_scalars *scalars,
                    const struct flow_pass *pass, double dots[SOLVE_DOTS])
{
    const struct flow_table *t = pass->table;
    const struct solve_cut cut = flow_table_cut_entries(t);
    advance_copies(call, t, scalars);
    solve_pass(&t->matrix, &cut, pass->value, pass->copies + t->n_copies, scalars->alpha,
               scalars->beta, &pass->rows, dots);
    flow_add_norms(call, &t->matrix, &pass->rows, dots);
    flow_pack_rim(t, pass->rows.q, pass->rim);
}

static int pass(const duite_call *call)
{
    struct flow_table table = flow_table_of(call), *t = &table;
    const struct solve_scalars *scalars = duite_in(call, SCALARS, struct solve_scalars);
    struct flow_pass pass;
    flow_pass_open(call, t, COPIES, NEIGHBOURS, &pass);
    double dots[SOLVE_DOTS] = {0};
    if (scalars->phase == SOLVE_LAST)
        dots[SOLVE_RR] =
            solve_finish(t->n, scalars->alpha, pass.rows.q, pass.rows.p, pass.rows.dv, pass.rows.r);
    else if (scalars->phase == SOLVE_ON)
        advance(call, scalars, &pass, dots);
    else
        flow_pass_beside(call, scalars, &pass, dots);
    if (scalars->phase == SOLVE_AGAIN)
        flow_pack_rim(t, pass.rows.q, pass.rim);
    memcpy(duite_out(call, SUMS, double), dots, flow_dots(flow_of(call)->model) * sizeof *dots);
    return 0;
}
FLOW_TIMED(pass, FLOW_CG)
const duite_kernel flow_pass = {.name = "cg_pass",
                                .body = pass_timed,
                                .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_RW, DUITE_RW,
                                           DUITE_RW, DUITE_RW, DUITE_RW, DUITE_RW, DUITE_CW},
                                .variadic = DUITE_R,
                                .args_size = sizeof(struct flow_args)};

static struct solve_stop stop_of(const struct model *model)
{
    return (struct solve_stop){.count = model->stop == MODEL_STOP_COUNT,
                               .confirm = model->stop != MODEL_STOP_COUNT,
                               .relative = model->stop == MODEL_STOP_RELATIVE,
                               .mass_norm = model->stop == MODEL_STOP_MASS_NORM,
                               .normalised = model->stop == MODEL_STOP_NORMALISED,
                               .tolerance = model->tolerance,
                               .most = model->max_iterations};
}

static int not_converged(const duite_call *call, const struct solve_scalars *now)
{
    const struct model *model = flow_of(call)->model;
    const char *what = "a residual";
    double left = sqrt(now->square), wanted = sqrt(now->wanted);
    if (model_stops_by_norms(model))
        wanted = model->tolerance;
    if (model->stop == MODEL_STOP_NORMALISED) {
        what = "a normalised residual";
        left = sqrt(now->bound / now->unit);
    } else if (model->stop == MODEL_STOP_MASS_NORM) {
        what = "an error of dv";
        left = sqrt(solve_scalars_error(now, now->bound) / now->size);
    }
    return duite_fail(
        call, FLOW_NOT_CONVERGED,
        "step %.0f: conjugate gradients stopped at %s of %g after %.0f iterations, %g was "
        "asked for; allow more iterations, a larger tolerance or a smaller h",
        flow_step_number(now->step), what, left, solve_scalars_iterations(now), wanted);
}

static int stalled(const duite_call *call, const struct solve_scalars *now)
{
    return duite_fail(
        call, FLOW_NOT_CONVERGED,
        "step %.0f: conjugate gradients come to no residual below %g, begun anew %.0f "
        "times: that is what rounding leaves of this matrix; allow a larger "
        "tolerance, or take a smaller h or softer materials",
        flow_step_number(now->step), sqrt(now->square), now->restarts);
}

/* Of what is the same on every rank, the model too. */
int flow_next_scalars(const duite_call *call, const double dots[SOLVE_DOTS],
                      const struct solve_scalars *before, struct solve_scalars *after)
{
    const struct solve_stop stop = stop_of(flow_of(call)->model);
    const int outcome = solve_scalars_next(&stop, dots, before, after);
    if (after->last == 0) /* the outcome goes on to the status of the step */
        return 0;
    if (outcome == SOLVE_NOT_CONVERGED)
        return not_converged(call, after);
    if (outcome == SOLVE_STALLED)
        return stalled(call, after);
    if (outcome == SOLVE_BREAKDOWN)
        return duite_fail(call, FLOW_INDEFINITE,
                          "step %.0f: conjugate gradients broke down (p.Ap = %g, r.r = %g): the "
                          "matrix is not positive definite, or forces are beyond all measure",
                          flow_step_number(after->step), after->curvature, after->square);
    return 0;
}

static int scalars(const duite_call *call)
{
    double dots[SOLVE_DOTS] = {0};
    memcpy(dots, duite_in(call, 0, double), flow_dots(flow_of(call)->model) * sizeof *dots);
    dots[SOLVE_RZ] = dots[SOLVE_RR];
    return flow_next_scalars(call, dots, duite_in(call, 1, struct solve_scalars),
                             duite_out(call, 2, struct solve_scalars));
}
const duite_kernel flow_scalars = {
    .name = "cg_scalars", .body = scalars, .access = {DUITE_R, DUITE_R, DUITE_W}, .replicated = 1};
