/* Steps that solve a linear system, or several. One Newton step of implicit Euler is forked whole.
 * With more of them the main program looks at each: whether it was the last, and whether it went
 * too far. BDF2 needs to know how the step before ended, so all of a step by it comes after that.
 * The recorded round of conjugate gradients serves all solves. */
#include "cloth/flow/tasks.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static const double OVERSHOT = 0.5; /* of the slope at the begin of a Newton step, and uphill */
static const double LEAST_CUT = 0.1;
enum { MOST_CUTS = 8 };

static bool searches(const struct flow_state *state)
{
    return model_is_implicit(state->flow->model) && state->flow->model->newton_steps > 1;
}

/* ---- Parts of a step ---- */

static int fork_force(struct flow_state *state, struct flow_args args)
{
    return flow_fork_all(state, &flow_force, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)),
                         FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
}

/* Holds what is in contact. */
static int fork_hold(struct flow_state *state, struct flow_args args)
{
    return flow_fork_all(state, &flow_hold, args,
                         FLOW_OBJECTS(FLOW_AT(filter), FLOW_AT(f), FLOW_AT(a)), FLOW_NOTHING,
                         FLOW_NO_RIM, FLOW_NO_RIM);
}

/* The matrix at x where f is the right side, and the solve's begin. */
static int fork_system(struct flow_state *state, struct flow_args args)
{
    int code = flow_fork_all(state, &flow_matrix, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(a)),
                             FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_NO_RIM);
    if (!code && model_is_filtered(state->flow->model))
        code = fork_hold(state, args);
    return code ? code : flow_cg_start(state);
}

/* What the solves of a step are filtered by, from x, v and f. */
static int fork_filter(struct flow_state *state, struct flow_args args)
{
    return model_is_filtered(state->flow->model)
               ? flow_fork_all(state, &flow_contact, args,
                               FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f), FLOW_AT(filter)),
                               FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM)
               : DUITE_OK;
}

/* The filter goes by the forces. */
static int assemble_held(struct flow_state *state, struct flow_args args)
{
    int code = fork_force(state, args);
    if (!code)
        code = fork_filter(state, args);
    if (!code)
        code = flow_fork_all(state, &flow_system_rest, args,
                             FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f), FLOW_AT(a)),
                             FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
    return code ? code : fork_hold(state, args);
}

int flow_assemble(struct flow_state *state)
{
    const struct flow_args args = flow_attempt_args(state);
    if (model_is_filtered(state->flow->model))
        return assemble_held(state, args);
    return flow_fork_all(state, &flow_system_all, args,
                         FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f), FLOW_AT(a)), FLOW_NOTHING,
                         FLOW_RIM(rim_x), FLOW_RIM(rim_v));
}

/* The system of a step of implicit Euler, and its solve's begin. */
static int linearise(struct flow_state *state)
{
    const int code = flow_assemble(state);
    return code ? code : flow_cg_start(state);
}

static int fork_move(struct flow_state *state)
{
    const struct flow_args args = flow_attempt_args(state);
    int code = flow_cg_iterate(state);
    state->guessed = state->attempt.length;
    if (!code)
        code = flow_fork_all(state, &flow_velocity_dv, args,
                             FLOW_OBJECTS(FLOW_AT(f), FLOW_AT(a), FLOW_AT(dv), FLOW_AT(r),
                                          FLOW_AT(v), FLOW_AT(rim_v)),
                             FLOW_THEN_SCALARS_AND_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
    return code ? code
                : flow_fork_all(state, &flow_position, args,
                                FLOW_OBJECTS(FLOW_AT(v), FLOW_AT(x), FLOW_AT(rim_x)),
                                FLOW_THEN_STATUS, FLOW_NO_RIM, FLOW_NO_RIM);
}

/* ---- Newton steps ---- */

/* The slope along dv where it has led, kg m^2/s^2, and with it the right side of a Newton step from
 * there. */
static int get_slope(struct flow_state *state, struct flow_args args, double *slope)
{
    int code = fork_force(state, args);
    if (!code)
        code = duite_set(state->rt, state->run.slope, NULL);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = DUITE_FORK(state->rt, &flow_residual, &args, o->table, o->base_v, o->v, o->dv, o->f,
                          state->run.slope);
    }
    return code ? code : duite_get(state->rt, state->run.slope, slope);
}

/* A Newton step that ends where the slope along it is steep the other way is cut. */
static int search(struct flow_state *state, struct flow_args args, double first)
{
    double slope, length = 1;
    int code = get_slope(state, args, &slope);
    for (int i = 0; i < MOST_CUTS && !code && !(slope >= -OVERSHOT * first); i++) {
        double cut = first / (first - slope);
        cut = cut >= LEAST_CUT ? cut : LEAST_CUT; /* not a number: the same */
        args.part = (cut - 1) * length;
        length *= cut;
        code = flow_fork_all(state, &flow_shift, args,
                             FLOW_OBJECTS(FLOW_AT(dv), FLOW_AT(base_x), FLOW_AT(v), FLOW_AT(x),
                                          FLOW_AT(rim_v), FLOW_AT(rim_x)),
                             FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
        if (!code)
            code = get_slope(state, args, &slope);
    }
    return code;
}

/* v and x by all of dv; what is told of the solve goes to `status`. */
static int fork_correct(struct flow_state *state, struct flow_args args, duite_object status)
{
    int code = flow_cg_iterate(state);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = DUITE_FORK(state->rt, &flow_correct, &args, o->table, o->f, o->a, o->dv, o->r,
                          o->base_x, o->base_v, o->v, o->x, o->rim_v, o->rim_x,
                          state->run.scalars[0], status);
    }
    return code;
}

/* One Newton step. *sums: what it told. */
static int newton_step(struct flow_state *state, struct flow_args args, double sums[FLOW_STATUS])
{
    int code = duite_set(state->rt, state->run.trial, NULL);
    if (!code)
        code = fork_correct(state, args, state->run.trial);
    return code ? code : duite_get(state->rt, state->run.trial, sums);
}

/* Of all Newton steps together; the last one's errors count. */
static void sum_up(double all[FLOW_STATUS], const double last[FLOW_STATUS])
{
    const double iterations = all[FLOW_ITERATIONS], restarts = all[FLOW_RESTARTS];
    memcpy(all, last, FLOW_STATUS * sizeof *all);
    all[FLOW_ITERATIONS] += iterations;
    all[FLOW_RESTARTS] += restarts;
}

/* Newton steps until the last one is small, or there were enough. The first system is made. */
static int newton(struct flow_state *state, struct flow_args args)
{
    const struct model *model = state->flow->model;
    const double small = model->newton_tolerance * model->newton_tolerance;
    struct flow_newton *told = &state->newton;
    *told = (struct flow_newton){0};
    while (true) {
        double last[FLOW_STATUS];
        int code = newton_step(state, args, last);
        if (code)
            return code;
        sum_up(told->status, last);
        told->steps++;
        told->converged = last[FLOW_CHANGE] <= small * last[FLOW_WHOLE];
        if (told->converged || last[FLOW_FAILED] + last[FLOW_BEYOND] > 0)
            return DUITE_OK;
        code = search(state, args, last[FLOW_SLOPE]);
        if (code || told->steps == model->newton_steps)
            return code;
        code = fork_system(state, args);
        if (code)
            return code;
    }
}

/* ---- Steps ---- */

int flow_implicit_begin(struct flow_state *state)
{
    return state->flow->model->integrator == MODEL_BDF2 ? DUITE_OK : linearise(state);
}

/* x and v, as they are, to two other vectors. */
static int fork_copy(struct flow_state *state, size_t x, size_t v)
{
    struct flow_args args = flow_attempt_args(state);
    int code = DUITE_OK;
    for (; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        const char *at = (const char *)o;
        code = DUITE_FORK(state->rt, &flow_keep, &args, o->x, o->v,
                          *(const duite_object *)(const void *)(at + x),
                          *(const duite_object *)(const void *)(at + v));
    }
    return code;
}

#define OFFSET(name) offsetof(struct flow_objects, name)

/* Ends a step whose first system is made. */
static int finish(struct flow_state *state, struct flow_args args)
{
    return searches(state) ? newton(state, args)
                           : fork_correct(state, args, state->run.status[state->attempt.parity]);
}

static int euler(struct flow_state *state)
{
    if (!searches(state))
        return fork_move(state);
    const int code = fork_copy(state, OFFSET(base_x), OFFSET(base_v));
    return code ? code : finish(state, flow_attempt_args(state));
}

/* The first step, and one after contact or after a step of another length, is by implicit Euler. */
static int bdf2_start(struct flow_state *state)
{
    int code = fork_copy(state, OFFSET(last_x), OFFSET(last_v));
    if (!code)
        code = fork_copy(state, OFFSET(base_x), OFFSET(base_v));
    if (!code)
        code = linearise(state);
    return code ? code : finish(state, flow_attempt_args(state));
}

bool flow_implicit_is_second(const struct flow_state *state)
{
    return state->flow->model->integrator == MODEL_BDF2 && state->smooth == state->attempt.length;
}

static int bdf2(struct flow_state *state)
{
    struct flow_args args = flow_attempt_args(state);
    double slope;
    if (!flow_implicit_is_second(state))
        return bdf2_start(state);
    args.h *= 2.0 / 3;
    int code = flow_fork_all(state, &flow_predict, args,
                             FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(last_x), FLOW_AT(last_v),
                                          FLOW_AT(base_x), FLOW_AT(base_v), FLOW_AT(rim_x)),
                             FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
    if (!code)
        code = get_slope(state, args, &slope);
    if (!code)
        code = fork_filter(state, args);
    if (!code)
        code = fork_system(state, args);
    return code ? code : finish(state, args);
}

int flow_implicit_end(struct flow_state *state)
{
    return state->flow->model->integrator == MODEL_BDF2 ? bdf2(state) : euler(state);
}

void flow_implicit_status(const struct flow_state *state, double status[FLOW_STATUS])
{
    for (int i = 0; i < FLOW_STATUS && searches(state); i++)
        status[i] += state->newton.status[i];
}

void flow_implicit_settle(struct flow_state *state, bool accepted, const double status[FLOW_STATUS])
{
    struct flow_report *report = state->report;
    const bool touched = status[FLOW_TOUCHED] > 0;
    state->smooth = accepted && !touched ? state->attempt.length : 0;
    if (!accepted || !searches(state))
        return;
    report->newton_steps += state->newton.steps;
    report->newton_unconverged += !state->newton.converged;
}
