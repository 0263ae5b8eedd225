/* Explicit integrators: both Eulers, velocity Verlet, the classic Runge-Kutta method. They have no
 * solve (cloth/physics/particle.h). Each step begins and ends with x, v and their halos. A task
 * that finds forces reads its neighbours' halos and moves its own rows at once. It writes its next
 * rows to spare halos. These become the halos when all such tasks are forked. So blocks do not wait
 * until neighbours have read them, and forces stay in the caches. */
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"

#include "cloth/physics/particle.h"

/* Spare halos become the halos that neighbours read next. Called when all tasks are forked. */
static void swap_halos_v(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_halo_v, FLOW_FIELD_spare_halo_v);
}

static void swap_halos(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_halo_x, FLOW_FIELD_spare_halo_x);
    swap_halos_v(state);
}

/* Arguments of a task that finds forces when so much of the step is over. */
static struct flow_step_args args_at(const struct flow_state *state, double part)
{
    struct flow_step_args args = flow_attempt_args(state);
    args.now = (args.begin + part * state->attempt.length) * state->flow->model->h / FLOW_TICKS;
    return args;
}

/* Prefetch the data that a task uses after its long loops, which prefetch their own: its own halo,
 * which it writes, and rows of the neighbours' halos. */
static void fetch_own(const struct flow_table *t, const phys_vec *halo)
{
    enum { ROWS = 2 }; /* a cache line */
    for (uint32_t i = 0; i < t->n_halo; i += ROWS)
        phys_fetch(halo + i, 0, 1);
}

static void fetch_halos(const struct flow_table *t, const struct flow_view *view)
{
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const phys_vec *x = flow_rows_of(view->halo_x, s), *v = flow_rows_of(view->halo_v, s);
        for (uint32_t i = t->ghost_start[s]; i < t->ghost_start[s + 1]; i++) {
            phys_fetch(x + t->ghost[i], 0, 0);
            phys_fetch(v + t->ghost[i], 0, 0);
        }
    }
}

/* The forces on the block's rows where they are, in room of the worker's. */
static phys_vec *explicit_find_forces(const duite_call *call, const struct flow_table *t,
                                      const struct flow_step_args *step,
                                      const struct flow_view *view, const struct flow_move *m)
{
    const struct flow *flow = flow_of(call);
    phys_vec *f = flow->forces + call->worker * flow->n_forces;
    fetch_own(t, m->halo_x);
    fetch_own(t, m->halo_v);
    fetch_halos(t, view);
    flow_forces(call, t, step, view, true, f);
    return f;
}

static void write_halos(const struct flow_table *t, const struct flow_move *m)
{
    flow_write_halo(t, m->x, m->halo_x);
    flow_write_halo(t, m->v, m->halo_v);
}

/* ---- Euler: the explicit method moves x with the old v, the symplectic one with the new v ---- */

/* Moves x and v by the forces at the present state. */
static int euler_move(const duite_call *call, const struct flow_table *t,
                      const struct flow_step_args *step, const struct flow_view *view,
                      const struct flow_move *m)
{
    const bool ahead = model_scheme(flow_of(call)->model)->staggered;
    phys_vec *f = explicit_find_forces(call, t, step, view, m);
    flow_sliders_filter(call, t, step->time, f);
    flow_part_ends(call, FLOW_FORCE);
    const int well = phys_euler(t->n, step->h, ahead, FLOW_BOUND, t->mass, t->free, f, m->from_x,
                                m->from_v, m->x, m->v);
    write_halos(t, m);
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
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    const struct flow_move move = FLOW_MOVE(on, kept_x, kept_v, spare_halo_x, spare_halo_v);
    return euler_move(call, &table, on->args, &view, &move);
}

/* The state is copied first with pins, which write into it before the forces. Its objects stay with
 * recorded rounds of a correction, which name them. */
static bool euler_keeps(const struct model *model)
{
    return model->halving && !model_is_driven(model) && !model->correction_rounds;
}

static void euler_restore(struct flow_state *state)
{
    flow_swap_kept(state);
    swap_halos(state);
}

static int euler_end(struct flow_state *state)
{
    const bool keeps = euler_keeps(state->flow->model);
    struct flow_step_args args = args_at(state, 0);
    flow_fork_each(state, keeps ? &flow_kernel_euler_next : &flow_kernel_euler, &args);
    swap_halos(state);
    if (keeps)
        flow_swap_kept(state);
    return state->code;
}

const struct flow_integrator flow_integrator_explicit_euler = {
    .end = euler_end, .keeps = euler_keeps, .restore = euler_restore};
const struct flow_integrator flow_integrator_symplectic_euler = {
    .end = euler_end, .keeps = euler_keeps, .restore = euler_restore};

/* ---- Velocity Verlet ----
 *
 * f, without the drag, stays from step to step: the last forces of a step begin the next one,
 * unless contact, pins or a correction moved something in between, or the step was taken back. */

static int verlet_begin(struct flow_state *state)
{
    struct flow_step_args args = args_at(state, 0);
    if (state->settled_forces && !flow_ties_changed(state) && !state->flow->model->sizes)
        return state->code;
    return flow_fork_each(state, &flow_kernel_force_free, &args);
}

/* v becomes a guess of the velocity at the end of the step, for forces that depend on it. */
FLOW_KERNEL(verlet_first, FLOW_POSITION, struct flow_step_args,
            (R(table), RW(x), RW(v), R(f), W(v0), W(halo_x), W(halo_v), SUM(status)))
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
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_view view = FLOW_VIEW(on);
    fetch_own(t, on->spare_halo_v);
    fetch_halos(t, &view);
    flow_forces(call, t, on->args, &view, false, on->f);
    flow_part_ends(call, FLOW_FORCE);
    phys_kick(t->n, 0.5 * on->args->h, 0, t->mass, t->drag, t->free, on->f, on->v0, on->v);
    flow_sliders_keep(call, t, on->args->time, on->v0, on->v);
    flow_write_halo(t, on->v, on->spare_halo_v);
    return flow_check(call, t, on->args, on->v, "velocity", on->status);
}

static int verlet_end(struct flow_state *state)
{
    struct flow_step_args args = args_at(state, 1);
    flow_fork_each(state, &flow_kernel_verlet_first, &args);
    flow_fork_each(state, &flow_kernel_verlet_second, &args);
    swap_halos_v(state);
    state->settled_forces = model_leaves_ends(state->flow->model);
    return state->code;
}

const struct flow_integrator flow_integrator_verlet = {
    .begin = verlet_begin, .end = verlet_end, .ends_forces = true};

/* ---- The classic Runge-Kutta method: four stages, each a task a block ---- */

struct runge_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    uint32_t stage; /* from 0 */
};

FLOW_KERNEL(runge, FLOW_POSITION, struct runge_args,
            (R(table), RW(x), RW(v), RW(x0), RW(v0), RW(sum_x), RW(sum_v), W(spare_halo_x),
             W(spare_halo_v), SUM(status), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v),
             IF_MADE(tie_table), IF_MADE(contact_rows), TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_step_args *step = &on->args->step;
    const struct flow_view view = FLOW_VIEW(on);
    const struct phys_runge runge = {
        .x0 = on->x0, .v0 = on->v0, .sum_x = on->sum_x, .sum_v = on->sum_v};
    const struct flow_move move = FLOW_MOVE(on, x, v, spare_halo_x, spare_halo_v);
    phys_vec *a = explicit_find_forces(call, t, step, &view, &move);
    flow_part_ends(call, FLOW_FORCE);
    phys_accelerate(t->n, t->mass, t->free, a);
    flow_sliders_filter(call, t, step->time, a);
    flow_part_ends(call, FLOW_ACCELERATION);
    phys_runge_stage(t->n, step->h, (int)on->args->stage, a, &runge, on->x, on->v);
    write_halos(t, &move);
    const int code = flow_check(call, t, step, on->x, "position", on->status);
    return code ? code : flow_check(call, t, step, on->v, "velocity", on->status);
}

static int runge_end(struct flow_state *state)
{
    for (uint32_t stage = 0; stage < PHYS_RUNGE_STAGES; stage++) {
        struct runge_args args = {.step = args_at(state, phys_runge_rows[stage].at),
                                  .stage = stage};
        flow_fork_each(state, &flow_kernel_runge, &args);
        swap_halos(state);
    }
    return state->code;
}

const struct flow_integrator flow_integrator_rk4 = {.end = runge_end, .in_stages = true};
