/* The force of contact in the step that was accepted last. Multipliers, stiffness and friction are
 * those of its last solve: the rows of its contacts, and their part of the matrix, stay until the
 * next step makes its own. */
#include "cloth/flow/observe/observe.h"
#include "cloth/flow/state/bodies.h"

FLOW_KERNEL(contact_force, FLOW_OUTPUT, struct flow_block_args,
            (R(table), R(x), R(v), R(a), R(contact_rows), R(contact_obstacles), W(contact_force),
             SUM(obstacle_force), IF_MADE(tie_table), TIED(tie_halo)))
{
    struct flow_table table = flow_table_in(call, on->table), *t = &table;
    const phys_vec *value = flow_tie_values(t, flow_matrix_in(call, t, on->a));
    const struct flow_view view = {.x = on->x,
                                   .v = on->v,
                                   .tie_table = on->tie_table,
                                   .tie_halo = on->tied_tie_halo,
                                   .contact_rows = on->contact_rows};
    memset(on->contact_force, 0, t->n * sizeof *on->contact_force);
    flow_contact_solved(flow_of(call), &view, on->contact_obstacles, value, on->contact_force,
                        on->obstacle_force);
    return 0;
}

/* At the start there is no step. */
static int set_none(struct flow_state *state)
{
    int code = DUITE_OK;
    for (uint32_t b = 0; b < state->flow->tables.n_blocks && !code; b++)
        code = duite_set(state->rt, state->block[b].contact_force, NULL);
    return code;
}

int flow_contact_watch(struct flow_state *state)
{
    if (!flow_feels_contact(state))
        return DUITE_OK;
    if (flow_shows_contact(state)) /* a frame may show the end of the step before */
        flow_fields_swap(state, FLOW_FIELD_contact_force, FLOW_FIELD_kept_contact_force);
    const int code = duite_set(state->rt, state->run.obstacle_force, NULL);
    if (code)
        return code;
    return state->report->steps ? flow_fork_each(state, &flow_kernel_contact_force, NULL)
                                : set_none(state);
}
