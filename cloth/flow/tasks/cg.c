/* Conjugate gradients by tasks (Zara 2001). While the main program waits for r.r of an iteration,
 * the direction and the matvec of the next are forked already: workers have work, and what is too
 * much at the end is thrown away. dv and r change in `update` only, so the result does not depend
 * on how far ahead the program runs. */
#include "cloth/flow/tasks/tasks.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

static uint32_t n_blocks(const struct flow_state *state)
{
    return state->flow->tables.n_blocks;
}

static int zero(struct flow_state *state, duite_object scalar)
{
    const double nothing = 0;
    return duite_set(state->rt, scalar, &nothing);
}

static int fork_start(struct flow_state *state, struct flow_args args)
{
    int code = zero(state, state->rho[0]);
    for (args.block = 0; args.block < n_blocks(state) && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_start, &args, 6,
                         (duite_object[]){o->f, o->dv, o->r, o->p, o->rim_p, state->rho[0]},
                         FLOW_NO_RIM, FLOW_NO_RIM);
    }
    return code;
}

static int fork_matvec(struct flow_state *state, struct flow_args args, uint64_t iteration)
{
    const duite_object pq = state->pq[iteration % 2];
    int code = zero(state, pq);
    for (args.block = 0; args.block < n_blocks(state) && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_matvec, &args, 4, (duite_object[]){o->p, o->a, o->q, pq},
                         offsetof(struct flow_objects, rim_p), FLOW_NO_RIM);
    }
    return code;
}

static int fork_update(struct flow_state *state, struct flow_args args, uint64_t iteration)
{
    const duite_object pq = state->pq[iteration % 2];
    const duite_object rho = state->rho[iteration % 2], next = state->rho[(iteration + 1) % 2];
    int code = zero(state, next);
    for (args.block = 0; args.block < n_blocks(state) && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_update, &args, 7,
                         (duite_object[]){pq, rho, o->p, o->q, o->dv, o->r, next}, FLOW_NO_RIM,
                         FLOW_NO_RIM);
    }
    return code;
}

static int fork_direction(struct flow_state *state, struct flow_args args, uint64_t iteration)
{
    const duite_object rho = state->rho[iteration % 2], next = state->rho[(iteration + 1) % 2];
    int code = DUITE_OK;
    for (args.block = 0; args.block < n_blocks(state) && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code =
            flow_fork(state, &flow_direction, &args, 5,
                      (duite_object[]){next, rho, o->r, o->p, o->rim_p}, FLOW_NO_RIM, FLOW_NO_RIM);
    }
    return code;
}

/* The square of the residual at which to stop, from that at the start. */
static double goal(const struct model *model, double rho)
{
    const double square = model->tolerance * model->tolerance;
    return model->stop == MODEL_STOP_RELATIVE ? square * rho : square;
}

static int not_converged(struct flow_state *state, uint64_t step, double rho, double wanted)
{
    snprintf(state->text, sizeof state->text,
             "step %llu: conjugate gradients stopped at a residual of %g after %u iterations, %g "
             "was asked for; "
             "allow more iterations, a larger tolerance or a smaller h",
             (unsigned long long)step + 1, sqrt(rho), state->flow->model->max_iterations,
             sqrt(wanted));
    return FLOW_NOT_CONVERGED;
}

/* What is not a number is not small: the next iteration's update fails on it. The square of a small
 * tolerance may be zero: then nothing is small enough. */
static bool small_enough(double rho, double wanted)
{
    return isfinite(rho) && (rho <= wanted || rho < FLOW_NOTHING);
}

/* Exactly so many iterations, without a look at the residual. */
static int iterate_count(struct flow_state *state, struct flow_args args)
{
    const uint64_t count = state->flow->model->max_iterations;
    int code = DUITE_OK;
    for (uint64_t i = 0; i < count && !code; i++) {
        code = fork_matvec(state, args, i);
        if (!code)
            code = fork_update(state, args, i);
        if (!code && i + 1 < count)
            code = fork_direction(state, args, i);
    }
    state->iterations = count;
    return code;
}

/* Until the residual is small enough. The matvec of the first iteration is forked here, the others
 * one ahead. */
static int iterate(struct flow_state *state, struct flow_args args, uint64_t step)
{
    const uint64_t most = state->flow->model->max_iterations;
    double rho = 0;
    int code = fork_matvec(state, args, 0);
    if (!code)
        code = duite_get(state->rt, state->rho[0], &rho);
    const double wanted = goal(state->flow->model, rho);
    uint64_t i = 0;
    for (; !code && !small_enough(rho, wanted) && i < most; i++) {
        code = fork_update(state, args, i);
        if (!code)
            code = fork_direction(state, args, i);
        if (!code)
            code = fork_matvec(state, args, i + 1);
        if (!code)
            code = duite_get(state->rt, state->rho[(i + 1) % 2], &rho);
    }
    state->iterations = i;
    return !code && !small_enough(rho, wanted) ? not_converged(state, step, rho, wanted) : code;
}

int flow_cg(struct flow_state *state, uint64_t step)
{
    const struct flow_args args = {.step = (uint32_t)step};
    int code = fork_start(state, args);
    if (!code && step > 0)
        code = flow_step_status(state, step - 1);
    if (!code)
        code = state->flow->model->stop == MODEL_STOP_COUNT ? iterate_count(state, args)
                                                            : iterate(state, args, step);
    return code;
}
