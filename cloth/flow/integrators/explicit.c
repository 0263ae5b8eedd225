/* Steps that solve nothing. Each begins and ends with x, v and their rims; what else an integrator
 * keeps from step to step is said with it. A task that finds forces reads its neighbours' rims and
 * moves its own rows at once: what the neighbours are to read next goes to spare rims, which are
 * the rims when all such tasks are forked. So no block waits for its neighbours to have seen it,
 * and forces do not leave the caches. */
#include "cloth/flow/tasks.h"

#include "cloth/physics/stage.h"

#include <stddef.h>

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

/* ---- Either Euler ---- */

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

/* Of a task that finds forces when so much of the step is over. */
static struct flow_args args_at(const struct flow_state *state, double part)
{
    struct flow_args args = flow_attempt_args(state);
    args.now = (args.begin + part * state->attempt.length) * state->flow->model->h / FLOW_TICKS;
    return args;
}

/* x and v by the forces at where they are: beside what is kept, or in its place. */
static int euler(struct flow_state *state)
{
    const bool keeps = flow_explicit_keeps(state->flow->model);
    const long *beside = FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(kept_x), FLOW_AT(kept_v),
                                      FLOW_AT(spare_rim_x), FLOW_AT(spare_rim_v));
    const long *here =
        FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(spare_rim_x), FLOW_AT(spare_rim_v));
    const int code =
        flow_fork_all(state, keeps ? &flow_euler_beside : &flow_euler, args_at(state, 0),
                      keeps ? beside : here, FLOW_THEN_STATUS, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
    swap_rims(state);
    if (keeps)
        swap_kept(state);
    return code;
}

/* ---- Velocity Verlet ---- */

/* f at x, v without the drag. */
static int fork_force(struct flow_state *state)
{
    return flow_fork_all(state, &flow_force_free, args_at(state, 0),
                         FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)), FLOW_NOTHING,
                         FLOW_RIM(rim_x), FLOW_RIM(rim_v));
}

/* f, without the drag, stays from step to step: what ends one begins the next, unless contact or
 * pins moved something in between, or the step was taken back. */
static int verlet(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_args args = args_at(state, 1);
    int code = flow_fork_all(state, &flow_verlet_first, args,
                             FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f), FLOW_AT(v0),
                                          FLOW_AT(rim_x), FLOW_AT(rim_v)),
                             FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = flow_fork_all(
            state, &flow_verlet_second, args,
            FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f), FLOW_AT(v0), FLOW_AT(spare_rim_v)),
            FLOW_THEN_STATUS, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
    swap_rims_v(state);
    state->settled_forces = !model->n_obstacles && !model_is_driven(model);
    return code;
}

/* ---- Runge-Kutta ---- */

static int runge(struct flow_state *state)
{
    static const double when[PHYS_RUNGE_STAGES] = {0, 0.5, 0.5, 1};
    int code = DUITE_OK;
    for (uint32_t stage = 0; stage < PHYS_RUNGE_STAGES && !code; stage++) {
        struct flow_args args = args_at(state, when[stage]);
        args.stage = stage;
        code = flow_fork_all(state, &flow_runge, args,
                             FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(x0), FLOW_AT(v0),
                                          FLOW_AT(sum_x), FLOW_AT(sum_v), FLOW_AT(spare_rim_x),
                                          FLOW_AT(spare_rim_v)),
                             FLOW_THEN_STATUS, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
        swap_rims(state);
    }
    return code;
}

int flow_explicit_begin(struct flow_state *state)
{
    const bool forces = state->flow->model->integrator == MODEL_VERLET && !state->settled_forces;
    return forces ? fork_force(state) : DUITE_OK;
}

int flow_explicit_end(struct flow_state *state)
{
    switch (state->flow->model->integrator) {
    case MODEL_VERLET:
        return verlet(state);
    case MODEL_RK4:
        return runge(state);
    default:
        return euler(state);
    }
}
