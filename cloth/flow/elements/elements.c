/* Elements see rows of neighbours as ghosts, which a task takes from the halos where it runs; each
 * worker has room for those of one block. Kinds come in their order, elements in that of their
 * list. */
#include "cloth/flow/state/bodies.h"

#include "cloth/solve/assemble.h"

bool flow_has_elements(const struct flow_table *t)
{
    bool has = false;
    for (int kind = 0; kind < ELEMENT_KINDS; kind++)
        has = has || t->n_elements[kind];
    return has;
}

/* The ghosts of the block, of the vector whose halos these are. */
static const phys_vec *copy_halos(const struct flow_table *t, const duite_param *halos,
                                  phys_vec *ghost)
{
    for (uint32_t s = 0; s < t->n_neighbours; s++) {
        const phys_vec *halo = flow_rows_of(halos, s);
        for (uint32_t i = t->ghost_start[s]; i < t->ghost_start[s + 1]; i++)
            ghost[i] = halo[t->ghost[i]];
    }
    return ghost;
}

struct phys_sight flow_elements_see(const duite_call *call, const struct flow_table *t,
                                    const struct flow_view *view)
{
    const struct flow *flow = flow_of(call);
    phys_vec *room = flow->ghost_room + call->worker * flow->n_ghosts;
    struct phys_sight sight = {
        .n = t->n, .x = view->x, .x_ghost = copy_halos(t, view->halo_x, room)};
    if (!view->v)
        return sight;
    sight.v = view->v;
    sight.v_ghost = copy_halos(t, view->halo_v, room + t->n_ghosts);
    return sight;
}

/* True if a kind makes its matrix with its right side. */
static bool has_system(int kind)
{
    return element_kinds[kind]->system != NULL;
}

void flow_elements_force(const duite_call *call, const struct flow_table *t, double now,
                         bool beside, const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_air air = model_air_at(flow_of(call)->model, now);
    for (int kind = 0; kind < ELEMENT_KINDS; kind++)
        if (t->n_elements[kind] && !(beside && has_system(kind)))
            element_kinds[kind]->force(t->list + kind, &air, sight, f);
}

void flow_elements_stiffness(const duite_call *call, const struct flow_table *t, double scale,
                             const struct phys_sight *sight, phys_vec *y)
{
    const int full = flow_of(call)->model->full_slope == PHYS_FULL;
    for (int kind = 0; kind < ELEMENT_KINDS; kind++)
        if (t->n_elements[kind] && element_kinds[kind]->pairs && !has_system(kind))
            element_kinds[kind]->stiffness(t->list + kind, full, scale, sight, y);
}

double flow_elements_energy(const duite_call *call, const struct flow_table *t,
                            const struct flow_view *view, double torque[3])
{
    double sum = 0;
    if (!flow_has_elements(t))
        return 0;
    const struct phys_sight sight = flow_elements_see(call, t, view);
    for (int i = 0; i < ELEMENT_KINDS; i++) {
        const struct element_kind *kind = element_kinds[i];
        if (t->n_elements[i] && kind->torque)
            kind->torque(t->list + i, &sight, torque);
        if (t->n_elements[i] && kind->pairs)
            sum += kind->energy(t->list + i, &sight);
    }
    return sum;
}

void flow_elements_assemble(const duite_call *call, const struct flow_table *t, double h,
                            double push, const struct phys_sight *sight, phys_vec *b,
                            struct phys_pair *sums)
{
    enum { AT_ONCE = 32 }; /* elements, whose pairs stay in the nearest cache */
    const struct phys_step step = {h, flow_of(call)->model->full_slope == PHYS_FULL};
    struct phys_pair pair[AT_ONCE * ELEMENT_PAIRS];
    for (int i = 0; i < ELEMENT_KINDS; i++) {
        const struct element_kind *kind = element_kinds[i];
        const struct phys_elements *list = t->list + i;
        for (uint32_t from = 0, n; kind->pairs && from < list->n; from += n) {
            const uint32_t *at = list->at + kind->pairs * (size_t)from;
            n = list->n - from < AT_ONCE ? list->n - from : AT_ONCE;
            if (b && kind->system)
                kind->system(list, from, from + n, &step, push, sight, at, b, pair);
            else
                kind->matrix(list, from, from + n, &step, sight, at, pair);
            solve_assemble_pairs(kind->pairs * (size_t)n, at, pair, sums);
        }
    }
}
