/* Elements see rows of neighbours as copies, which a task takes from the rims where it runs; each
 * worker has room for those of one block. Kinds are worked on in their order, each in that of its
 * list. */
#include "cloth/flow/tasks/bodies.h"

#include "cloth/solve/assemble.h"

static bool has_elements(const struct flow_table *t)
{
    bool has = false;
    for (int kind = 0; kind < FLOW_KINDS; kind++)
        has = has || t->n_elements[kind];
    return has;
}

/* The rows that the block copies, of the vector whose rims are the parameters from `rims` on. */
static const phys_vec *copy_rims(const duite_call *call, const struct flow_table *t, size_t rims,
                                 phys_vec *copy)
{
    for (uint32_t s = 0; s < t->n_slots; s++) {
        const phys_vec *rim = duite_in(call, rims + s, phys_vec);
        for (uint32_t i = t->copies[s]; i < t->copies[s + 1]; i++)
            copy[i] = rim[t->copy[i]];
    }
    return copy;
}

/* x and v are parameters 1 and 2, their rims come from parameter 4 on. */
static struct phys_sight look(const duite_call *call, const struct flow_table *t)
{
    const struct flow *flow = flow_of(call);
    phys_vec *room = flow->copies + call->worker * flow->n_copies;
    return (struct phys_sight){.n = t->n,
                               .x = duite_in(call, 1, phys_vec),
                               .v = duite_in(call, 2, phys_vec),
                               .x_copy = copy_rims(call, t, 4, room),
                               .v_copy = copy_rims(call, t, 4 + t->n_slots, room + t->n_copies)};
}

void flow_elements_force(const duite_call *call, const struct flow_table *t, phys_vec *f)
{
    if (!has_elements(t))
        return;
    const struct phys_sight sight = look(call, t);
    const struct phys_triangles triangles = flow_table_triangles(t);
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    phys_triangles_force(&triangles, &sight, f);
    phys_hinges_force(&hinges, &sight, f);
    phys_folds_force(&folds, &sight, f);
    phys_air_force(&flow_of(call)->model->air, t->n_elements[FLOW_SAILS],
                   (const uint32_t(*)[4])t->list[FLOW_SAILS].corner, &sight, f);
}

void flow_elements_stiffness(const duite_call *call, const struct flow_table *t, double scale,
                             phys_vec *y)
{
    const int full = flow_of(call)->model->full_slope;
    if (!has_elements(t))
        return;
    const struct phys_sight sight = look(call, t);
    const struct phys_triangles triangles = flow_table_triangles(t);
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    phys_triangles_stiffness(&triangles, full, scale, &sight, y);
    phys_hinges_stiffness(&hinges, full, scale, &sight, y);
    phys_folds_stiffness(&folds, scale, &sight, y);
}

/* The same without speeds; rims of x from parameter `rims` on. */
static struct phys_sight look_still(const duite_call *call, const struct flow_table *t, size_t rims)
{
    const struct flow *flow = flow_of(call);
    phys_vec *room = flow->copies + call->worker * flow->n_copies;
    return (struct phys_sight){
        .n = t->n, .x = duite_in(call, 1, phys_vec), .x_copy = copy_rims(call, t, rims, room)};
}

double flow_elements_energy(const duite_call *call, const struct flow_table *t, size_t rims)
{
    if (!has_elements(t))
        return 0;
    const struct phys_sight sight = look_still(call, t, rims);
    const struct phys_triangles triangles = flow_table_triangles(t);
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    return phys_triangles_energy(&triangles, &sight) + phys_hinges_energy(&hinges, &sight) +
           phys_folds_energy(&folds, &sight);
}

enum { AT_ONCE = 32 }; /* elements, whose pairs stay in the nearest cache */

/* Elements from .. to - 1 of one kind. */
static void pairs_of(const struct flow_table *t, enum flow_kind kind, uint32_t from, uint32_t to,
                     const struct phys_step *step, const struct phys_sight *sight,
                     struct phys_pair *pair)
{
    const struct phys_triangles triangles = flow_table_triangles(t);
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    switch (kind) {
    case FLOW_TRIANGLES:
        phys_triangles_matrix(&triangles, from, to, step, sight, pair);
        break;
    case FLOW_HINGES:
        phys_hinges_matrix(&hinges, from, to, step, sight, pair);
        break;
    case FLOW_FOLDS:
    case FLOW_SAILS:
    case FLOW_KINDS:
        phys_folds_matrix(&folds, from, to, step->h, pair);
        break;
    }
}

void flow_elements_assemble(const duite_call *call, const struct flow_table *t, double h,
                            size_t rims, double *sums)
{
    const struct phys_step step = {h, flow_of(call)->model->full_slope};
    struct phys_pair pair[AT_ONCE * PHYS_BEND_PAIRS];
    if (!has_elements(t))
        return;
    const struct phys_sight sight = look_still(call, t, rims);
    for (int kind = 0; kind < FLOW_SAILS; kind++)
        for (uint32_t from = 0; from < t->n_elements[kind]; from += AT_ONCE) {
            const uint32_t left = t->n_elements[kind] - from, n = left < AT_ONCE ? left : AT_ONCE;
            pairs_of(t, (enum flow_kind)kind, from, from + n, &step, &sight, pair);
            solve_assemble_pairs(flow_pairs[kind] * (size_t)n,
                                 t->list[kind].at + flow_pairs[kind] * (size_t)from, pair, sums);
        }
}
