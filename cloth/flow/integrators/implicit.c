/* Steps that solve a linear system, or several. One Newton step of implicit Euler is forked whole.
 * With more of them the main program checks each: was it the last, did it go too far? BDF2 needs to
 * know how the step before ended, so all of its step comes after that. The recorded round of
 * conjugate gradients serves all solves. */
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/solve.h"

#include "cloth/physics/particle.h"

static const double OVERSHOT = 0.5; /* of the slope at the begin of a Newton step, and uphill */
static const double LEAST_CUT = 0.1;
enum { MAX_CUTS = 8 };

static bool searches(const struct model *model)
{
    return model_is_implicit(model) && model->newton_steps > 1;
}

/* ---- Parts of a step ---- */

static int fork_force(struct flow_state *state, struct flow_step_args args)
{
    return flow_fork_each(state, &flow_kernel_force, &args);
}

/* The matrix at x where f is the right side, and the solve's begin. */
static int fork_system(struct flow_state *state, struct flow_step_args args)
{
    flow_fork_each(state, &flow_kernel_matrix, &args);
    if (model_is_filtered(state->flow->model))
        flow_contact_constrain(state);
    return flow_cg_start(state);
}

/* A filtered solve makes forces, filter and matrix in separate tasks. */
int flow_assemble(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    if (!model_is_filtered(state->flow->model))
        return flow_fork_each(state, &flow_kernel_system, &args);
    fork_force(state, args);
    flow_contact_filter(state, args);
    flow_fork_each(state, &flow_kernel_system_of_forces, &args);
    return flow_contact_constrain(state);
}

/* ---- One linear step: v += dv, x += h v ---- */

/* The result of a solve for a block. */
struct solved {
    const void *value; /* of the matrix */
    const phys_vec *b, *dv, *r;
    const struct solve_scalars *scalars;
    const double *factor;           /* NULL: there is no preconditioner */
    const unsigned char *tie_table; /* NULL: the run has no ties */
};

/* The loss of a filtered solve: entries to held and to filtered rows do not cancel. */
static void sum_rows(size_t n, const phys_vec *r, double sum[3])
{
    for (size_t a = 0; a < n; a++)
        for (int c = 0; c < 3; c++)
            sum[c] += r[a][c];
}

/* The loss of a solve. */
static void note_lost(const struct flow_table *t, const struct solved *solved, double lost[3])
{
    solve_lost(&t->matrix, &t->held, solved->value, solved->b, solved->dv, lost);
    flow_ties_lost(solved->tie_table, flow_tie_values(t, solved->value), solved->dv, lost);
}

/* Notes a solve in the status: its iterations and restarts, its error, the momentum that it lost,
 * shifts of its factor, its failure. */
static void note_solve(const duite_call *call, const struct flow_table *t,
                       const struct solved *solved, double *status)
{
    const struct solve_scalars *scalars = solved->scalars;
    if (t->matrix.filter)
        sum_rows(t->n, solved->r, status + FLOW_LOST);
    else
        note_lost(t, solved, status + FLOW_LOST);
    const struct solve_norms norms = solve_norms(t->n, t->matrix.diagonal, solved->dv, solved->r);
    status[FLOW_SIZE] = norms.size;
    status[FLOW_RESIDUAL] = norms.bound;
    status[FLOW_FAILED] = scalars->outcome != SOLVE_OK;
    if (solved->factor)
        status[FLOW_SHIFTED] =
            solved->factor[flow_factor_shifted(t, flow_of(call)->conditioner.local)];
    if (flow_block_of(call) != 0)
        return;
    const double error = sqrt(solve_scalars_error(scalars, INFINITY)) + sqrt(scalars->drift);
    status[FLOW_ITERATIONS] = solve_scalars_iterations(scalars);
    status[FLOW_ERROR] = error * error;
    status[FLOW_RESTARTS] = scalars->restarts;
}

/* v += dv, x += h v of a block; notes the solve's cost and the momentum that it lost. It does not
 * run after a solve that failed in a step that must not, as that leaves no scalars. */
static int implicit_move(const duite_call *call, const struct flow_table *t,
                         const struct flow_step_args *step, const struct solved *solved,
                         const struct flow_move *m)
{
    note_solve(call, t, solved, m->status);
    if (m->x != m->from_x) {
        memcpy(m->x, m->from_x, t->n * sizeof *m->x);
        memcpy(m->v, m->from_v, t->n * sizeof *m->v);
    }
    phys_advance(t->n, 1, solved->dv, m->v);
    flow_write_halo(t, m->v, m->halo_v);
    flow_part_ends(call, FLOW_VELOCITY);
    phys_advance(t->n, step->h, m->v, m->x);
    flow_write_halo(t, m->x, m->halo_x);
    const int code = flow_check(call, t, step, m->v, "velocity", m->status);
    return code ? code : flow_check(call, t, step, m->x, "position", m->status);
}

#define IMPLICIT_SOLVED(call, t, on)                                                               \
    ((struct solved){.value = flow_matrix_in(call, t, (on)->a),                                    \
                     .b = (on)->f,                                                                 \
                     .dv = (on)->dv,                                                               \
                     .r = (on)->r,                                                                 \
                     .scalars = (on)->scalars,                                                     \
                     .factor = (on)->factor,                                                       \
                     .tie_table = (on)->tie_table})

/* In place. */
FLOW_KERNEL(implicit, FLOW_POSITION, struct flow_step_args,
            (R(table), R(f), R(a), R(dv), R(r), RW(x), RW(v), W(halo_x), W(halo_v), R(scalars),
             SUM(status), IF_MADE(factor), IF_MADE(tie_table)))
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct solved solved = IMPLICIT_SOLVED(call, t, on);
    const struct flow_move move = FLOW_MOVE(on, x, v, halo_x, halo_v);
    return implicit_move(call, t, on->args, &solved, &move);
}

/* Beside the state, which stays as it is. */
FLOW_KERNEL(implicit_next, FLOW_POSITION, struct flow_step_args,
            (R(table), R(f), R(a), R(dv), R(r), R(x), R(v), W(kept_x), W(kept_v), W(halo_x),
             W(halo_v), R(scalars), SUM(status), IF_MADE(factor), IF_MADE(tie_table)))
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct solved solved = IMPLICIT_SOLVED(call, t, on);
    const struct flow_move move = FLOW_MOVE(on, kept_x, kept_v, halo_x, halo_v);
    return implicit_move(call, t, on->args, &solved, &move);
}

/* The state is copied first with pins or contact, which write into it before the solve, with
 * recorded rounds of a correction, which name its objects, and with Newton steps, which have
 * bases. */
static bool implicit_euler_keeps(const struct model *model)
{
    return model_keeps(model) && !flow_step_is_driven(model) && !model->correction_rounds &&
           !searches(model);
}

static int fork_move(struct flow_state *state)
{
    const bool keeps = implicit_euler_keeps(state->flow->model);
    struct flow_step_args args = flow_attempt_args(state);
    flow_cg_iterate(state);
    state->guessed = state->attempt.length;
    flow_fork_each(state, keeps ? &flow_kernel_implicit_next : &flow_kernel_implicit, &args);
    if (keeps)
        flow_swap_kept(state);
    return state->code;
}

/* ---- Newton steps ----
 *
 * They and steps by BDF2 have bases (cloth/physics/particle.h); args.h is the t of the step. */

/* f becomes the right side of the next Newton step. */
FLOW_KERNEL(residual, FLOW_ACCELERATION, struct flow_step_args,
            (R(table), R(base_v), R(v), R(dv), RW(f), SUM(slope)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    phys_residual(t->n, on->args->h, t->mass, on->base_v, on->v, on->f);
    *on->slope = phys_slope(t->n, t->free, on->dv, on->f);
    return 0;
}

/* The slope along dv at the present state, kg m^2/s^2. Also makes the right side of a Newton step
 * from there. */
static int get_slope(struct flow_state *state, struct flow_step_args args, double *slope)
{
    fork_force(state, args);
    flow_set(state, FLOW_FIELD_slope, NULL);
    flow_fork_each(state, &flow_kernel_residual, &args);
    return flow_get(state, FLOW_FIELD_slope, slope);
}

/* A block moves by a part of dv, its bases where it began. */
struct newton_move {
    const phys_vec *dv, *base_x;
    phys_vec *v, *x, *halo_v, *halo_x;
};

static void newton_move(const struct flow_table *t, double h, double part,
                        const struct newton_move *m)
{
    phys_advance(t->n, part, m->dv, m->v);
    phys_place(t->n, h, m->base_x, m->v, m->x);
    flow_write_halo(t, m->v, m->halo_v);
    flow_write_halo(t, m->x, m->halo_x);
}

struct shift_args {
    uint32_t block;
    double h, part;
};

/* A part of dv more. */
FLOW_KERNEL(shift, FLOW_VELOCITY, struct shift_args,
            (R(table), R(dv), R(base_x), RW(v), W(x), W(halo_v), W(halo_x)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct newton_move move = {on->dv, on->base_x, on->v, on->x, on->halo_v, on->halo_x};
    newton_move(&table, on->args->h, on->args->part, &move);
    return 0;
}

/* A Newton step that ends where the slope along it is steep the other way is cut. */
static int search_line(struct flow_state *state, struct flow_step_args args, double first)
{
    struct shift_args shift = {.h = args.h};
    double slope, length = 1;
    get_slope(state, args, &slope);
    for (int i = 0; i < MAX_CUTS && !state->code && !(slope >= -OVERSHOT * first); i++) {
        double cut = first / (first - slope);
        cut = cut >= LEAST_CUT ? cut : LEAST_CUT; /* not a number: the same */
        shift.part = (cut - 1) * length;
        length *= cut;
        flow_fork_each(state, &flow_kernel_shift, &shift);
        get_slope(state, args, &slope);
    }
    return state->code;
}

/* The whole of dv. */
FLOW_KERNEL(correct, FLOW_VELOCITY, struct flow_step_args,
            (R(table), R(f), R(a), R(dv), R(r), R(base_x), R(base_v), RW(v), W(x), W(halo_v),
             W(halo_x), R(scalars), SUM(status), IF_MADE(factor), IF_MADE(tie_table)))
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const struct solved solved = IMPLICIT_SOLVED(call, t, on);
    const struct newton_move move = {on->dv, on->base_x, on->v, on->x, on->halo_v, on->halo_x};
    note_solve(call, t, &solved, on->status);
    on->status[FLOW_SLOPE] = phys_slope(t->n, t->free, on->dv, on->f);
    newton_move(t, on->args->h, 1, &move);
    on->status[FLOW_CHANGE] = phys_distance(t->n, t->mass, on->dv, NULL);
    on->status[FLOW_WHOLE] = phys_distance(t->n, t->mass, on->v, on->base_v);
    const int code = flow_check(call, t, on->args, on->v, "velocity", on->status);
    return code ? code : flow_check(call, t, on->args, on->x, "position", on->status);
}

/* Moves v and x by all of dv; the solve's report goes to the status, or to one in its place. */
static int fork_correct(struct flow_state *state, struct flow_step_args args,
                        const struct flow_as *as)
{
    flow_cg_iterate(state);
    return flow_fork_each_as(state, &flow_kernel_correct, &args, as);
}

/* One Newton step. *sums: its report. */
static int newton_step(struct flow_state *state, struct flow_step_args args,
                       double sums[FLOW_STATUS])
{
    flow_set(state, FLOW_FIELD_trial, NULL);
    fork_correct(state, args, FLOW_AS(FLOW_FOR(status, trial)));
    return flow_get(state, FLOW_FIELD_trial, sums);
}

/* Sums all Newton steps; only the last one's errors count. */
static void sum_newton_steps(double all[FLOW_STATUS], const double last[FLOW_STATUS])
{
    const double iterations = all[FLOW_ITERATIONS], restarts = all[FLOW_RESTARTS];
    const double shifted = all[FLOW_SHIFTED];
    memcpy(all, last, FLOW_STATUS * sizeof *all);
    all[FLOW_ITERATIONS] += iterations;
    all[FLOW_RESTARTS] += restarts;
    all[FLOW_SHIFTED] += shifted;
}

/* Newton steps until the last one is small, or there were enough. The first system is made. */
static int newton(struct flow_state *state, struct flow_step_args args)
{
    const struct model *model = state->flow->model;
    const double small = model->newton_tolerance * model->newton_tolerance;
    struct flow_newton *newton = &state->newton;
    *newton = (struct flow_newton){0};
    while (true) {
        double last[FLOW_STATUS];
        if (newton_step(state, args, last))
            return state->code;
        sum_newton_steps(newton->status, last);
        newton->steps++;
        newton->converged = last[FLOW_CHANGE] <= small * last[FLOW_WHOLE];
        if (newton->converged || last[FLOW_FAILED] + last[FLOW_BEYOND] > 0)
            return DUITE_OK;
        if (search_line(state, args, last[FLOW_SLOPE]) || newton->steps == model->newton_steps)
            return state->code;
        fork_system(state, args);
    }
}

/* ---- Steps ---- */

/* x and v, as they are, become the bases of a step of implicit Euler. */
static int fork_bases(struct flow_state *state)
{
    return flow_keep_as(state, FLOW_AS(FLOW_FOR(kept_x, base_x), FLOW_FOR(kept_v, base_v)));
}

/* Ends a step whose first system is made. */
static int finish_step(struct flow_state *state, struct flow_step_args args)
{
    return searches(state->flow->model) ? newton(state, args) : fork_correct(state, args, NULL);
}

/* The system of a step of implicit Euler, and its solve's begin. */
static int implicit_euler_begin(struct flow_state *state)
{
    flow_assemble(state);
    return flow_cg_start(state);
}

static int implicit_euler_end(struct flow_state *state)
{
    if (!searches(state->flow->model))
        return fork_move(state);
    fork_bases(state);
    return finish_step(state, flow_attempt_args(state));
}

const struct flow_integrator flow_integrator_implicit_euler = {
    .begin = implicit_euler_begin, .end = implicit_euler_end, .keeps = implicit_euler_keeps};

/* ---- BDF2 ---- */

/* Along directions that a slider holds, a row goes where its v says, like a row that is held
 * whole. */
static void constrain_bases(const duite_call *call, const struct flow_table *t,
                            const struct flow_step_args *step, const struct phys_states *s)
{
    struct flow_pins pins;
    struct flow_slider slider;
    flow_pins_begin(call, t, step->time, &pins);
    for (uint32_t i = 0; i < t->n_sliding; i++) {
        const uint32_t row = t->sliding[i][0];
        const phys_vec held = s->x[row] + step->h / 2 * s->v[row];
        flow_pins_slider(&pins, i, &slider);
        flow_slider_keep(&slider, &held, s->base_x + row);
    }
}

/* Its bases, and x where v would lead. */
FLOW_KERNEL(predict, FLOW_POSITION, struct flow_step_args,
            (R(table), RW(x), R(v), RW(last_x), RW(last_v), W(base_x), W(base_v), W(halo_x)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const double h = on->args->h;
    const struct phys_states states = {.x = on->x,
                                       .v = on->v,
                                       .last_x = on->last_x,
                                       .last_v = on->last_v,
                                       .base_x = on->base_x,
                                       .base_v = on->base_v};
    phys_bdf2_bases(t->n, h, t->free, &states);
    constrain_bases(call, t, on->args, &states);
    phys_place(t->n, h, states.base_x, states.v, on->x);
    flow_write_halo(t, on->x, on->halo_x);
    return 0;
}

/* The first step, and one after contact, after a tie came or went, or after a step of another
 * length, is by implicit Euler. */
static int bdf2_start(struct flow_state *state)
{
    flow_keep_as(state, FLOW_AS(FLOW_FOR(kept_x, last_x), FLOW_FOR(kept_v, last_v)));
    fork_bases(state);
    implicit_euler_begin(state);
    return finish_step(state, flow_attempt_args(state));
}

bool flow_implicit_is_second(const struct flow_state *state)
{
    return state->flow->model->integrator == MODEL_BDF2 && state->smooth == state->attempt.length &&
           !flow_ties_changed(state);
}

static int bdf2_end(struct flow_state *state)
{
    struct flow_step_args args = flow_attempt_args(state);
    double slope;
    if (!flow_implicit_is_second(state))
        return bdf2_start(state);
    args.h *= 2.0 / 3;
    flow_fork_each(state, &flow_kernel_predict, &args);
    get_slope(state, args, &slope);
    if (model_is_filtered(state->flow->model))
        flow_contact_filter(state, args);
    fork_system(state, args);
    return finish_step(state, args);
}

const struct flow_integrator flow_integrator_bdf2 = {.end = bdf2_end, .two_steps = true};

void flow_implicit_status(const struct flow_state *state, double status[FLOW_STATUS])
{
    for (int i = 0; i < FLOW_STATUS && searches(state->flow->model); i++)
        status[i] += state->newton.status[i];
}

void flow_implicit_settle(struct flow_state *state, bool accepted, const double status[FLOW_STATUS])
{
    struct flow_report *report = state->report;
    const bool touched = status[FLOW_TOUCHED] + status[FLOW_CORRECTED] > 0;
    state->smooth = accepted && !touched ? state->attempt.length : 0;
    if (!accepted || !searches(state->flow->model))
        return;
    report->newton_steps += state->newton.steps;
    report->newton_unconverged += !state->newton.converged;
}
