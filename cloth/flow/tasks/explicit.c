/* Steps that solve nothing. Each begins and ends with x, v and their rims; what else an integrator
 * keeps from step to step is said with it. */
#include "cloth/flow/tasks/tasks.h"

#include "cloth/physics/stage.h"

#include <stddef.h>

/* f at x, v: all forces, or those without the drag, when so much of the step is over. */
static int fork_force(struct flow_state *state, const duite_kernel *kernel, double part)
{
    struct flow_args args = flow_attempt_args(state);
    args.time = (args.begin + part * state->attempt.length) * state->flow->model->h / FLOW_TICKS;
    return flow_fork_all(state, kernel, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)),
                         FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
}

/* f becomes the acceleration. */
static int fork_acceleration(struct flow_state *state, double part)
{
    const int code = fork_force(state, &flow_force, part);
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

/* x and v by the forces at where they are. */
static int fork_move(struct flow_state *state)
{
    return flow_fork_all(
        state, &flow_move, flow_attempt_args(state),
        FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(x), FLOW_AT(v), FLOW_AT(rim_x), FLOW_AT(rim_v)),
        FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
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
        code = fork_force(state, &flow_force_free, 1);
    state->settled_forces = !model->n_planes && !model_is_driven(model);
    return code ? code
                : flow_fork_all(state, &flow_kick_second, args,
                                FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v0), FLOW_AT(v), FLOW_AT(rim_v)),
                                FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
}

static int runge(struct flow_state *state)
{
    static const double when[PHYS_RUNGE_STAGES] = {0, 0.5, 0.5, 1};
    struct flow_args args = flow_attempt_args(state);
    int code = DUITE_OK;
    for (; args.stage < PHYS_RUNGE_STAGES && !code; args.stage++) {
        code = args.stage > 0 ? fork_acceleration(state, when[args.stage]) : DUITE_OK;
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
    switch (state->flow->model->integrator) {
    case MODEL_RK4:
        return fork_acceleration(state, 0);
    case MODEL_VERLET:
        return state->settled_forces ? DUITE_OK : fork_force(state, &flow_force_free, 0);
    default:
        return fork_force(state, &flow_force, 0);
    }
}

int flow_explicit_end(struct flow_state *state)
{
    switch (state->flow->model->integrator) {
    case MODEL_VERLET:
        return verlet(state);
    case MODEL_RK4:
        return runge(state);
    default:
        return fork_move(state);
    }
}
