/* Steps that solve nothing. Each begins and ends with x, v and their rims; what else an integrator
 * keeps from step to step is said with it. */
#include "cloth/flow/tasks/tasks.h"

#include "cloth/physics/stage.h"

#include <stddef.h>

static struct flow_args args_of(uint64_t step)
{
    return (struct flow_args){.step = (uint32_t)step};
}

/* f at x, v: all forces, or those without the drag. */
static int fork_force(struct flow_state *state, uint64_t step, const duite_kernel *kernel)
{
    return flow_fork_all(state, kernel, args_of(step),
                         FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)), FLOW_NOTHING,
                         FLOW_RIM(rim_x), FLOW_RIM(rim_v));
}

/* f becomes the acceleration. */
static int fork_acceleration(struct flow_state *state, uint64_t step)
{
    const int code = fork_force(state, step, &flow_force);
    return code ? code
                : flow_fork_all(state, &flow_explicit, args_of(step), FLOW_OBJECTS(FLOW_AT(f)),
                                FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
}

/* x += h v, by the velocity at an offset. */
static int fork_position(struct flow_state *state, uint64_t step, long v)
{
    return flow_fork_all(state, &flow_position, args_of(step),
                         FLOW_OBJECTS(v, FLOW_AT(x), FLOW_AT(rim_x)), FLOW_THEN_STATUS, FLOW_NO_RIM,
                         FLOW_NO_RIM);
}

/* v += h a. */
static int fork_velocity(struct flow_state *state, uint64_t step)
{
    return flow_fork_all(state, &flow_velocity_a, args_of(step),
                         FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v), FLOW_AT(rim_v)), FLOW_THEN_STATUS,
                         FLOW_NO_RIM, FLOW_NO_RIM);
}

/* The status of the step before, when this one is under way. */
static int look_back(struct flow_state *state, uint64_t step)
{
    return step > 0 ? flow_step_status(state, step - 1) : DUITE_OK;
}

static int euler(struct flow_state *state, uint64_t step)
{
    int code = fork_acceleration(state, step);
    if (!code)
        code = look_back(state, step);
    if (!code)
        code = fork_position(state, step, FLOW_AT(v));
    return code ? code : fork_velocity(state, step);
}

static int symplectic(struct flow_state *state, uint64_t step)
{
    int code = fork_acceleration(state, step);
    if (!code)
        code = look_back(state, step);
    if (!code)
        code = fork_velocity(state, step);
    return code ? code : fork_position(state, step, FLOW_AT(v));
}

/* f, without the drag, stays from step to step: what ends one begins the next, unless contact or
 * pins moved something in between. */
static int verlet(struct flow_state *state, uint64_t step)
{
    const struct model *model = state->flow->model;
    const bool stale = step == 0 || model->n_planes || model->n_motions;
    int code = stale ? fork_force(state, step, &flow_force_free) : DUITE_OK;
    if (!code)
        code = flow_fork_all(state, &flow_kick_first, args_of(step),
                             FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v), FLOW_AT(rim_v), FLOW_AT(v0)),
                             FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = look_back(state, step);
    if (!code)
        code = fork_position(state, step, FLOW_AT(v0));
    if (!code)
        code = fork_force(state, step, &flow_force_free);
    return code ? code
                : flow_fork_all(state, &flow_kick_second, args_of(step),
                                FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(v0), FLOW_AT(v), FLOW_AT(rim_v)),
                                FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
}

static int runge(struct flow_state *state, uint64_t step)
{
    struct flow_args args = args_of(step);
    int code = DUITE_OK;
    for (; args.stage < PHYS_RUNGE_STAGES && !code; args.stage++) {
        code = fork_acceleration(state, step);
        if (!code && args.stage == 0)
            code = look_back(state, step);
        if (!code)
            code = flow_fork_all(state, &flow_runge, args,
                                 FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(x), FLOW_AT(v), FLOW_AT(x0),
                                              FLOW_AT(v0), FLOW_AT(sum_x), FLOW_AT(sum_v),
                                              FLOW_AT(rim_x), FLOW_AT(rim_v)),
                                 FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
    }
    return code;
}

int flow_step_explicit(struct flow_state *state, uint64_t step)
{
    switch (state->flow->model->integrator) {
    case MODEL_SYMPLECTIC_EULER:
        return symplectic(state, step);
    case MODEL_VERLET:
        return verlet(state, step);
    case MODEL_RK4:
        return runge(state, step);
    default:
        return euler(state, step);
    }
}
