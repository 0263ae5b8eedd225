/* The table of probes. When a step is accepted, the blocks that probes name compute the forces on
 * their rows and report the values. Rank 0 writes one row after the other, as it does frames: each
 * row's task holds the token. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/pins/sliders.h"

/* ---- A block's values ---- */

struct probe_args {
    union {
        uint32_t block;
        struct flow_step_args step; /* the last one; its `now` is its end */
    };
    struct flow_two_steps steps; /* the last two */
};

FLOW_KERNEL(probe, FLOW_OUTPUT, struct probe_args,
            (R(table), R(x), R(v), R(probe_force), W(probe_values), IF_MADE(contact_force)));

/* m a - f of a row that is held, a the acceleration that its pin gives it. */
static void reaction_of_held(const duite_call *call, const struct flow_table *t, uint32_t row,
                             const struct probe_fields *on, phys_vec *pull)
{
    phys_vec a = {0};
    for (uint32_t i = 0; i < t->n_moved; i++)
        if (t->moved[i][0] == row)
            flow_due_acceleration(call, &on->args->steps, t->moved[i][1], t->position + row, &a);
    *pull = t->mass[row] * a - on->probe_force[row];
}

/* (I - S) (m a - f) of a row that a slider leaves free in part; else 0. */
static void reaction_of_sliding(const duite_call *call, const struct flow_table *t, uint32_t row,
                                const struct probe_fields *on, phys_vec *pull)
{
    struct flow_pins pins;
    flow_pins_begin(call, t, on->args->steps.end, &pins);
    const phys_vec *filter = flow_pins_filter(&pins, row);
    *pull = (phys_vec){0};
    if (!filter)
        return;
    phys_vec a, along;
    flow_slider_acceleration(call, &on->args->steps, t->sliding[pins.next][1], on->x + row,
                             on->v + row, &a);
    *pull = along = t->mass[row] * a - on->probe_force[row];
    solve_filter(filter, &along);
    *pull -= along;
}

static int probe_body(const duite_call *call, const struct probe_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    double *to = on->probe_values;
    for (uint32_t i = 0; i < t->n_watched; i++, to += FLOW_PROBE_VALUES) {
        const uint32_t row = t->watched[i];
        phys_vec pull;
        if (t->free[row] != 0) {
            reaction_of_sliding(call, t, row, on, &pull);
            flow_soft_pull(call, t, &on->args->step, row, on->x, on->v, &pull);
        } else
            reaction_of_held(call, t, row, on, &pull);
        for (int c = 0; c < 3; c++) {
            to[c] = on->x[row][c];
            to[3 + c] = on->v[row][c];
            to[6 + c] = pull[c];
            to[9 + c] = on->contact_force ? on->contact_force[row][c] : 0;
        }
    }
    return 0;
}

/* On a block. */
static void fork_probe(struct flow_state *state, uint32_t block, const struct flow_two_steps *steps)
{
    const double tick = state->flow->model->h / FLOW_TICKS;
    const struct probe_args probe = {.step = {.block = block,
                                              .h = steps->h,
                                              .begin = (steps->end - steps->h) / tick,
                                              .time = steps->end,
                                              .now = steps->end},
                                     .steps = *steps};
    flow_fork_one_as(state, &flow_kernel_force, &probe.step, FLOW_AS(FLOW_FOR(f, probe_force)));
    flow_fork_one(state, &flow_kernel_probe, &probe);
}

/* ---- On rank 0 ---- */

static double *put_three(double *to, bool wanted, const double *three)
{
    for (int c = 0; wanted && c < 3; c++)
        *to++ = three[c];
    return to;
}

/* by_obstacle: the force of each; NULL: no probe reports any. */
static void fill_probes(const struct flow *flow, const double *probe_values,
                        const phys_vec *by_obstacle, double *to)
{
    const struct flow_watched *watched = &flow->watched;
    for (uint32_t p = 0; p < flow->model->n_probes; p++) {
        const struct model_probe *probe = flow->model->probes + p;
        double sum[6] = {0};
        for (uint32_t i = watched->first[p]; i < watched->first[p + 1]; i++) {
            const double *vertex = probe_values + FLOW_PROBE_VALUES * (size_t)watched->entry[i];
            to = put_three(to, probe->position, vertex);
            to = put_three(to, probe->velocity, vertex + 3);
            to = put_three(to, probe->reaction, vertex + 6);
            to = put_three(to, probe->contact, vertex + 9);
            for (int c = 0; c < 6 && !watched->again[i]; c++)
                sum[c] += vertex[6 + c];
        }
        to = put_three(to, probe->total, sum);
        to = put_three(to, probe->contact_total, sum + 3);
        for (int c = 0; c < 3 && probe->by_obstacle; c++)
            *to++ = by_obstacle[probe->obstacle][c];
    }
}

struct row_args {
    uint32_t block; /* none */
    uint64_t steps; /* made so far */
    double time;    /* s */
};

FLOW_KERNEL_WITH(row, FLOW_OUTPUT, struct row_args,
                 (RW(token), R(status), R(peaks), R(energy), IF_MADE(obstacle_force),
                  ALL(probe_values)),
                 .side_effects = 1)
{
    struct flow *flow = flow_of(call);
    double *to = flow->row, *probe_values = flow->probe_values;
    for (const duite_param *block = on->probe_values; block < call->param + call->n_params;
         block++) {
        memcpy(probe_values, block->data, block->count * sizeof *probe_values);
        probe_values += block->count;
    }
    to[FLOW_COLUMN_ITERATIONS] = on->status[FLOW_ITERATIONS];
    to[FLOW_COLUMN_LONGEST] = on->peaks[FLOW_PEAK_LONGEST];
    to[FLOW_COLUMN_SHORTEST] = -on->peaks[FLOW_PEAK_SHORTEST];
    memcpy(to + FLOW_COLUMN_ENERGY, on->energy, FLOW_ENERGIES * sizeof *to);
    fill_probes(flow, flow->probe_values, on->obstacle_force, to + FLOW_RUN_COLUMNS);
    if (flow->output->row(flow->output->context, on->args->steps, on->args->time,
                          flow->watched.n_columns, flow->row, &flow->trouble))
        return duite_fail(call, FLOW_NOT_WRITTEN, "%s", flow->trouble.text);
    return 0;
}

/* Waits until the row before is written. */
int flow_probes_row(struct flow_state *state)
{
    int64_t token;
    const struct flow_before before = flow_before(state);
    const uint64_t number = state->report->steps;
    const struct row_args args = {.steps = before.steps + number,
                                  .time = before.time + flow_time(state)};
    const double tick = state->flow->model->h / FLOW_TICKS;
    const uint32_t length = state->length ? state->length : FLOW_TICKS;
    const uint32_t last = state->length_before ? state->length_before : length;
    const struct flow_two_steps steps = {
        .end = flow_time(state), .h = length * tick, .before = last * tick};
    if (number < before.goes_on) /* the run before ended with it */
        return DUITE_OK;
    if (number > before.goes_on)
        flow_get(state, FLOW_FIELD_token, &token);
    flow_ties_show(state);
    for (uint32_t b = 0; b < state->flow->tables.n_blocks; b++)
        if (state->flow->tables.block[b].n_watched)
            fork_probe(state, b, &steps);
    return flow_fork_at(state, 0, &flow_kernel_row, &args, NULL);
}
