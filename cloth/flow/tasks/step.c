/* A step is forked whole while the one before it may still run; the main program looks at the
 * status of a step when the next one is under way. Explicit: f, a, x += h v, v += h a. Implicit: f,
 * b, A, dv, v += dv, x += h v. */
#include "cloth/flow/tasks/tasks.h"

#include <math.h>
#include <stddef.h>

#define RIM_X offsetof(struct flow_objects, rim_x)
#define RIM_V offsetof(struct flow_objects, rim_v)

/* What follows the objects of a block: nothing, the status of the step, or before it the scalars of
 * a solve. */
enum behind { NOTHING, STATUS, SCALARS_AND_STATUS };

/* Forks one kernel on every block. `objects` of a block are picked by their offsets, ended by -1.
 */
static int fork_all(struct flow_state *state, const duite_kernel *kernel, uint64_t step,
                    const long *offsets, enum behind behind, long rim, long rim2)
{
    struct flow_args args = {.step = (uint32_t)step};
    int code = DUITE_OK;
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        duite_object objects[DUITE_MAX_ACCESS];
        size_t n = 0;
        for (; offsets[n] >= 0; n++)
            objects[n] =
                *(const duite_object *)(const void *)((const char *)(state->block + args.block) +
                                                      offsets[n]);
        if (behind == SCALARS_AND_STATUS)
            objects[n++] = state->scalars[0];
        if (behind != NOTHING)
            objects[n++] = state->status[step % 2];
        code = flow_fork(state, kernel, &args, n, objects, rim, rim2);
    }
    return code;
}

/* The objects of a block, by name. */
#define AT(name)     (long)offsetof(struct flow_objects, name)
#define OBJECTS(...) ((const long[]){__VA_ARGS__, -1})

int flow_initialise(struct flow_state *state)
{
    const int code = fork_all(state, &flow_initial, 0, OBJECTS(AT(x), AT(v), AT(rim_x), AT(rim_v)),
                              NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    return code ? code : flow_turned_initialise(state);
}

static int step_explicit(struct flow_state *state, uint64_t step)
{
    int code =
        fork_all(state, &flow_explicit, step, OBJECTS(AT(f)), NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code && step > 0)
        code = flow_step_status(state, step - 1);
    if (!code)
        code = fork_all(state, &flow_position, step, OBJECTS(AT(v), AT(x), AT(rim_x)), STATUS,
                        FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = fork_all(state, &flow_velocity_a, step, OBJECTS(AT(f), AT(v), AT(rim_v)), STATUS,
                        FLOW_NO_RIM, FLOW_NO_RIM);
    return code;
}

static int step_implicit(struct flow_state *state, uint64_t step)
{
    int code =
        fork_all(state, &flow_implicit, step, OBJECTS(AT(x), AT(v), AT(f)), NOTHING, RIM_X, RIM_V);
    if (!code)
        code =
            fork_all(state, &flow_matrix, step, OBJECTS(AT(x), AT(a)), NOTHING, RIM_X, FLOW_NO_RIM);
    if (!code)
        code = flow_cg(state, step);
    if (!code)
        code = fork_all(state, &flow_velocity_dv, step,
                        OBJECTS(AT(f), AT(a), AT(dv), AT(r), AT(v), AT(rim_v)), SCALARS_AND_STATUS,
                        FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = fork_all(state, &flow_position, step, OBJECTS(AT(v), AT(x), AT(rim_x)), STATUS,
                        FLOW_NO_RIM, FLOW_NO_RIM);
    return code;
}

int flow_step(struct flow_state *state, uint64_t step)
{
    const struct model *model = state->flow->model;
    const double nothing[FLOW_STATUS] = {0};
    int code = duite_set(state->rt, state->status[step % 2], nothing);
    if (!code)
        code =
            fork_all(state, &flow_force, step, OBJECTS(AT(x), AT(v), AT(f)), NOTHING, RIM_X, RIM_V);
    if (!code)
        code = model->integrator == MODEL_EXPLICIT_EULER ? step_explicit(state, step)
                                                         : step_implicit(state, step);
    if (!code && model->n_planes)
        code = fork_all(state, &flow_collide, step, OBJECTS(AT(x), AT(v), AT(rim_x), AT(rim_v)),
                        NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    const struct flow_args args = {.step = (uint32_t)step};
    if (!code)
        code = duite_fork_at(state->rt, 0, &flow_status, &args, 1, &state->status[step % 2]);
    return code;
}

/* Shows a finished step to the program and asks it whether to go on; on rank 0. */
static void tell_progress(struct flow_state *state, uint64_t step, uint64_t iterations)
{
    const struct flow_progress *progress = state->progress;
    if (!progress || duite_rank(state->rt))
        return;
    if (progress->step)
        progress->step(progress->context, step + 1, state->flow->n_steps, iterations);
    if (progress->stop && progress->stop(progress->context))
        atomic_store_explicit(&state->flow->stop, 1, memory_order_relaxed);
}

int flow_step_status(struct flow_state *state, uint64_t step)
{
    double status[FLOW_STATUS];
    const int code = duite_get(state->rt, state->status[step % 2], status);
    if (code)
        return code;
    struct flow_report *report = state->report;
    const double *lost = status + FLOW_LOST;
    const double momentum = sqrt(lost[0] * lost[0] + lost[1] * lost[1] + lost[2] * lost[2]);
    const uint64_t iterations = (uint64_t)status[FLOW_ITERATIONS];
    report->steps = step + 1;
    report->cg_iterations_total += iterations;
    if (iterations > report->cg_iterations_max)
        report->cg_iterations_max = iterations;
    if (momentum > report->momentum_lost)
        report->momentum_lost = momentum;
    const double error = sqrt(fmin(status[FLOW_ERROR], status[FLOW_RESIDUAL]) / status[FLOW_SIZE]);
    if (status[FLOW_SIZE] > 0 && error > report->mass_norm_error)
        report->mass_norm_error = error;
    report->factors_shifted += (uint64_t)status[FLOW_SHIFTED];
    state->stopping = state->stopping || status[FLOW_STOP] > 0;
    tell_progress(state, step, iterations);
    return DUITE_OK;
}
