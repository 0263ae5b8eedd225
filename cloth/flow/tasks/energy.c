/* Energies are of the state that the tasks forked so far leave, and change nothing of it. */
#include "cloth/flow/tasks/tasks.h"

#include <math.h>
#include <stddef.h>

/* By symplectic Euler x moved with v: it is the velocity half a step before. With that at x the
 * energy is off by the square of h only. */
static int fork_level(struct flow_state *state, struct flow_args args)
{
    const int code =
        flow_fork_all(state, &flow_force, args, FLOW_OBJECTS(FLOW_AT(x), FLOW_AT(v), FLOW_AT(f)),
                      FLOW_NOTHING, FLOW_RIM(rim_x), FLOW_RIM(rim_v));
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

int flow_energy_fork(struct flow_state *state)
{
    return state->flow->model->energy_steps ? flow_energies(state, flow_attempt_args(state),
                                                            state->energies[state->attempt.parity])
                                            : DUITE_OK;
}

int flow_energy_note(struct flow_state *state)
{
    struct flow_report *report = state->report;
    double sums[FLOW_SUMS], total = 0;
    if (!state->flow->model->energy_steps)
        return DUITE_OK;
    const int code = duite_get(state->rt, state->energies[state->attempt.parity], sums);
    if (code)
        return code;
    for (int i = 0; i < FLOW_ENERGIES; i++)
        total += sums[i];
    report->energy_lowest = fmin(report->energy_lowest, total);
    report->energy_highest = fmax(report->energy_highest, total);
    report->energy_gained = fmax(report->energy_gained, total - report->energy_lowest);
    return DUITE_OK;
}

/* Before the first step. */
static void begin(struct flow_state *state)
{
    struct flow_report *report = state->report;
    const struct flow_energy *start = &report->start;
    const double total = start->kinetic + start->elastic + start->gravity + start->loads;
    const bool looks = state->flow->model->energy_steps;
    report->energy_lowest = report->energy_highest = looks ? total : NAN;
    report->energy_gained = looks ? 0 : NAN;
}

int flow_energy_get(struct flow_state *state, struct flow_energy *energy)
{
    double sums[FLOW_SUMS];
    struct flow_args args = flow_attempt_args(state);
    args.h = args.h > 0 ? args.h : state->flow->model->h; /* before the first step */
    int code = flow_energies(state, args, state->energy);
    if (!code)
        code = duite_get(state->rt, state->energy, sums);
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
