/* The largest stretch of the edges, by which steps are judged and which the report has. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/state/bodies.h"

FLOW_KERNEL(stretch, FLOW_NO_PART, struct flow_block_args,
            (R(table), R(x), MAX(stretch), NEIGHBOURS(halo_x)))
static int stretch_body(const duite_call *call, const struct stretch_fields *on)
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    struct phys_springs springs = flow_table_inner(t);
    double max = phys_springs_stretch(&springs, t->stretch, on->x, on->x);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        springs = flow_table_cut(t, s);
        const double there = phys_springs_stretch(&springs, t->stretch + t->n_inner + t->cut[s],
                                                  on->x, flow_rows_of(on->halo_x, s));
        max = there > max ? there : max;
    }
    *on->stretch = max;
    return 0;
}

int flow_stretch_fork(struct flow_state *state)
{
    struct flow_block_args args;
    const double nothing = 0;
    const int code =
        duite_set(state->rt, flow_field_object(state, FLOW_FIELD_stretch, 0), &nothing);
    return code ? code : flow_fork_each(state, &flow_kernel_stretch, &args);
}

int flow_stretch_get(struct flow_state *state, double *stretch)
{
    return duite_get(state->rt, flow_field_object(state, FLOW_FIELD_stretch, 0), stretch);
}
