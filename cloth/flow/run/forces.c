/* All forces on the rows of a block, in an order that its table gives. Bodies read neighbours'
 * halos. */
#include "cloth/flow/state/bodies.h"

#include "cloth/physics/particle.h"

static void add_springs(const struct flow_table *t, const struct flow_view *view, phys_vec *f)
{
    struct phys_springs springs = flow_table_inner(t);
    phys_springs_force(&springs, view->x, view->v, NULL, NULL, f);
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        springs = flow_table_cut(t, s);
        phys_springs_force(&springs, view->x, view->v, flow_rows_of(view->halo_x, s),
                           flow_rows_of(view->halo_v, s), f);
    }
}

void flow_forces(const duite_call *call, const struct flow_table *t,
                 const struct flow_step_args *step, const struct flow_view *view, bool drag,
                 phys_vec *f)
{
    if (drag)
        phys_outside(t->n, t->load, t->drag, view->v, f);
    else
        memcpy(f, t->load, t->n * sizeof *f);
    flow_varying_add(call, t, step->now, f);
    flow_soft_force(call, t, step, view->x, view->v, f);
    if (flow_has_elements(t)) {
        const struct phys_sight sight = flow_elements_see(call, t, view);
        flow_elements_force(call, t, step->now, false, &sight, f);
    }
    if (t->n_stiff)
        add_springs(t, view, f);
    if (view->tie_table)
        flow_ties_force(flow_of(call), view, f);
    if (view->contact_rows)
        flow_contact_force(flow_of(call), view, step, f);
}

FLOW_KERNEL(force, FLOW_FORCE, struct flow_step_args,
            (R(table), R(x), R(v), W(f), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v), IF_MADE(tie_table),
             IF_MADE(contact_rows), TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    flow_forces(call, &table, on->args, &view, true, on->f);
    return 0;
}

/* Without the drag. */
FLOW_KERNEL(force_free, FLOW_FORCE, struct flow_step_args,
            (R(table), R(x), R(v), W(f), NEIGHBOURS(halo_x), NEIGHBOURS(halo_v), IF_MADE(tie_table),
             IF_MADE(contact_rows), TIED(tie_halo)))
{
    const struct flow_table table = flow_table_in(call, on->table);
    const struct flow_view view = FLOW_VIEW(on);
    flow_forces(call, &table, on->args, &view, false, on->f);
    return 0;
}
