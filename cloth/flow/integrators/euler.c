/* Explicit Euler, which moves x with the old v, and symplectic Euler, which moves it with the new
 * one. */
#include "cloth/flow/integrators/explicit.h"

/* Moves x and v by the forces at the present state. */
static int euler_move(const duite_call *call, const struct flow_table *t,
                      const struct flow_step_args *step, const struct flow_view *view,
                      const struct flow_move *m)
{
    const bool ahead = flow_of(call)->model->integrator == MODEL_SYMPLECTIC_EULER;
    phys_vec *f = flow_force_room(call);
    flow_fetch_own(t, m->halo_x);
    flow_fetch_own(t, m->halo_v);
    flow_fetch_halos(t, view);
    flow_forces(call, t, step, view, f);
    flow_sliders_filter(call, t, step->time, f);
    flow_part_ends(call, FLOW_FORCE);
    const int well = phys_euler(t->n, step->h, ahead, FLOW_BOUND, t->mass, t->free, f, m->from_x,
                                m->from_v, m->x, m->v);
    flow_write_halo(t, m->x, m->halo_x);
    flow_write_halo(t, m->v, m->halo_v);
    if (well)
        return 0;
    const int code =
        flow_check(call, t, step, ahead ? m->v : m->x, ahead ? "velocity" : "position", m->status);
    return code ? code
                : flow_check(call, t, step, ahead ? m->x : m->v, ahead ? "position" : "velocity",
                             m->status);
}

/* In place. */
FLOW_KERNEL(euler, FLOW_VELOCITY, struct flow_step_args,
            (R(table), RW(x), RW(v), W(spare_halo_x), W(spare_halo_v), SUM(status),
             NEIGHBOURS(halo_x), NEIGHBOURS(halo_v), IF_MADE(tie_table), IF_MADE(contact_rows),
             TIED(tie_halo)))
static int euler_body(const duite_call *call, const struct euler_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    const struct flow_move move = FLOW_MOVE(on, x, v, spare_halo_x, spare_halo_v);
    return euler_move(call, &table, on->args, &view, &move);
}

/* Beside the state, which stays as it is. */
FLOW_KERNEL(euler_next, FLOW_VELOCITY, struct flow_step_args,
            (R(table), R(x), R(v), W(kept_x), W(kept_v), W(spare_halo_x), W(spare_halo_v),
             SUM(status), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v), IF_MADE(tie_table),
             IF_MADE(contact_rows), TIED(tie_halo)))
static int euler_next_body(const duite_call *call, const struct euler_next_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    const struct flow_move move = FLOW_MOVE(on, kept_x, kept_v, spare_halo_x, spare_halo_v);
    return euler_move(call, &table, on->args, &view, &move);
}

/* The state is copied first with pins, which write into it before the forces. Its objects stay with
 * recorded rounds of a correction, which name them. */
bool flow_euler_keeps(const struct model *model)
{
    return model->halving && !model_is_driven(model) && !model->correction_rounds;
}

void flow_euler_restore(struct flow_state *state)
{
    flow_swap_kept(state);
    flow_swap_halos(state);
}

int flow_euler_end(struct flow_state *state)
{
    const bool keeps = flow_euler_keeps(state->flow->model);
    struct flow_step_args args = flow_explicit_args(state, 0);
    const int code =
        flow_fork_each(state, keeps ? &flow_kernel_euler_next : &flow_kernel_euler, &args);
    flow_swap_halos(state);
    if (keeps)
        flow_swap_kept(state);
    return code;
}
