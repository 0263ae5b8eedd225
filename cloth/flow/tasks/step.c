/* A step is forked whole while the one before it may still run; the main program looks at the
 * status of a step when the next one is under way. Implicit: f, b, A, dv, v += dv, x += h v. */
#include "cloth/flow/tasks/tasks.h"

#include <math.h>
#include <stddef.h>

int flow_fork_all(struct flow_state *state, const duite_kernel *kernel, struct flow_args args,
                  const long *objects, enum flow_behind behind, long rim, long rim2)
{
    int code = DUITE_OK;
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        duite_object own[DUITE_MAX_ACCESS];
        size_t n = 0;
        for (; objects[n] >= 0; n++)
            own[n] =
                *(const duite_object *)(const void *)((const char *)(state->block + args.block) +
                                                      objects[n]);
        if (behind == FLOW_THEN_SCALARS_AND_STATUS)
            own[n++] = state->scalars[0];
        if (behind != FLOW_NOTHING)
            own[n++] = state->status[args.step % 2];
        code = flow_fork(state, kernel, &args, n, own, rim, rim2);
    }
    return code;
}

int flow_initialise(struct flow_state *state)
{
    const int code =
        flow_fork_all(state, &flow_initial, (struct flow_args){0},
                      FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(rim_x), FLOW_AT(rim_v)),
                      FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    return code ? code : flow_turned_initialise(state);
}

static int step_implicit(struct flow_state *state, uint64_t step)
{
    const struct flow_args args = {.step = (uint32_t)step};
    int code =
        flow_fork_all(state, &flow_force, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)),
                      FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
    if (!code)
        code = flow_fork_all(state, &flow_implicit, args,
                             FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)), FLOW_NOTHING,
                             FLOW_RIM(rim_x), FLOW_RIM(rim_v));
    if (!code)
        code = flow_fork_all(state, &flow_matrix, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(a)),
                             FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_NO_RIM);
    if (!code)
        code = flow_cg(state, step);
    if (!code)
        code = flow_fork_all(state, &flow_velocity_dv, args,
                             FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(a), FLOW_AT(dv), FLOW_AT(r),
                                          FLOW_AT(v), FLOW_AT(rim_v)),
                             FLOW_THEN_SCALARS_AND_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = flow_fork_all(state, &flow_position, args,
                             FLOW_OBJECTS(FLOW_AT(v), FLOW_AT(x), FLOW_AT(rim_x)), FLOW_THEN_STATUS,
                             FLOW_NO_RIM, FLOW_NO_RIM);
    return code;
}

int flow_step(struct flow_state *state, uint64_t step)
{
    const struct model *model = state->flow->model;
    const struct flow_args args = {.step = (uint32_t)step};
    const double nothing[FLOW_STATUS] = {0};
    int code = duite_set(state->rt, state->status[step % 2], nothing);
    if (!code)
        code = flow_pins_drive(state, step);
    if (!code)
        code =
            model_is_implicit(model) ? step_implicit(state, step) : flow_step_explicit(state, step);
    if (!code)
        code = flow_pins_place(state, step);
    if (!code && model->n_planes)
        code = flow_fork_all(state, &flow_collide, args,
                             FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(rim_x), FLOW_AT(rim_v)),
                             FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
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
