/* Conjugate gradients by tasks (Zara 2001), recorded once a run and replayed in each step until
 * their scalars say that they are done. A round is two passes (pass.c), which read the rims of s in
 * turn: the one that others still read is not the one that is written. A small task on every rank
 * makes the factors of the next pass of what all blocks summed; they are a shared object, so every
 * body reads the same bits and does the same. When the solve is done with the first pass of a
 * round, the second one does nothing.
 *
 * In reading order: a solve, its recorded round, the scalars. */
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/solver/solver.h"
#include "cloth/flow/step/step.h"

#include <math.h>

/* ---- A solve ---- */

/* dv of the step before, as it is in a step of this length. */
static double guess_of(const struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const double h = model->h * state->attempt.length / FLOW_TICKS;
    const bool wanted = model->guess == MODEL_GUESS_PREVIOUS ||
                        (model->guess == MODEL_GUESS_AUTO && h < MODEL_GUESS_BELOW);
    return wanted && state->guessed ? (double)state->attempt.length / state->guessed : 0;
}

/* Appends to refs what all passes of a round sum: their parts, or the sums. */
static size_t add_sums(struct flow_state *state, int from, size_t n)
{
    if (!flow_is_preconditioned(state->flow)) {
        state->refs[n++] = state->run.sums[from];
        return n;
    }
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        state->refs[n++] = state->block[b].part;
    return n;
}

/* The scalars before the first pass, and the coarse part of s that it begins with. */
static int fork_begin(struct flow_state *state, const struct flow_args *args)
{
    if (!flow_is_coarse(state->flow) || args->guess != 0)
        return DUITE_FORK(state->rt, &flow_begin, args, state->run.scalars[0]);
    state->refs[0] = state->run.scalars[0];
    state->refs[1] = state->run.motion[0];
    state->refs[2] = state->run.coarse;
    return duite_fork(state->rt, &flow_begin_coarse, args, add_sums(state, 0, 3), state->refs);
}

int flow_cg_start(struct flow_state *state)
{
    struct flow_args args = flow_attempt_args(state);
    args.guess = guess_of(state);
    int code = flow_coarse_start(state, args);
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        code = flow_preconditioner_factor(state, &args);
        if (!code)
            code = flow_pass_start(state, &args);
    }
    args.block = 0;
    return code ? code : fork_begin(state, &args);
}

int flow_cg_iterate(struct flow_state *state)
{
    const uint64_t passes = (uint64_t)state->flow->model->max_iterations + SOLVE_EXTRA;
    const uint64_t rounds = (passes + 1) / 2;
    const int code = duite_replay_while(state->rt, state->solve, state->run.scalars[0], rounds);
    return code ? code : flow_pieces_fork(state);
}

int flow_cg(struct flow_state *state)
{
    state->guessed = 0;
    const int code = flow_cg_start(state);
    return code ? code : flow_cg_iterate(state);
}

/* ---- Its recorded round ---- */

static int fork_scalars(struct flow_state *state, int from)
{
    const bool coarse = flow_is_coarse(state->flow);
    size_t n = 0;
    state->refs[n++] = state->run.scalars[1 - from];
    state->refs[n++] = state->run.scalars[from];
    if (coarse) {
        state->refs[n++] = state->run.motion[1 - from];
        state->refs[n++] = state->run.coarse;
    }
    return duite_fork(state->rt, coarse ? &flow_scalars_coarse : &flow_scalars, NULL,
                      add_sums(state, from, n), state->refs);
}

static int build(duite *rt, void *context)
{
    struct flow_state *state = context;
    int code = DUITE_OK;
    for (int from = 0; from < 2 && !code; from++) {
        if (!flow_is_preconditioned(state->flow))
            code = duite_set(rt, state->run.sums[from], NULL);
        if (!code)
            code = flow_pass_fork(state, from);
        if (!code)
            code = fork_scalars(state, from);
    }
    return code;
}

int flow_cg_record(struct flow_state *state)
{
    return duite_graph_new(state->rt, build, state, &state->solve);
}

/* ---- The scalars, on every rank ---- */

static struct solve_scalars scalars_before(const duite_call *call)
{
    const struct flow_args *args = flow_args_of(call);
    struct solve_scalars scalars =
        solve_scalars_start(args->begin, args->guess != 0 ? SOLVE_OPEN : SOLVE_ON);
    scalars.last = args->last;
    scalars.unit = flow_of(call)->inertia / (args->h * args->h);
    return scalars;
}

static int begin(const duite_call *call)
{
    *duite_out(call, 0, struct solve_scalars) = scalars_before(call);
    return 0;
}
const duite_kernel flow_begin = {.name = "cg_begin",
                                 .body = begin,
                                 .access = {DUITE_W},
                                 .args_size = sizeof(struct flow_args),
                                 .replicated = 1};

static int begin_coarse(const duite_call *call)
{
    *duite_out(call, 0, struct solve_scalars) = scalars_before(call);
    flow_coarse_motion(call, duite_in(call, 2, double), 3, duite_out(call, 1, double));
    return 0;
}
FLOW_TIMED(begin_coarse, FLOW_CG)
const duite_kernel flow_begin_coarse = {.name = "cg_begin_coarse",
                                        .body = begin_coarse_timed,
                                        .access = {DUITE_W, DUITE_W, DUITE_R},
                                        .variadic = DUITE_R,
                                        .args_size = sizeof(struct flow_args),
                                        .replicated = 1};

static struct solve_stop stop_of(const struct model *model)
{
    return (struct solve_stop){.count = model->stop == MODEL_STOP_COUNT,
                               .confirm = model->stop != MODEL_STOP_COUNT,
                               .relative = model->stop == MODEL_STOP_RELATIVE,
                               .mass_norm = model->stop == MODEL_STOP_MASS_NORM,
                               .normalised = model->stop == MODEL_STOP_NORMALISED,
                               .tolerance = model->tolerance,
                               .most = model->max_iterations};
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
        "step %.0f: conjugate gradients come to no residual below %g, begun anew %.0f "
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

/* What solve_scalars_next makes of these dots under the model's stop, or its failure: of what is
 * the same on every rank, the model too. */
static int next_scalars(const duite_call *call, const double dots[SOLVE_DOTS])
{
    const struct solve_stop stop = stop_of(flow_of(call)->model);
    struct solve_scalars *after = duite_out(call, 0, struct solve_scalars);
    const int outcome =
        solve_scalars_next(&stop, dots, duite_in(call, 1, struct solve_scalars), after);
    if (after->last == 0) /* the outcome goes on to the status of the step */
        return 0;
    if (outcome == SOLVE_NOT_CONVERGED)
        return not_converged(call, after);
    if (outcome == SOLVE_STALLED)
        return stalled(call, after);
    return outcome == SOLVE_BREAKDOWN ? broken_down(call, after) : 0;
}

/* The dots of all blocks, of what parameters `from` on have. */
static void add_dots(const duite_call *call, size_t from, double dots[SOLVE_DOTS])
{
    const size_t n = flow_dots(flow_of(call));
    for (size_t k = from; k < call->n_params; k++) {
        const double *part = duite_in(call, k, double);
        for (size_t i = 0; i < n; i++)
            dots[i] += part[i];
    }
    if (!flow_is_preconditioned(flow_of(call)))
        dots[SOLVE_RZ] = dots[SOLVE_RR];
}

static int scalars(const duite_call *call)
{
    double dots[SOLVE_DOTS] = {0};
    add_dots(call, 2, dots);
    return next_scalars(call, dots);
}
FLOW_TIMED(scalars, FLOW_CG)
const duite_kernel flow_scalars = {.name = "cg_scalars",
                                   .body = scalars_timed,
                                   .access = {DUITE_W, DUITE_R},
                                   .variadic = DUITE_R,
                                   .replicated = 1};

/* With a coarse part: the motion that belongs to the q of the pass, if that made a new one. */
static int scalars_coarse(const duite_call *call)
{
    const double phase = duite_in(call, 1, struct solve_scalars)->phase;
    double dots[SOLVE_DOTS] = {0}, *motion = duite_out(call, 2, double);
    add_dots(call, 4, dots);
    if (phase == SOLVE_ON || phase == SOLVE_AGAIN)
        dots[SOLVE_QQ] += flow_coarse_motion(call, duite_in(call, 3, double), 4, motion);
    else
        memset(motion, 0, flow_motion_doubles(flow_of(call)) * sizeof *motion);
    return next_scalars(call, dots);
}
FLOW_TIMED(scalars_coarse, FLOW_CG)
const duite_kernel flow_scalars_coarse = {.name = "cg_scalars_coarse",
                                          .body = scalars_coarse_timed,
                                          .access = {DUITE_W, DUITE_R, DUITE_W, DUITE_R},
                                          .variadic = DUITE_R,
                                          .replicated = 1};
