/* The state after a step is watched when the whole step is forked. When it is accepted, probes
 * report it, and the main program may find that the run rests. Watching leaves the state as it is
 * and is forked only for runs with probes or rest. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

#include "cloth/physics/particle.h"

static bool may_rest(const struct flow_state *state)
{
    return state->flow->model->rest.speed > 0;
}

/* Widens a range to the stretches of the block's edges that count. */
static void watch_find_range(const struct flow_table *t, const phys_vec *x,
                             const duite_param *halo_x, double range[2])
{
    struct phys_springs springs = flow_table_inner(t);
    phys_springs_range(&springs, t->stretch, x, x, range);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        springs = flow_table_cut(t, s);
        phys_springs_range(&springs, t->stretch + t->n_inner + t->cut[s], x,
                           flow_rows_of(halo_x, s), range);
    }
}

/* ---- The largest stretch, by which steps are judged and which the report has ---- */

FLOW_KERNEL(stretch, FLOW_NO_PART, struct flow_block_args,
            (R(table), R(x), MAX(stretch), NEIGHBOURS(halo_x)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    double range[2] = {0};
    watch_find_range(&table, on->x, on->halo_x, range);
    *on->stretch = range[1];
    return 0;
}

int flow_stretch_fork(struct flow_state *state)
{
    flow_set(state, FLOW_FIELD_stretch, NULL);
    return flow_fork_each(state, &flow_kernel_stretch, NULL);
}

int flow_stretch_get(struct flow_state *state, double *stretch)
{
    return flow_get(state, FLOW_FIELD_stretch, stretch);
}

/* ---- Watching ---- */

FLOW_KERNEL(watch, FLOW_OUTPUT, struct flow_block_args,
            (R(table), R(x), R(v), MAX(peaks), NEIGHBOURS(halo_x)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    double range[2] = {INFINITY, -INFINITY}, max = 0;
    phys_kinetic(t->n, t->mass, on->v, &max);
    watch_find_range(t, on->x, on->halo_x, range);
    on->peaks[FLOW_PEAK_SPEED] = max;
    on->peaks[FLOW_PEAK_LONGEST] = range[1];
    on->peaks[FLOW_PEAK_SHORTEST] = -range[0];
    return 0;
}

int flow_watch(struct flow_state *state)
{
    const double none[FLOW_PEAKS] = {0, -INFINITY, -INFINITY};
    flow_seams_fork(state);
    if (!flow_writes_probes(state) && !may_rest(state))
        return state->code;
    flow_set(state, FLOW_FIELD_peaks, none);
    flow_fork_each(state, &flow_kernel_watch, NULL);
    if (flow_writes_probes(state))
        flow_energies(state, flow_attempt_args(state), FLOW_FIELD_energy);
    return state->code;
}

/* Finds if the run rests, by the speeds at the end of a step. */
static int find_rest(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    double peaks[FLOW_PEAKS];
    if (!may_rest(state) || state->resting || flow_get(state, FLOW_FIELD_peaks, peaks))
        return state->code;
    const double time = flow_time(state);
    if (model_moves_after(model, time))
        state->moved = time;
    for (uint32_t curve = 1; curve <= model->n_curves; curve++)
        if (model_curve_end(model, curve) > time)
            state->moved = time; /* a load will vary yet */
    if (flow_ties_will_change(state))
        state->moved = time;
    if (!(sqrt(peaks[FLOW_PEAK_SPEED]) <= model->rest.speed))
        state->moved = time;
    state->resting = state->grid.now > 0 && time - state->moved >= model->rest.hold;
    if (state->resting)
        state->report->rest_seconds = time;
    return DUITE_OK;
}

int flow_watched(struct flow_state *state)
{
    flow_noted(state, flow_contact_watch(state));
    if (flow_writes_probes(state))
        flow_probes_row(state);
    flow_seams_find(state);
    return find_rest(state);
}
