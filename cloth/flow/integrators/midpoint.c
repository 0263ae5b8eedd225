/* The explicit midpoint method (Runge 1895): a half step by explicit Euler finds the slopes that
 * move x and v through the whole step from its begin. Each of the two is a task a block. */
#include "cloth/flow/integrators/explicit.h"

#include <string.h>

enum { MIDPOINT_STAGES = 2 };

/* Stage 0 keeps the state of the step's begin in x0 and v0; the slopes are v and a at x, v. */
static void midpoint_stage(const struct flow_table *t, const struct flow_stage_args *args,
                           const phys_vec *a, phys_vec *x0, phys_vec *v0, phys_vec *x, phys_vec *v)
{
    const double part = args->stage == 0 ? 0.5 * args->step.h : args->step.h;
    if (args->stage == 0) {
        memcpy(x0, x, t->n * sizeof *x);
        memcpy(v0, v, t->n * sizeof *v);
    }
    for (uint32_t i = 0; i < t->n; i++) {
        x[i] = x0[i] + part * v[i];
        v[i] = v0[i] + part * a[i];
    }
}

FLOW_KERNEL(midpoint, FLOW_POSITION, struct flow_stage_args,
            (R(table), RW(x), RW(v), RW(x0), RW(v0), W(spare_halo_x), W(spare_halo_v), SUM(status),
             NEIGHBOURS(halo_x), NEIGHBOURS(halo_v), IF_MADE(tie_table), IF_MADE(contact_rows),
             TIED(tie_halo)))
static int midpoint_body(const duite_call *call, const struct midpoint_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_step_args *step = &on->args->step;
    const struct flow_view view = FLOW_VIEW(on);
    const phys_vec *a = flow_stage_slopes(call, t, step, &view, on->spare_halo_x, on->spare_halo_v);
    midpoint_stage(t, on->args, a, on->x0, on->v0, on->x, on->v);
    return flow_stage_end(call, t, step, FLOW_MOVED(on));
}

int flow_midpoint_end(struct flow_state *state)
{
    static const double when[MIDPOINT_STAGES] = {0, 0.5};
    int code = DUITE_OK;
    for (uint32_t stage = 0; stage < MIDPOINT_STAGES && !code; stage++) {
        struct flow_stage_args args = {.step = flow_explicit_args(state, when[stage]),
                                       .stage = stage};
        code = flow_fork_each(state, &flow_kernel_midpoint, &args);
        flow_swap_halos(state);
    }
    return code;
}
