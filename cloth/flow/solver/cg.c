/* Conjugate gradients by tasks (Zara 2001), recorded once a run and replayed in each step until
 * their scalars say that they are done. A round is two passes (pass.c), which read the halos of s
 * in turn, so a pass never writes the halo that others still read. A small task on every rank makes
 * the next pass's factors from the sums of all blocks; they are a shared object, so every body
 * reads the same bits and does the same. If the solve is done with the first pass of a round, the
 * second does nothing.
 *
 * In reading order: a solve, its recorded round, the scalars. */
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"

#include <math.h>

/* ---- A solve ---- */

/* The factor of the last step's dv that fits a step of this length; 0: no guess. */
static double guess_of(const struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const double h = model->h * state->attempt.length / FLOW_TICKS;
    const bool wanted = model->guess == MODEL_GUESS_PREVIOUS ||
                        (model->guess == MODEL_GUESS_AUTO && h < MODEL_GUESS_BELOW);
    return wanted && state->guessed ? (double)state->attempt.length / state->guessed : 0;
}

/* Arguments of the tasks that make the scalars before the first pass. */
struct begin_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    double phase; /* the first one of the solve */
};

/* Forks the scalars before the first pass, and the coarse part of s that it begins with. */
static int solver_cg_fork_begin(struct flow_state *state, bool guess)
{
    const struct begin_args args = {.step = flow_attempt_args(state),
                                    .phase = guess ? SOLVE_OPEN : SOLVE_ON};
    flow_fork_one(state, &flow_kernel_cg_begin, &args);
    if (guess || !state->flow->conditioner.coarse)
        return state->code;
    flow_levels_solve(state);
    return flow_levels_fork_top(state, &flow_kernel_cg_motion, &(struct flow_block_args){0}, false);
}

/* The number of blocks whose two tasks are forked together: the second still finds the data of the
 * first in caches. */
enum { BLOCKS_TOGETHER = 4 * FLOW_FORKS_AHEAD };

int flow_cg_start(struct flow_state *state)
{
    const uint32_t n_blocks = state->flow->tables.n_blocks;
    const double guess = guess_of(state);
    flow_coarse_start(state);
    for (uint32_t first = 0; first < n_blocks; first += BLOCKS_TOGETHER) {
        const uint32_t left = n_blocks - first;
        const uint32_t end = first + (left < BLOCKS_TOGETHER ? left : BLOCKS_TOGETHER);
        flow_pass_factor(state, first, end);
        flow_pass_start(state, first, end, guess);
    }
    return solver_cg_fork_begin(state, guess != 0);
}

int flow_cg_iterate(struct flow_state *state)
{
    const uint64_t passes = (uint64_t)state->flow->model->max_iterations + SOLVE_EXTRA;
    const uint64_t rounds = (passes + 1) / 2;
    if (!state->code)
        flow_noted(state,
                   duite_replay_while(state->rt, state->solve, state->run.scalars[0], rounds));
    return flow_pieces_fork(state);
}

int flow_cg(struct flow_state *state)
{
    state->guessed = 0;
    flow_cg_start(state);
    return flow_cg_iterate(state);
}

/* ---- Its recorded round ---- */

static int build_round(duite *rt, void *context)
{
    const struct flow_block_args args = {0};
    struct flow_state *state = context;
    (void)rt;
    for (state->pass = 0; state->pass < 2; state->pass++) {
        if (!flow_is_preconditioned(state->flow))
            flow_set(state, FLOW_FIELD_sums, NULL);
        flow_pass_fork(state);
        flow_levels_solve(state);
        flow_levels_fork_top(state, &flow_kernel_cg_scalars, &args, false);
    }
    state->pass = 0;
    return state->code;
}

int flow_cg_record(struct flow_state *state)
{
    return flow_noted(state, duite_graph_new(state->rt, build_round, state, &state->solve));
}

/* ---- The scalars, on every rank ---- */

FLOW_KERNEL_WITH(cg_begin, FLOW_NO_PART, struct begin_args, (W(scalars)), .replicated = 1)
{
    const struct flow_step_args *step = &on->args->step;
    *on->scalars = solve_scalars_start(step->begin, on->args->phase);
    on->scalars->last = step->last;
    on->scalars->unit = flow_of(call)->inertia / (step->h * step->h);
    return 0;
}

FLOW_KERNEL_WITH(cg_motion, FLOW_CG, struct flow_block_args, (W(motion), R(coarse), ALL(part)),
                 .replicated = 1)
{
    flow_coarse_motion(flow_of(call), on->coarse, on->part, on->motion);
    return 0;
}

static struct solve_stop stop_of(const struct model *model)
{
    return (struct solve_stop){.count = model->stop == MODEL_STOP_COUNT,
                               .confirm = model->stop != MODEL_STOP_COUNT,
                               .relative = model->stop == MODEL_STOP_RELATIVE,
                               .mass_norm = model->stop == MODEL_STOP_MASS_NORM,
                               .normalised = model->stop == MODEL_STOP_NORMALISED,
                               .tolerance = model->tolerance,
                               .max = model->max_iterations};
}

static int not_converged(const duite_call *call, const struct solve_scalars *now)
{
    const struct model *model = flow_of(call)->model;
    const char *what = "a residual";
    double left = sqrt(now->square), wanted = sqrt(now->wanted);
    if (model_stops_by_norms(model))
        wanted = model->tolerance;
    if (model->stop == MODEL_STOP_NORMALISED) {
        what = "a normalised residual";
        left = sqrt(now->bound / now->unit);
    } else if (model->stop == MODEL_STOP_MASS_NORM) {
        what = "an error of dv";
        left = sqrt(solve_scalars_error(now, now->bound) / now->size);
    }
    return duite_fail(
        call, FLOW_NOT_CONVERGED,
        "step %.0f: conjugate gradients stopped at %s of %g after %.0f iterations, %g was "
        "asked for; allow more iterations, a larger tolerance or a smaller h",
        flow_step_number(now->step), what, left, solve_scalars_iterations(now), wanted);
}

static int stalled(const duite_call *call, const struct solve_scalars *now)
{
    return duite_fail(
        call, FLOW_NOT_CONVERGED,
        "step %.0f: conjugate gradients come to no residual below %g, begun again %.0f "
        "times: that is what rounding leaves of this matrix; allow a larger "
        "tolerance, or take a smaller h or softer materials",
        flow_step_number(now->step), sqrt(now->square), now->restarts);
}

static int broken_down(const duite_call *call, const struct solve_scalars *now)
{
    return duite_fail(call, FLOW_INDEFINITE,
                      "step %.0f: conjugate gradients broke down (p.Ap = %g, r.r = %g): the "
                      "matrix is not positive definite, or forces are beyond all measure",
                      flow_step_number(now->step), now->curvature, now->square);
}

/* Makes the next scalars from these dots and the model's stop, or fails. Uses only values that are
 * equal on all ranks. */
static int next_scalars(const duite_call *call, const double dots[SOLVE_DOTS],
                        const struct solve_scalars *before, struct solve_scalars *after)
{
    const struct solve_stop stop = stop_of(flow_of(call)->model);
    const int outcome = solve_scalars_next(&stop, dots, before, after);
    if (after->last == 0) /* the outcome goes on to the status of the step */
        return 0;
    if (outcome == SOLVE_NOT_CONVERGED)
        return not_converged(call, after);
    if (outcome == SOLVE_STALLED)
        return stalled(call, after);
    return outcome == SOLVE_BREAKDOWN ? broken_down(call, after) : 0;
}

FLOW_KERNEL_IF(cg_scalars, motion_next, FLOW_CG, struct flow_block_args,
               (W(scalars_next), R(scalars), W_IF(motion_next), IF_MADE(sums), IF_MADE(coarse),
                ALL(part)),
               .replicated = 1);

/* The dots of all blocks, which groups have summed if there are levels. */
static void solver_cg_add_parts(const struct flow *flow, const duite_param *part,
                                double dots[SOLVE_DOTS])
{
    for (uint32_t b = 0; b < flow_parts(flow); b++)
        for (int i = 0; i < SOLVE_DOTS; i++)
            dots[i] += flow_numbers_of(part, b)[i];
}

/* The coarse part: the motion that belongs to the q of the pass, if that made a new one. Returns
 * its share in q.s. */
static double move_patches(const struct flow *flow, const struct cg_scalars_fields *on)
{
    if (flow_coarse_moves(on->scalars))
        return flow_coarse_motion(flow, on->coarse, on->part, on->motion_next);
    memset(on->motion_next, 0, flow_motion_doubles(flow) * sizeof *on->motion_next);
    return 0;
}

static int cg_scalars_body(const duite_call *call, const struct cg_scalars_fields *on)
{
    const struct flow *flow = flow_of(call);
    double dots[SOLVE_DOTS] = {0};
    if (on->sums) {
        memcpy(dots, on->sums, flow_dots(flow) * sizeof *dots);
        dots[SOLVE_RZ] = dots[SOLVE_RR];
    } else {
        solver_cg_add_parts(flow, on->part, dots);
    }
    if (on->motion_next)
        dots[SOLVE_QQ] += move_patches(flow, on);
    return next_scalars(call, dots, on->scalars, on->scalars_next);
}
