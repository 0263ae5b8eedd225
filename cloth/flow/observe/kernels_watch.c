/* What a run tells of itself after each step and what decides whether it rests. Nothing of the
 * state is changed. Rows of the table of probes are written by rank 0, one after the other, as
 * frames are: each row's task holds the token. */
#include "cloth/flow/step/guides.h"

#include "cloth/physics/particle.h"

#include <math.h>
#include <string.h>

#define ARGS sizeof(struct flow_args)

static int watch(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *x = duite_in(call, 1, phys_vec);
    double *peaks = duite_out(call, 3, double), range[2] = {INFINITY, -INFINITY}, most = 0;
    phys_kinetic(t->n, t->mass, duite_in(call, 2, phys_vec), &most);
    struct phys_springs springs = flow_table_inner(t);
    phys_springs_range(&springs, t->stretch, x, x, range);
    for (uint32_t s = 0; s < t->n_slots; s++) {
        springs = flow_table_cut(t, s);
        phys_springs_range(&springs, t->stretch + t->n_inner + t->cut[s], x,
                           duite_in(call, 4 + s, phys_vec), range);
    }
    peaks[FLOW_PEAK_SPEED] = most;
    peaks[FLOW_PEAK_LONGEST] = range[1];
    peaks[FLOW_PEAK_SHORTEST] = -range[0];
    return 0;
}
FLOW_TIMED(watch, FLOW_OUTPUT)
const duite_kernel flow_watch_block = {.name = "watch",
                                       .body = watch_timed,
                                       .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_CW},
                                       .law = {[3] = &duite_max},
                                       .variadic = DUITE_R,
                                       .args_size = ARGS};

/* m a - f of a row that is held, a the acceleration that its pin gives it. */
static void reaction_of_held(const duite_call *call, const struct flow_table *t, uint32_t row,
                             const phys_vec *force, phys_vec *pull)
{
    phys_vec a = {0};
    for (uint32_t i = 0; i < t->n_moved; i++)
        if (t->moved[i][0] == row)
            flow_due_acceleration(call, t->moved[i][1], t->position + row, &a);
    *pull = t->mass[row] * a - *force;
}

/* (I - S) (m a - f) of one that a guide leaves free in part; else nothing. */
static void reaction_of_guided(const duite_call *call, const struct flow_table *t, uint32_t row,
                               const phys_vec *force, phys_vec *pull)
{
    const phys_vec *x = duite_in(call, 1, phys_vec), *v = duite_in(call, 2, phys_vec);
    struct flow_pins pins;
    flow_pins_begin(call, t, &pins);
    const phys_vec *filter = flow_pins_filter(&pins, row);
    *pull = (phys_vec){0};
    if (!filter)
        return;
    phys_vec a, along;
    flow_guide_acceleration(call, t->guided[pins.next][1], x + row, v + row, &a);
    *pull = along = t->mass[row] * a - *force;
    solve_filter(filter, &along);
    *pull -= along;
}

static int probe(const duite_call *call)
{
    const struct flow_table table = flow_table_of(call), *t = &table;
    const phys_vec *x = duite_in(call, 1, phys_vec), *v = duite_in(call, 2, phys_vec);
    const phys_vec *force = duite_in(call, 3, phys_vec);
    double *to = duite_out(call, 4, double);
    for (uint32_t i = 0; i < t->n_watched; i++, to += FLOW_SEEN) {
        const uint32_t row = t->watched[i];
        phys_vec pull;
        if (t->free[row] != 0)
            reaction_of_guided(call, t, row, force + row, &pull);
        else
            reaction_of_held(call, t, row, force + row, &pull);
        for (int c = 0; c < 3; c++) {
            to[c] = x[row][c];
            to[3 + c] = v[row][c];
            to[6 + c] = pull[c];
        }
    }
    return 0;
}
FLOW_TIMED(probe, FLOW_OUTPUT)
const duite_kernel flow_probe = {.name = "probe",
                                 .body = probe_timed,
                                 .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_R, DUITE_W},
                                 .args_size = ARGS};

/* ---- On rank 0 ---- */

static double *put(double *to, bool wanted, const double *three)
{
    for (int c = 0; wanted && c < 3; c++)
        *to++ = three[c];
    return to;
}

static void fill_probes(const struct flow *flow, const double *seen, double *to)
{
    const struct flow_watched *watched = &flow->watched;
    for (uint32_t p = 0; p < flow->model->n_probes; p++) {
        const struct model_probe *probe = flow->model->probes + p;
        double sum[3] = {0};
        for (uint32_t i = watched->first[p]; i < watched->first[p + 1]; i++) {
            const double *vertex = seen + FLOW_SEEN * (size_t)watched->entry[i];
            to = put(to, probe->position, vertex);
            to = put(to, probe->velocity, vertex + 3);
            to = put(to, probe->reaction, vertex + 6);
            for (int c = 0; c < 3; c++)
                sum[c] += vertex[6 + c];
        }
        to = put(to, probe->total, sum);
    }
}

enum { STATUS = 1, PEAKS, ENERGY, BLOCKS }; /* parameters of a row */

static int row(const duite_call *call)
{
    struct flow *flow = flow_of(call);
    const struct flow_args *args = flow_args_of(call);
    const double *status = duite_in(call, STATUS, double), *peaks = duite_in(call, PEAKS, double);
    double *to = flow->row, *seen = flow->seen;
    for (size_t i = BLOCKS; i < call->n_params; i++)
        for (size_t k = 0; k < duite_count(call, i); k++)
            *seen++ = duite_in(call, i, double)[k];
    to[FLOW_COLUMN_ITERATIONS] = status[FLOW_ITERATIONS];
    to[FLOW_COLUMN_LONGEST] = peaks[FLOW_PEAK_LONGEST];
    to[FLOW_COLUMN_SHORTEST] = -peaks[FLOW_PEAK_SHORTEST];
    memcpy(to + FLOW_COLUMN_ENERGY, duite_in(call, ENERGY, double), FLOW_ENERGIES * sizeof *to);
    fill_probes(flow, flow->seen, to + FLOW_RUN_COLUMNS);
    if (flow->output->row(flow->output->context, args->frame, args->time, flow->watched.n_columns,
                          flow->row, &flow->trouble))
        return duite_fail(call, FLOW_NOT_WRITTEN, "%s", flow->trouble.text);
    return 0;
}
FLOW_TIMED(row, FLOW_OUTPUT)
const duite_kernel flow_row = {.name = "row",
                               .body = row_timed,
                               .access = {DUITE_RW, DUITE_R, DUITE_R, DUITE_R},
                               .variadic = DUITE_R,
                               .args_size = ARGS,
                               .side_effects = 1};
