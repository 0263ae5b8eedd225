/* Velocity Verlet. f, without the drag, stays from step to step: the last forces of a step begin
 * the next one, unless contact, pins or a correction moved something in between, or the step was
 * taken back. */
#include "cloth/flow/integrators/explicit.h"

int flow_verlet_begin(struct flow_state *state)
{
    struct flow_step_args args = flow_explicit_args(state, 0);
    if (state->settled_forces && !flow_ties_changed(state))
        return DUITE_OK;
    return flow_fork_each(state, &flow_kernel_force_free, &args);
}

/* v becomes a guess of the velocity at the end of the step, for forces that depend on it. */
FLOW_KERNEL(verlet_first, FLOW_POSITION, struct flow_step_args,
            (R(table), RW(x), RW(v), R(f), W(v0), W(halo_x), W(halo_v), SUM(status)))
static int verlet_first_body(const duite_call *call, const struct verlet_first_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const double h = on->args->h, half = 0.5 * h;
    phys_kick(t->n, half, 1, t->mass, t->drag, t->free, on->f, on->v, on->v0);
    flow_sliders_keep(call, t, on->args->time, on->v, on->v0);
    phys_kick(t->n, half, 0, t->mass, t->drag, t->free, on->f, on->v0, on->v);
    flow_sliders_keep(call, t, on->args->time, on->v0, on->v);
    flow_write_halo(t, on->v, on->halo_v);
    flow_part_ends(call, FLOW_VELOCITY);
    phys_advance(t->n, h, on->v0, on->x);
    flow_write_halo(t, on->x, on->halo_x);
    return flow_check(call, t, on->args, on->x, "position", on->status);
}

FLOW_KERNEL(verlet_second, FLOW_VELOCITY, struct flow_step_args,
            (R(table), R(x), RW(v), W(f), R(v0), W(spare_halo_v), SUM(status), NEIGHBOURS(halo_x),
             NEIGHBOURS(halo_v), IF_MADE(tie_table), IF_MADE(contact_rows), TIED(tie_halo)))
static int verlet_second_body(const duite_call *call, const struct verlet_second_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_view view = FLOW_VIEW(on);
    flow_fetch_own(t, on->spare_halo_v);
    flow_fetch_halos(t, &view);
    flow_forces_free(call, t, on->args, &view, on->f);
    flow_part_ends(call, FLOW_FORCE);
    phys_kick(t->n, 0.5 * on->args->h, 0, t->mass, t->drag, t->free, on->f, on->v0, on->v);
    flow_sliders_keep(call, t, on->args->time, on->v0, on->v);
    flow_write_halo(t, on->v, on->spare_halo_v);
    return flow_check(call, t, on->args, on->v, "velocity", on->status);
}

int flow_verlet_end(struct flow_state *state)
{
    struct flow_step_args args = flow_explicit_args(state, 1);
    int code = flow_fork_each(state, &flow_kernel_verlet_first, &args);
    if (!code)
        code = flow_fork_each(state, &flow_kernel_verlet_second, &args);
    flow_swap_halos_v(state);
    state->settled_forces = model_leaves_ends(state->flow->model);
    return code;
}
