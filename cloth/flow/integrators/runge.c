/* The classic Runge-Kutta method of four stages; each is a task a block. */
#include "cloth/flow/integrators/explicit.h"

FLOW_KERNEL(runge, FLOW_POSITION, struct flow_stage_args,
            (R(table), RW(x), RW(v), RW(x0), RW(v0), RW(sum_x), RW(sum_v), W(spare_halo_x),
             W(spare_halo_v), SUM(status), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v),
             IF_MADE(tie_table), IF_MADE(contact_rows), TIED(tie_halo)))
static int runge_body(const duite_call *call, const struct runge_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_step_args *step = &on->args->step;
    const struct flow_view view = FLOW_VIEW(on);
    const struct phys_runge runge = {
        .x0 = on->x0, .v0 = on->v0, .sum_x = on->sum_x, .sum_v = on->sum_v};
    const phys_vec *a = flow_stage_slopes(call, t, step, &view, on->spare_halo_x, on->spare_halo_v);
    phys_runge_stage(t->n, step->h, (int)on->args->stage, a, &runge, on->x, on->v);
    return flow_stage_end(call, t, step, FLOW_MOVED(on));
}

int flow_runge_end(struct flow_state *state)
{
    static const double when[PHYS_RUNGE_STAGES] = {0, 0.5, 0.5, 1};
    int code = DUITE_OK;
    for (uint32_t stage = 0; stage < PHYS_RUNGE_STAGES && !code; stage++) {
        struct flow_stage_args args = {.step = flow_explicit_args(state, when[stage]),
                                       .stage = stage};
        code = flow_fork_each(state, &flow_kernel_runge, &args);
        flow_swap_halos(state);
    }
    return code;
}
