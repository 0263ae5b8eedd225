/* Energies are of the state that the tasks forked so far leave, and do not change it. A spring
 * between two blocks gives half of its own to each. Sums are contributions, so that they are the
 * same for any ranks and threads. */
#include "cloth/flow/contact/mode.h"
#include "cloth/flow/pins/sliders.h"
#include "cloth/flow/run/step.h"

#include "cloth/physics/particle.h"
#include "cloth/physics/spring.h"

FLOW_KERNEL(energy, FLOW_NO_PART, struct flow_step_args,
            (R(table), R(x), R(v), SUM(energies), NEIGHBOURS(halo_x), IF_MADE(tie_table),
             TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const double *gravity = flow_of(call)->model->gravity;
    double *sums = on->energies, fastest = 0;
    struct phys_springs springs = flow_table_inner(t);
    const struct flow_view view = {.x = on->x,
                                   .halo_x = on->halo_x,
                                   .tie_table = on->tie_table,
                                   .tie_halo = on->tied_tie_halo};
    sums[FLOW_ENERGY_MOTION] = phys_kinetic(t->n, t->mass, on->v, &fastest);
    sums[FLOW_ENERGY_GRAVITY] = phys_energy_weight(t->n, t->mass, gravity, on->x);
    sums[FLOW_ENERGY_LOADS] = phys_energy_load(t->n, t->mass, gravity, t->load, on->x) +
                              flow_varying_energy(call, t, on->args->now, on->x);
    sums[FLOW_ENERGY_ELASTIC] = flow_elements_energy(call, t, &view, sums + FLOW_TORQUE) +
                                phys_energy_springs(&springs, on->x, on->x) +
                                flow_soft_energy(call, t, on->args, on->x);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        springs = flow_table_cut(t, s);
        sums[FLOW_ENERGY_ELASTIC] +=
            0.5 * phys_energy_springs(&springs, on->x, flow_rows_of(on->halo_x, s));
    }
    if (on->tie_table)
        sums[FLOW_ENERGY_ELASTIC] += flow_ties_energy(flow_of(call), &view);
    return 0;
}

/* f becomes v plus half a kick: the velocity at the time of x, for steps that hold them half a step
 * apart. */
FLOW_KERNEL(level, FLOW_NO_PART, struct flow_step_args, (R(table), R(v), RW(f)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    phys_accelerate(t->n, t->mass, t->free, on->f);
    flow_sliders_filter(call, t, on->args->time, on->f);
    for (uint32_t i = 0; i < t->n; i++)
        on->f[i] = on->v[i] + 0.5 * on->args->h * on->f[i];
    return 0;
}

/* v of a staggered scheme is the velocity half a step before x. With v at the time of x the energy
 * is off only by the square of h. */
static int fork_level(struct flow_state *state, struct flow_step_args args)
{
    flow_fork_each(state, &flow_kernel_force, &args);
    return flow_fork_each(state, &flow_kernel_level, &args);
}

int flow_energies(struct flow_state *state, struct flow_step_args args, enum flow_field_id sums)
{
    const bool apart = model_scheme(state->flow->model)->staggered;
    const enum flow_field_id speed = apart ? FLOW_FIELD_f : FLOW_FIELD_v;
    flow_set(state, sums, NULL);
    if (apart)
        fork_level(state, args);
    return flow_fork_each_as(state, &flow_kernel_energy, &args,
                             FLOW_AS({FLOW_FIELD_v, speed}, {FLOW_FIELD_energies, sums}));
}

/* True if energies are checked after the step under way. */
static bool looks(const struct flow_state *state)
{
    const struct model *model = state->flow->model;
    return model->energy_steps || (model_is_guarded(model) && !state->guard.off);
}

int flow_energy_fork(struct flow_state *state)
{
    return looks(state) ? flow_energies(state, flow_attempt_args(state), FLOW_FIELD_energies)
                        : DUITE_OK;
}

/* Gets the energy of the contacts of the accepted state, or of the one to be accepted. */
static int get_contact(struct flow_state *state, double *energy)
{
    double held[FLOW_HELD] = {0};
    if (flow_contact_mode(state->flow->model)->carries)
        flow_get(state, FLOW_FIELD_contact_energy, held);
    *energy = held[FLOW_HELD_ALL];
    state->guard.lent = held[FLOW_HELD_LENT];
    return state->code;
}

int flow_energy_wait(struct flow_state *state)
{
    struct flow_guard *guard = &state->guard;
    double sums[FLOW_SUMS];
    if (!looks(state))
        return DUITE_OK;
    if (flow_get(state, FLOW_FIELD_energies, sums) || get_contact(state, &guard->sum))
        return state->code;
    for (int i = 0; i < FLOW_ENERGIES; i++)
        guard->sum += sums[i];
    guard->moving = sums[FLOW_ENERGY_MOTION] + sums[FLOW_ENERGY_ELASTIC];
    return DUITE_OK;
}

/* The sum of the step under way less what contacts were lent. */
static double unlent(const struct flow_guard *guard)
{
    return guard->sum - guard->loans - guard->lent;
}

bool flow_energy_gained(const struct flow_state *state, bool touched)
{
    const struct model *model = state->flow->model;
    const struct flow_guard *guard = &state->guard;
    return model_is_guarded(model) && !guard->off && !touched &&
           unlent(guard) - guard->lowest > model->energy_growth * fmax(guard->max, guard->moving);
}

/* The guard is on from the second step without contact: the energies at the begin of the first are
 * not known. */
static void note_guard(struct flow_state *state, bool touched)
{
    struct flow_guard *guard = &state->guard;
    if (touched || guard->off) {
        guard->off = touched;
        guard->lowest = INFINITY;
        return;
    }
    guard->lowest =
        flow_energy_gained(state, false) ? unlent(guard) : fmin(guard->lowest, unlent(guard));
    guard->loans += guard->lent;
    guard->max = fmax(guard->max, guard->moving);
}

/* Notes the sum less all loans so far. */
static void note_unlent(struct flow_report *report, double sum)
{
    report->energy_gained_unlent =
        fmax(report->energy_gained_unlent, sum - report->energy_lowest_unlent);
    report->energy_lowest_unlent = fmin(report->energy_lowest_unlent, sum);
}

void flow_energy_note(struct flow_state *state, bool touched)
{
    struct flow_report *report = state->report;
    const double sum = state->guard.sum;
    if (state->flow->model->energy_steps) {
        report->energy_lowest = fmin(report->energy_lowest, sum);
        report->energy_highest = fmax(report->energy_highest, sum);
        report->energy_lent += state->guard.lent;
        report->energy_gained = fmax(report->energy_gained, sum - report->energy_lowest);
        note_unlent(report, sum - report->energy_lent);
    }
    if (model_is_guarded(state->flow->model))
        note_guard(state, touched);
}

/* Before the first step. */
static void begin_guard(struct flow_state *state)
{
    struct flow_report *report = state->report;
    const struct flow_energy *start = &report->start;
    const double total =
        start->kinetic + start->elastic + start->gravity + start->loads + start->contact;
    const bool reported = state->flow->model->energy_steps;
    state->guard = (struct flow_guard){
        .lowest = total, .max = fmax(start->kinetic + start->elastic, state->flow->release)};
    report->energy_lowest = report->energy_highest = report->energy_lowest_unlent =
        reported ? total : NAN;
    report->energy_gained = report->energy_gained_unlent = report->energy_lent =
        report->energy_corrected = reported ? 0 : NAN;
}

int flow_energy_get(struct flow_state *state, struct flow_energy *energy)
{
    double sums[FLOW_SUMS], contact;
    struct flow_step_args args = flow_attempt_args(state);
    args.h = args.h > 0 ? args.h : state->flow->model->h; /* before the first step */
    flow_energies(state, args, FLOW_FIELD_energy);
    if (flow_get(state, FLOW_FIELD_energy, sums) || get_contact(state, &contact))
        return state->code;
    *energy = (struct flow_energy){.kinetic = sums[FLOW_ENERGY_MOTION],
                                   .elastic = sums[FLOW_ENERGY_ELASTIC],
                                   .gravity = sums[FLOW_ENERGY_GRAVITY],
                                   .loads = sums[FLOW_ENERGY_LOADS],
                                   .contact = contact};
    const double *torque = sums + FLOW_TORQUE;
    state->report->torque_left =
        sqrt(torque[0] * torque[0] + torque[1] * torque[1] + torque[2] * torque[2]);
    return DUITE_OK;
}

int flow_energy_begin(struct flow_state *state)
{
    const int code = flow_energy_get(state, &state->report->start);
    if (!code)
        begin_guard(state);
    return code;
}
