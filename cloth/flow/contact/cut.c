/* Ways are cut where solving again does not help: each corner of a pair that fails goes only as far
 * as divides the pair. The shortest way counts among several pairs, so their order does not matter.
 * A cut row gets the velocity of its remaining way. The steps in a row that cut it are counted, but
 * for steps that are given up. */
#include "cloth/flow/contact/contact.h"
#include "cloth/flow/contact/cut_run.h"
#include "cloth/flow/run/step.h"

#include <math.h>
#include <stdlib.h>

struct cut_args {
    union {
        uint32_t block;
        struct flow_step_args step;
    };
    uint32_t attempt, accepted; /* as in struct flow_contact_state */
};

/* Parameters: of fields, then the lists of meetings that may have corners in the block. */
enum {
    AT_TABLE,
    AT_KEPT_X,
    AT_X,
    AT_V,
    AT_RUNS,
    AT_HALO_X,
    AT_HALO_V,
    AT_COUNTS,
    AT_LONGEST,
    AT_LISTS
};

/* Finds the part of its way that each row may go, by all failing pairs. */
static void find_parts(const duite_call *call, uint32_t block, double *part)
{
    for (size_t at = AT_LISTS; at < call->n_params; at++) {
        const struct flow_list *list = duite_in(call, at, struct flow_list);
        const struct flow_near *near = (const struct flow_near *)(list + 1);
        for (uint64_t i = 0; i < list->n; i++)
            for (uint32_t k = 0; near[i].fails && k < near[i].contact.at.n; k++) {
                const struct flow_tie_corners *corners = &near[i].contact.at;
                if (corners->block[k] == block && !(near[i].part[k] >= part[corners->row[k]]))
                    part[corners->row[k]] = near[i].part[k];
            }
    }
}

/* Moves a row by the same sum as certificates use. */
static void cut_row(const struct flow_step_args *step, double part, double thickness, double mass,
                    const phys_vec *from, phys_vec *x, phys_vec *v, double *counts)
{
    const phys_vec before = *v, way = *x - *from;
    const double length = sqrt(phys_dot(&way, &way));
    *x = *from + part * way;
    *v = (1 / step->h) * (*x - *from);
    const phys_vec change = mass * (*v - before);
    counts[FLOW_CUT_ROWS]++;
    for (int c = 0; c < 3; c++)
        counts[FLOW_CUT_MOMENTUM + c] += change[c];
    counts[FLOW_CUT_HALVED] += part < 0.5 && (1 - part) * length > 0.1 * thickness;
}

static int cut(const duite_call *call)
{
    const struct cut_args *args = call->args;
    const struct flow_table table = flow_table_in(call, duite_in(call, AT_TABLE, unsigned char));
    const double thickness = flow_of(call)->model->contact.thickness;
    phys_vec *x = duite_out(call, AT_X, phys_vec), *v = duite_out(call, AT_V, phys_vec);
    struct flow_cut_run *runs = call->param[AT_RUNS].data;
    double *part = malloc((table.n + 1) * sizeof *part), *longest = call->param[AT_LONGEST].data;
    if (!part)
        return duite_fail(call, FLOW_NO_MEMORY, "out of memory for the ways of a block");
    for (uint32_t i = 0; i < table.n; i++)
        part[i] = 1;
    find_parts(call, args->block, part);
    for (uint32_t i = 0; i < table.n; i++) {
        if (part[i] >= 1)
            continue;
        cut_row(&args->step, part[i] > 0 ? part[i] : 0, thickness, table.mass[i],
                duite_in(call, AT_KEPT_X, phys_vec) + i, x + i, v + i,
                duite_out(call, AT_COUNTS, double));
        *longest = fmax(*longest, flow_cut_again(runs + i, args->attempt, args->accepted));
    }
    flow_write_halo(&table, x, duite_out(call, AT_HALO_X, phys_vec));
    flow_write_halo(&table, v, duite_out(call, AT_HALO_V, phys_vec));
    free(part);
    return 0;
}

static int cut_timed(const duite_call *call)
{
    return flow_timed(call, cut, FLOW_COLLIDE);
}
const duite_kernel flow_cut_ways = {.name = "cut",
                                    .body = cut_timed,
                                    .access = {DUITE_R, DUITE_R, DUITE_RW, DUITE_RW, DUITE_RW,
                                               DUITE_W, DUITE_W, DUITE_CW, DUITE_CW},
                                    .law = {[AT_COUNTS] = &duite_sum, [AT_LONGEST] = &duite_max},
                                    .variadic = DUITE_R,
                                    .args_size = sizeof(struct cut_args)};

static int fork_block(struct flow_state *state, const struct cut_args *args)
{
    const struct flow_objects *of = state->block + args->block;
    duite_object *refs = state->contact.refs;
    refs[AT_TABLE] = of->table;
    refs[AT_KEPT_X] = of->kept_x;
    refs[AT_X] = of->x;
    refs[AT_V] = of->v;
    refs[AT_RUNS] = of->cut_runs;
    refs[AT_HALO_X] = of->halo_x;
    refs[AT_HALO_V] = of->halo_v;
    refs[AT_COUNTS] = state->run.cut_counts;
    refs[AT_LONGEST] = state->run.cut_longest;
    const uint32_t n = flow_contact_lists(state, args->block, refs + AT_LISTS);
    return duite_fork(state->rt, &flow_cut_ways, args, AT_LISTS + (size_t)n, refs);
}

int flow_contact_cut(struct flow_state *state, struct flow_cut *cut)
{
    struct cut_args args = {.step = flow_attempt_args(state),
                            .attempt = state->contact.attempt,
                            .accepted = state->contact.accepted};
    double counts[FLOW_CUT_COUNTS] = {0}, longest = 0;
    int code = duite_set(state->rt, state->run.cut_counts, NULL);
    if (!code)
        code = duite_set(state->rt, state->run.cut_longest, NULL);
    for (args.block = 0; args.block < state->flow->tables.n_blocks && !code; args.block++)
        code = fork_block(state, &args);
    if (!code)
        code = duite_get(state->rt, state->run.cut_counts, counts);
    const double *p = counts + FLOW_CUT_MOMENTUM;
    if (!code)
        code = duite_get(state->rt, state->run.cut_longest, &longest);
    *cut = (struct flow_cut){(uint64_t)counts[FLOW_CUT_ROWS], (uint64_t)counts[FLOW_CUT_HALVED],
                             (uint64_t)longest, sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])};
    return code;
}

int flow_contact_cut_none(struct flow_state *state)
{
    int code = DUITE_OK;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !code; b++)
        code = duite_set(state->rt, state->block[b].cut_runs, NULL);
    return code;
}
