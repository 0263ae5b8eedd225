/* Elements see rows of neighbours as copies, which a task takes from the rims where it runs; each
 * worker has room for those of one block. Kinds are worked on in their order, each in that of its
 * list. */
#include "cloth/flow/bodies.h"

#include "cloth/solve/assemble.h"

bool flow_has_elements(const struct flow_table *t)
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

struct phys_sight flow_elements_see_still(const duite_call *call, const struct flow_table *t,
                                          size_t rims)
{
    const struct flow *flow = flow_of(call);
    phys_vec *room = flow->copies + call->worker * flow->n_copies;
    return (struct phys_sight){
        .n = t->n, .x = duite_in(call, 1, phys_vec), .x_copy = copy_rims(call, t, rims, room)};
}

struct phys_sight flow_elements_see(const duite_call *call, const struct flow_table *t, size_t rims)
{
    const struct flow *flow = flow_of(call);
    phys_vec *room = flow->copies + call->worker * flow->n_copies + t->n_copies;
    struct phys_sight sight = flow_elements_see_still(call, t, rims);
    sight.v = duite_in(call, 2, phys_vec);
    sight.v_copy = copy_rims(call, t, rims + t->n_slots, room);
    return sight;
}

void flow_elements_bend(const duite_call *call, const struct flow_table *t,
                        const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    const struct model *model = flow_of(call)->model;
    phys_hinges_force(&hinges, sight, f);
    phys_folds_force(&folds, sight, f);
    struct phys_air air = model->air;
    const double course = model_course_at(model, model->wind_course, flow_args_of(call)->now);
    for (int i = 0; i < 3; i++)
        air.wind[i] *= course;
    phys_air_force(&air, t->n_elements[FLOW_SAILS],
                   (const uint32_t(*)[4])t->list[FLOW_SAILS].corner, sight, f);
}

void flow_elements_force(const duite_call *call, const struct flow_table *t,
                         const struct phys_sight *sight, phys_vec *f)
{
    const struct phys_triangles triangles = flow_table_triangles(t);
    phys_triangles_force(&triangles, sight, f);
    flow_elements_bend(call, t, sight, f);
}

void flow_elements_stiffness(const duite_call *call, const struct flow_table *t, double scale,
                             const struct phys_sight *sight, phys_vec *y)
{
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    phys_hinges_stiffness(&hinges, flow_of(call)->model->full_slope == PHYS_FULL, scale, sight, y);
    phys_folds_stiffness(&folds, scale, sight, y);
}

double flow_elements_energy(const duite_call *call, const struct flow_table *t, size_t rims,
                            double torque[3])
{
    if (!flow_has_elements(t))
        return 0;
    const struct phys_sight sight = flow_elements_see_still(call, t, rims);
    const struct phys_triangles triangles = flow_table_triangles(t);
    const struct phys_hinges hinges = flow_table_hinges(t);
    const struct phys_folds folds = flow_table_folds(t);
    phys_triangles_torque(&triangles, &sight, torque);
    return phys_triangles_energy(&triangles, &sight) + phys_hinges_energy(&hinges, &sight) +
           phys_folds_energy(&folds, &sight);
}

/* What is assembled of elements. */
struct assembly {
    const struct flow_table *t;
    struct phys_step step;
    double push;
    const struct phys_sight *sight;
    phys_vec *b; /* NULL: the matrix alone */
};

/* Elements from .. to - 1 of one kind. */
static void pairs_of(const struct assembly *a, enum flow_kind kind, uint32_t from, uint32_t to,
                     const uint32_t *at, struct phys_pair *pair)
{
    const struct phys_triangles triangles = flow_table_triangles(a->t);
    const struct phys_hinges hinges = flow_table_hinges(a->t);
    const struct phys_folds folds = flow_table_folds(a->t);
    switch (kind) {
    case FLOW_TRIANGLES:
        if (a->b)
            phys_triangles_system(&triangles, from, to, &a->step, a->push, a->sight, at, a->b,
                                  pair);
        else
            phys_triangles_matrix(&triangles, from, to, &a->step, a->sight, at, pair);
        break;
    case FLOW_HINGES:
        phys_hinges_matrix(&hinges, from, to, &a->step, a->sight, at, pair);
        break;
    case FLOW_FOLDS:
    case FLOW_SAILS:
    case FLOW_KINDS:
        phys_folds_matrix(&folds, from, to, a->step.h, pair);
        break;
    }
}

void flow_elements_assemble(const duite_call *call, const struct flow_table *t, double push,
                            const struct phys_sight *sight, phys_vec *b, struct phys_pair *sums)
{
    enum { AT_ONCE = 32 }; /* elements, whose pairs stay in the nearest cache */
    const struct assembly assembly = {
        t, {flow_args_of(call)->h, flow_of(call)->model->full_slope == PHYS_FULL}, push, sight, b};
    struct phys_pair pair[AT_ONCE * PHYS_BEND_PAIRS];
    for (int kind = 0; kind < FLOW_SAILS; kind++)
        for (uint32_t from = 0; from < t->n_elements[kind]; from += AT_ONCE) {
            const uint32_t left = t->n_elements[kind] - from, n = left < AT_ONCE ? left : AT_ONCE;
            const uint32_t *at = t->list[kind].at + flow_pairs[kind] * (size_t)from;
            pairs_of(&assembly, (enum flow_kind)kind, from, from + n, at, pair);
            solve_assemble_pairs(flow_pairs[kind] * (size_t)n, at, pair, sums);
        }
}
