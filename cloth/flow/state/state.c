/* The state of a run, x and v with their halos: its start, and the copy that is kept of it until a
 * step is accepted. Restoring the copy makes the step undone. */
#include "cloth/flow/integrators/integrator.h"
#include "cloth/flow/run/step.h"
#include "cloth/flow/solver/levels.h"
#include "cloth/flow/solver/solve.h"
#include "cloth/flow/state/bodies.h"

FLOW_KERNEL(initial, FLOW_NO_PART, struct flow_block_args,
            (R(table), W(x), W(v), W(halo_x), W(halo_v)))
{
    const struct flow_table table = flow_table_in(call, on->table), *t = &table;
    for (uint32_t i = 0; i < t->n; i++) {
        on->x[i] = t->position[i];
        on->v[i] = t->velocity[i];
    }
    flow_write_halo(t, on->x, on->halo_x);
    flow_write_halo(t, on->v, on->halo_v);
    return 0;
}

int flow_initialise(struct flow_state *state)
{
    state->settled_forces = false;
    flow_fork_each(state, &flow_kernel_initial, NULL);
    flow_levels_initialise(state);
    return model_is_filtered(state->flow->model) ? state->code : flow_coarse_initialise(state);
}

FLOW_KERNEL(keep, FLOW_POSITION, struct flow_block_args, (R(x), R(v), W(kept_x), W(kept_v)))
{
    memcpy(on->kept_x, on->x, duite_count(call, FLOW_INDEX_OF(keep, x)) * sizeof(double));
    memcpy(on->kept_v, on->v, duite_count(call, FLOW_INDEX_OF(keep, v)) * sizeof(double));
    return 0;
}

int flow_keep_as(struct flow_state *state, const struct flow_as *as)
{
    return flow_fork_each_as(state, &flow_kernel_keep, NULL, as);
}

int flow_keep(struct flow_state *state)
{
    return flow_keep_as(state, NULL);
}

FLOW_KERNEL(restore, FLOW_POSITION, struct flow_block_args,
            (R(table), R(kept_x), R(kept_v), W(x), W(v), W(halo_x), W(halo_v)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    memcpy(on->x, on->kept_x, duite_count(call, FLOW_INDEX_OF(restore, x)) * sizeof(double));
    memcpy(on->v, on->kept_v, duite_count(call, FLOW_INDEX_OF(restore, v)) * sizeof(double));
    flow_write_halo(&table, on->kept_x, on->halo_x);
    flow_write_halo(&table, on->kept_v, on->halo_v);
    return 0;
}

int flow_restore(struct flow_state *state)
{
    const struct model *model = state->flow->model;
    const struct flow_integrator *is = flow_integrator(model);
    if (!is->restore || !flow_integrator_keeps(model))
        return flow_fork_each(state, &flow_kernel_restore, NULL);
    is->restore(state);
    return state->code;
}
