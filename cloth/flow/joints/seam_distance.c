/* Distances between partners of pulled seams. Each block reports the joints that have an end in it,
 * so both blocks of a joint report the same. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/state/bodies.h"

#include <math.h>
#include <stdio.h>

/* m: seams that are open by less count as closed in a run that does not wait for them. */
static const double CLOSED = 1e-3;

/* The square of the length of spring i, m^2. */
static double square_of(const struct flow_table *t, uint32_t i, const phys_vec *x,
                        const duite_param *halo_x)
{
    uint32_t s = 0;
    while (i >= t->n_inner && i - t->n_inner >= t->cut[s + 1])
        s++;
    const phys_vec *other = i < t->n_inner ? x : flow_rows_of(halo_x, s);
    const phys_vec d = other[t->end[i][1]] - x[t->end[i][0]];
    return phys_dot(&d, &d);
}

FLOW_KERNEL(seams, FLOW_OUTPUT, struct flow_block_args,
            (R(table), R(x), MAX(seam_peaks), NEIGHBOURS(halo_x)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    for (uint32_t i = 0; i < t->n_pulled; i++) {
        const double square = square_of(t, t->pulled[i][0], on->x, on->halo_x);
        double *most = on->seam_peaks + t->pulled[i][1] - 1;
        *most = square > *most ? square : *most;
    }
    return 0;
}

int flow_seams_fork(struct flow_state *state)
{
    if (!state->flow->model->n_pulled)
        return DUITE_OK;
    flow_set(state, FLOW_FIELD_seam_peaks, NULL);
    return flow_fork_each(state, &flow_kernel_seams, NULL);
}

int flow_seams_find(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    struct flow_report *report = state->report;
    const double limit = model->sewn > 0 ? model->sewn : CLOSED;
    double most = 0;
    if (!model->n_pulled)
        return DUITE_OK;
    if (flow_get(state, FLOW_FIELD_seam_peaks, state->seam_squares))
        return state->code;
    report->seams_open = 0;
    for (uint32_t s = 0; s < model->n_pulled; s++) {
        const double distance = sqrt(state->seam_squares[s]);
        report->seams_open += !(distance <= limit);
        most = fmax(most, distance);
    }
    report->seam_distance = most;
    if (!report->seams_open && isnan(report->sewn_seconds))
        report->sewn_seconds = flow_time(state);
    if (report->seams_open)
        report->sewn_seconds = NAN;
    state->sewn = model->sewn > 0 && !report->seams_open;
    return DUITE_OK;
}

/* The pairs of a pulling seam, by number from 0. On rank 0. */
static const struct model_pairs *pairs_of(const struct model *model, uint32_t number)
{
    uint32_t j = 0;
    for (uint32_t n = 0; n <= number; j++)
        n += model->joints[j].pairs.seam != 0;
    return &model->joints[j - 1].pairs;
}

int flow_seams_fail(struct flow_state *state)
{
    enum { NAMED = 3 };
    const struct model *model = state->flow->model;
    double *square = state->seam_squares;
    char *text = state->reason;
    size_t size = sizeof state->reason, n;
    n = (size_t)snprintf(text, size,
                         "seams are not closed at time.end, %g s: %ju of %u are open by "
                         "more than %g m (time.sewn.distance); seams.reversed turns one that is "
                         "the wrong way round",
                         model->end, (uintmax_t)state->report->seams_open, model->n_pulled,
                         model->sewn);
    for (uint32_t i = 0; i < NAMED && i < state->report->seams_open && model->joints && n < size;
         i++) {
        uint32_t worst = 0;
        char name[MODEL_SEAM_NAME];
        for (uint32_t s = 1; s < model->n_pulled; s++)
            worst = square[s] > square[worst] ? s : worst;
        const struct model_pairs *pairs = pairs_of(model, worst);
        model_name_seam(model->cloths + pairs->end[0].cloth, pairs->seam - 1, name);
        n += (size_t)snprintf(text + n, size - n, "%s %s by %.3g m", i ? ";" : "; the worst:", name,
                              sqrt(square[worst]));
        square[worst] = -1;
    }
    return FLOW_UNSEWN;
}
