/* Steps that solve nothing. Each begins and ends with x, v and their rims; what else an integrator
 * keeps from step to step is said with it. */
#include "cloth/flow/tasks/tasks.h"

#include "cloth/physics/stage.h"

#include <stddef.h>

/* f at x, v: all forces, or those without the drag. */
static int fork_force(struct flow_state *state, const duite_kernel *kernel)
{
    return flow_fork_all(state, kernel, flow_attempt_args(state),
                         FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)), FLOW_NOTHING,
                         FLOW_RIM(rim_x), FLOW_RIM(rim_v));
}

/* f becomes the acceleration. */
static int fork_acceleration(struct flow_state *state)
{
    const int code = fork_force(state, &flow_force);
    return code ? code
                : flow_fork_all(state, &flow_explicit, flow_attempt_args(state),
                                FLOW_OBJECTS(FLOW_AT(f)), FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
}

/* x += h v, by the velocity at an offset. */
static int fork_position(struct flow_state *state, long v)
{
    return flow_fork_all(state, &flow_position, flow_attempt_args(state),
                         FLOW_OBJECTS(v, FLOW_AT(x), FLOW_AT(rim_x)), FLOW_THEN_STATUS, FLOW_NO_RIM,
                         FLOW_NO_RIM);
}

/* v += h a. */
static int fork_velocity(struct flow_state *state)
{
    return flow_fork_all(state, &flow_velocity_a, flow_attempt_args(state),
                         FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v), FLOW_AT(rim_v)), FLOW_THEN_STATUS,
                         FLOW_NO_RIM, FLOW_NO_RIM);
}

static int euler(struct flow_state *state)
{
    const int code = fork_position(state, FLOW_AT(v));
    return code ? code : fork_velocity(state);
}

static int symplectic(struct flow_state *state)
{
    const int code = fork_velocity(state);
    return code ? code : fork_position(state, FLOW_AT(v));
}

/* f, without the drag, stays from step to step: what ends one begins the next, unless contact or
 * pins moved something in between, or the step was taken back. */
static int verlet(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_args args = flow_attempt_args(state);
    int code = flow_fork_all(state, &flow_kick_first, args,
                             FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v), FLOW_AT(rim_v), FLOW_AT(v0)),
                             FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = fork_position(state, FLOW_AT(v0));
    if (!code)
        code = fork_force(state, &flow_force_free);
    state->settled_forces = !model->n_planes && !model_is_driven(model);
    return code ? code
                : flow_fork_all(state, &flow_kick_second, args,
                                FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v0), FLOW_AT(v), FLOW_AT(rim_v)),
                                FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
}

static int runge(struct flow_state *state)
{
    struct flow_args args = flow_attempt_args(state);
    int code = DUITE_OK;
    for (; args.stage < PHYS_RUNGE_STAGES && !code; args.stage++) {
        code = args.stage > 0 ? fork_acceleration(state) : DUITE_OK;
        if (!code)
            code = flow_fork_all(state, &flow_runge, args,
                                 FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(x), FLOW_AT(v), FLOW_AT(x0),
                                              FLOW_AT(v0), FLOW_AT(sum_x), FLOW_AT(sum_v),
                                              FLOW_AT(rim_x), FLOW_AT(rim_v)),
                                 FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
    }
    return code;
}

int flow_explicit_begin(struct flow_state *state)
{
    if (state->flow->model->integrator != MODEL_VERLET)
        return fork_acceleration(state);
    return state->settled_forces ? DUITE_OK : fork_force(state, &flow_force_free);
}

int flow_explicit_end(struct flow_state *state)
{
    switch (state->flow->model->integrator) {
    case MODEL_SYMPLECTIC_EULER:
        return symplectic(state);
    case MODEL_VERLET:
        return verlet(state);
    case MODEL_RK4:
        return runge(state);
    default:
        return euler(state);
    }
}
