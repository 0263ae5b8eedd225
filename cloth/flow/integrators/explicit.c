/* Steps that solve nothing (cloth/physics/stage.h). Each begins and ends with x, v and their rims;
 * what else an integrator keeps from step to step is said with it. A task that finds forces reads
 * its neighbours' rims and moves its own rows at once: what the neighbours are to read next goes to
 * spare rims, which are the rims when all such tasks are forked. So no block waits for its
 * neighbours to have seen it, and forces do not leave the caches. */
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/step/guides.h"
#include "cloth/flow/step/step.h"

#include "cloth/physics/particle.h"
#include "cloth/physics/stage.h"

static void swap_rims_v(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_rim_v, FLOW_FIELD_spare_rim_v);
}

static void swap_rims(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_rim_x, FLOW_FIELD_spare_rim_x);
    swap_rims_v(state);
}

static void swap_kept(struct flow_state *state)
{
    flow_fields_swap(state, FLOW_FIELD_x, FLOW_FIELD_kept_x);
    flow_fields_swap(state, FLOW_FIELD_v, FLOW_FIELD_kept_v);
}

/* Of a task that finds forces when so much of the step is over. */
static struct flow_args args_at(const struct flow_state *state, double part)
{
    struct flow_args args = flow_attempt_args(state);
    args.now = (args.begin + part * state->attempt.length) * state->flow->model->h / FLOW_TICKS;
    return args;
}

/* Asks memory for what a task comes to when its long loops, which ask for themselves, are done:
 * a rim of its own that it writes, and rows of the neighbours' rims. */
static void fetch_own(const struct flow_table *t, const phys_vec *rim)
{
    enum { ROWS = 2 }; /* a cache line */
    for (uint32_t i = 0; i < t->n_rim; i += ROWS)
        phys_fetch(rim + i, 0, 1);
}

static void fetch_rims(const struct flow_table *t, const struct flow_view *view)
{
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const phys_vec *x = flow_rows_of(view->rim_x, s), *v = flow_rows_of(view->rim_v, s);
        for (uint32_t i = t->copies[s]; i < t->copies[s + 1]; i++) {
            phys_fetch(x + t->copy[i], 0, 0);
            phys_fetch(v + t->copy[i], 0, 0);
        }
    }
}

/* ---- Either Euler ---- */

/* x and v by the forces at where they are. */
struct euler_move {
    const phys_vec *from_x, *from_v;
    phys_vec *x, *v, *rim_x, *rim_v;
    double *status;
};

static int euler_move(const duite_call *call, const struct flow_table *t,
                      const struct flow_view *view, const struct euler_move *m)
{
    const bool ahead = flow_of(call)->model->integrator == MODEL_SYMPLECTIC_EULER;
    phys_vec *f = flow_force_room(call);
    fetch_own(t, m->rim_x);
    fetch_own(t, m->rim_v);
    fetch_rims(t, view);
    flow_forces(call, t, view, f);
    flow_part_ends(call, FLOW_FORCE);
    const int well = phys_euler(t->n, flow_args_of(call)->h, ahead, FLOW_BOUND, t->mass, t->free, f,
                                m->from_x, m->from_v, m->x, m->v);
    flow_write_rim(t, m->x, m->rim_x);
    flow_write_rim(t, m->v, m->rim_v);
    if (well)
        return 0;
    const int code =
        flow_check(call, t, ahead ? m->v : m->x, ahead ? "velocity" : "position", m->status);
    return code ? code
                : flow_check(call, t, ahead ? m->x : m->v, ahead ? "position" : "velocity",
                             m->status);
}

/* In place. */
FLOW_KERNEL(euler, FLOW_VELOCITY, struct flow_args,
            (R(table), RW(x), RW(v), W(spare_rim_x), W(spare_rim_v), SUM(status), NEIGHBOURS(rim_x),
             NEIGHBOURS(rim_v)))
static int euler_body(const duite_call *call, const struct euler_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    const struct euler_move move = {.from_x = on->x,
                                    .from_v = on->v,
                                    .x = on->x,
                                    .v = on->v,
                                    .rim_x = on->spare_rim_x,
                                    .rim_v = on->spare_rim_v,
                                    .status = on->status};
    return euler_move(call, &table, &view, &move);
}

/* Beside the state, which stays as it is. */
FLOW_KERNEL(euler_beside, FLOW_VELOCITY, struct flow_args,
            (R(table), R(x), R(v), W(kept_x), W(kept_v), W(spare_rim_x), W(spare_rim_v),
             SUM(status), NEIGHBOURS(rim_x), NEIGHBOURS(rim_v)))
static int euler_beside_body(const duite_call *call, const struct euler_beside_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    const struct euler_move move = {.from_x = on->x,
                                    .from_v = on->v,
                                    .x = on->kept_x,
                                    .v = on->kept_v,
                                    .rim_x = on->spare_rim_x,
                                    .rim_v = on->spare_rim_v,
                                    .status = on->status};
    return euler_move(call, &table, &view, &move);
}

static bool is_euler(const struct model *model)
{
    return model->integrator == MODEL_EXPLICIT_EULER || model->integrator == MODEL_SYMPLECTIC_EULER;
}

/* Pins write into the state before the forces: then it is copied first. */
bool flow_explicit_keeps(const struct model *model)
{
    return is_euler(model) && model->halving && !model_is_driven(model);
}

void flow_explicit_restore(struct flow_state *state)
{
    swap_kept(state);
    swap_rims(state);
}

int flow_explicit_euler_end(struct flow_state *state)
{
    const bool keeps = flow_explicit_keeps(state->flow->model);
    struct flow_args args = args_at(state, 0);
    const int code =
        flow_fork_each(state, keeps ? &flow_kernel_euler_beside : &flow_kernel_euler, &args);
    swap_rims(state);
    if (keeps)
        swap_kept(state);
    return code;
}

/* ---- Velocity Verlet ---- */

int flow_verlet_begin(struct flow_state *state)
{
    struct flow_args args = args_at(state, 0);
    return state->settled_forces ? DUITE_OK : flow_fork_each(state, &flow_kernel_force_free, &args);
}

/* v becomes a guess of the velocity at the end of the step, for forces that depend on it. */
FLOW_KERNEL(verlet_first, FLOW_POSITION, struct flow_args,
            (R(table), RW(x), RW(v), R(f), W(v0), W(rim_x), W(rim_v), SUM(status)))
static int verlet_first_body(const duite_call *call, const struct verlet_first_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const double h = on->args->h, half = 0.5 * h;
    phys_kick(t->n, half, 1, t->mass, t->drag, t->free, on->f, on->v, on->v0);
    flow_guides_keep(call, t, on->v, on->v0);
    phys_kick(t->n, half, 0, t->mass, t->drag, t->free, on->f, on->v0, on->v);
    flow_guides_keep(call, t, on->v0, on->v);
    flow_write_rim(t, on->v, on->rim_v);
    flow_part_ends(call, FLOW_VELOCITY);
    phys_advance(t->n, h, on->v0, on->x);
    flow_write_rim(t, on->x, on->rim_x);
    return flow_check(call, t, on->x, "position", on->status);
}

FLOW_KERNEL(verlet_second, FLOW_VELOCITY, struct flow_args,
            (R(table), R(x), RW(v), W(f), R(v0), W(spare_rim_v), SUM(status), NEIGHBOURS(rim_x),
             NEIGHBOURS(rim_v)))
static int verlet_second_body(const duite_call *call, const struct verlet_second_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_view view = FLOW_VIEW(on);
    fetch_own(t, on->spare_rim_v);
    fetch_rims(t, &view);
    flow_forces_free(call, t, &view, on->f);
    flow_part_ends(call, FLOW_FORCE);
    phys_kick(t->n, 0.5 * on->args->h, 0, t->mass, t->drag, t->free, on->f, on->v0, on->v);
    flow_guides_keep(call, t, on->v0, on->v);
    flow_write_rim(t, on->v, on->spare_rim_v);
    return flow_check(call, t, on->v, "velocity", on->status);
}

/* f, without the drag, stays from step to step: what ends one begins the next, unless contact or
 * pins moved something in between, or the step was taken back. */
int flow_verlet_end(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    struct flow_args args = args_at(state, 1);
    int code = flow_fork_each(state, &flow_kernel_verlet_first, &args);
    if (!code)
        code = flow_fork_each(state, &flow_kernel_verlet_second, &args);
    swap_rims_v(state);
    state->settled_forces = !model->n_obstacles && !model_is_driven(model);
    return code;
}

/* ---- Runge-Kutta ---- */

FLOW_KERNEL(runge, FLOW_POSITION, struct flow_args,
            (R(table), RW(x), RW(v), RW(x0), RW(v0), RW(sum_x), RW(sum_v), W(spare_rim_x),
             W(spare_rim_v), SUM(status), NEIGHBOURS(rim_x), NEIGHBOURS(rim_v)))
static int runge_body(const duite_call *call, const struct runge_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct flow_view view = FLOW_VIEW(on);
    const struct phys_runge runge = {
        .x0 = on->x0, .v0 = on->v0, .sum_x = on->sum_x, .sum_v = on->sum_v};
    phys_vec *a = flow_force_room(call);
    fetch_own(t, on->spare_rim_x);
    fetch_own(t, on->spare_rim_v);
    fetch_rims(t, &view);
    flow_forces(call, t, &view, a);
    flow_part_ends(call, FLOW_FORCE);
    phys_accelerate(t->n, t->mass, t->free, a);
    flow_guides_filter(call, t, a);
    flow_part_ends(call, FLOW_ACCELERATION);
    phys_runge_stage(t->n, on->args->h, (int)on->args->stage, a, &runge, on->x, on->v);
    flow_write_rim(t, on->x, on->spare_rim_x);
    flow_write_rim(t, on->v, on->spare_rim_v);
    const int code = flow_check(call, t, on->x, "position", on->status);
    return code ? code : flow_check(call, t, on->v, "velocity", on->status);
}

int flow_runge_end(struct flow_state *state)
{
    static const double when[PHYS_RUNGE_STAGES] = {0, 0.5, 0.5, 1};
    int code = DUITE_OK;
    for (uint32_t stage = 0; stage < PHYS_RUNGE_STAGES && !code; stage++) {
        struct flow_args args = args_at(state, when[stage]);
        args.stage = stage;
        code = flow_fork_each(state, &flow_kernel_runge, &args);
        swap_rims(state);
    }
    return code;
}
