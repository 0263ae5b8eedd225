/* Energies are of the state that the tasks forked so far leave, and change nothing of it. */
#include "cloth/flow/tasks.h"

#include <math.h>
#include <stddef.h>

/* By symplectic Euler x moved with v: it is the velocity half a step before. With that at x the
 * energy is off by the square of h only. */
static int fork_level(struct flow_state *state, struct flow_args args)
{
    const int code = flow_fork_each(state, &flow_kernel_force, &args);
    return code ? code
                : flow_fork_all(state, &flow_level, args, FLOW_OBJECTS(FLOW_AT(v), FLOW_AT(f)),
                                FLOW_NOTHING, FLOW_NO_RIM, FLOW_NO_RIM);
}

int flow_energies(struct flow_state *state, struct flow_args args, duite_object sums)
{
    const bool apart = state->flow->model->integrator == MODEL_SYMPLECTIC_EULER;
    int code = duite_set(state->rt, sums, NULL);
    if (!code && apart)
        code = fork_level(state, args);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++) {
        const struct flow_objects *o = state->block + args.block;
        code = flow_fork(state, &flow_energy, &args, 3,
                         (duite_object[]){o->x, apart ? o->f : o->v, sums}, FLOW_RIM(rim_x),
                         FLOW_NO_RIM);
    }
    return code;
}

/* Whether energies are looked at after the step under way. */
static bool looks(const struct flow_state *state)
{
    const struct model *model = state->flow->model;
    return model->energy_steps || (model_is_guarded(model) && !state->guard.off);
}

int flow_energy_fork(struct flow_state *state)
{
    return looks(state) ? flow_energies(state, flow_attempt_args(state),
                                        state->run.energies[state->attempt.parity])
                        : DUITE_OK;
}

int flow_energy_wait(struct flow_state *state)
{
    struct flow_guard *guard = &state->guard;
    double sums[FLOW_SUMS];
    if (!looks(state))
        return DUITE_OK;
    const int code = duite_get(state->rt, state->run.energies[state->attempt.parity], sums);
    if (code)
        return code;
    guard->sum = 0;
    for (int i = 0; i < FLOW_ENERGIES; i++)
        guard->sum += sums[i];
    guard->moving = sums[FLOW_ENERGY_MOTION] + sums[FLOW_ENERGY_ELASTIC];
    return DUITE_OK;
}

bool flow_energy_gained(const struct flow_state *state, bool touched)
{
    const struct model *model = state->flow->model;
    const struct flow_guard *guard = &state->guard;
    return model_is_guarded(model) && !guard->off && !touched &&
           guard->sum - guard->lowest > model->energy_growth * fmax(guard->most, guard->moving);
}

/* The guard is on from the second step without contact on: what the first one begins with was not
 * looked at. */
static void note_guard(struct flow_state *state, bool touched)
{
    struct flow_guard *guard = &state->guard;
    if (touched || guard->off) {
        guard->off = touched;
        guard->lowest = INFINITY;
        return;
    }
    guard->lowest = flow_energy_gained(state, false) ? guard->sum : fmin(guard->lowest, guard->sum);
    guard->most = fmax(guard->most, guard->moving);
}

void flow_energy_note(struct flow_state *state, bool touched)
{
    struct flow_report *report = state->report;
    const double sum = state->guard.sum;
    if (state->flow->model->energy_steps) {
        report->energy_lowest = fmin(report->energy_lowest, sum);
        report->energy_highest = fmax(report->energy_highest, sum);
        report->energy_gained = fmax(report->energy_gained, sum - report->energy_lowest);
    }
    if (model_is_guarded(state->flow->model))
        note_guard(state, touched);
}

/* Before the first step. */
static void begin(struct flow_state *state)
{
    struct flow_report *report = state->report;
    const struct flow_energy *start = &report->start;
    const double total = start->kinetic + start->elastic + start->gravity + start->loads;
    const bool told = state->flow->model->energy_steps;
    state->guard = (struct flow_guard){
        .lowest = total, .most = fmax(start->kinetic + start->elastic, state->flow->release)};
    report->energy_lowest = report->energy_highest = told ? total : NAN;
    report->energy_gained = told ? 0 : NAN;
}

int flow_energy_get(struct flow_state *state, struct flow_energy *energy)
{
    double sums[FLOW_SUMS];
    struct flow_args args = flow_attempt_args(state);
    args.h = args.h > 0 ? args.h : state->flow->model->h; /* before the first step */
    int code = flow_energies(state, args, state->run.energy);
    if (!code)
        code = duite_get(state->rt, state->run.energy, sums);
    if (code)
        return code;
    *energy = (struct flow_energy){.kinetic = sums[FLOW_ENERGY_MOTION],
                                   .elastic = sums[FLOW_ENERGY_ELASTIC],
                                   .gravity = sums[FLOW_ENERGY_GRAVITY],
                                   .loads = sums[FLOW_ENERGY_LOADS]};
    const double *torque = sums + FLOW_TORQUE;
    state->report->torque_left =
        sqrt(torque[0] * torque[0] + torque[1] * torque[1] + torque[2] * torque[2]);
    return DUITE_OK;
}

int flow_energy_begin(struct flow_state *state)
{
    const int code = flow_energy_get(state, &state->report->start);
    if (!code)
        begin(state);
    return code;
}
