/* A soft pin pulls a vertex by a spring and a damper to the place a where a pin would hold it:
 *
 *     f = -s (k (x - a) + c (v - w))
 *
 * a is its start, or the place to which a motion or an obstacle takes that; s is the curve; both
 * are those of the forces' time, the end of the step for implicit ones. w is the mean velocity of a
 * over the step, as pins that move have it.
 *
 * The force is linear, and alike in all directions. So its part of an implicit step's matrix, h c +
 * h^2 k, is exact: a number >= 0 on the diagonal of its own row. Pins of a row add up, in the order
 * of the scene. */
#include "cloth/base/order.h"
#include "cloth/flow/pins/sliders.h"

/* The soft pins of a block in a step, one after the other. */
struct soft_walk {
    const struct flow_table *table;
    const struct model *model;
    double length;                    /* s: of the step; 0: before the first one */
    struct flow_pins now, begin, end; /* at the time of the forces, and where the step begins and
                                       * ends */
    uint32_t curve;                   /* that the factor is of */
    double factor;
};

static void walk_begin(const duite_call *call, const struct flow_table *t,
                       const struct flow_step_args *step, struct soft_walk *walk)
{
    const struct model *model = flow_of(call)->model;
    const double begin = step->begin * model->h / FLOW_TICKS;
    walk->table = t;
    walk->model = model;
    walk->length = step->time - begin;
    walk->curve = 0;
    walk->factor = 1;
    flow_pins_begin(call, t, step->now, &walk->now);
    flow_pins_begin(call, t, begin, &walk->begin);
    flow_pins_begin(call, t, step->time, &walk->end);
}

/* s of a pin. */
static double factor_of(struct soft_walk *walk, uint32_t i)
{
    const uint32_t curve = walk->table->soft_curve[i];
    if (curve != walk->curve)
        walk->factor = model_curve_at(walk->model, curve, walk->now.time);
    walk->curve = curve;
    return walk->factor;
}

/* x - a of a pin. */
static void find_way(struct soft_walk *walk, uint32_t i, const phys_vec *x, phys_vec *way)
{
    const struct flow_table *t = walk->table;
    phys_vec at = t->position[t->soft[i][0]];
    if (t->soft[i][1])
        flow_pins_place(&walk->now, t->soft[i][1], t->position + t->soft[i][0], &at);
    *way = x[t->soft[i][0]] - at;
}

/* v - w of a pin. */
static void find_slip(struct soft_walk *walk, uint32_t i, const phys_vec *v, phys_vec *slip)
{
    const struct flow_table *t = walk->table;
    const uint32_t row = t->soft[i][0], motion = t->soft[i][1];
    phys_vec from, to;
    *slip = v[row];
    if (!motion || !(walk->length > 0))
        return;
    flow_pins_place(&walk->begin, motion, t->position + row, &from);
    flow_pins_place(&walk->end, motion, t->position + row, &to);
    *slip -= (to - from) / walk->length;
}

static void find_pull(struct soft_walk *walk, uint32_t i, const phys_vec *x, const phys_vec *v,
                      phys_vec *pull)
{
    const struct flow_table *t = walk->table;
    phys_vec way, slip;
    find_way(walk, i, x, &way);
    find_slip(walk, i, v, &slip);
    *pull = -factor_of(walk, i) * (t->soft_stiffness[i] * way + t->soft_damping[i] * slip);
}

void flow_soft_force(const duite_call *call, const struct flow_table *t,
                     const struct flow_step_args *step, const phys_vec *x, const phys_vec *v,
                     phys_vec *f)
{
    struct soft_walk walk;
    phys_vec pull;
    if (!t->n_soft)
        return;
    walk_begin(call, t, step, &walk);
    for (uint32_t i = 0; i < t->n_soft; i++) {
        find_pull(&walk, i, x, v, &pull);
        f[t->soft[i][0]] += pull;
    }
}

void flow_soft_pull(const duite_call *call, const struct flow_table *t,
                    const struct flow_step_args *step, uint32_t row, const phys_vec *x,
                    const phys_vec *v, phys_vec *sum)
{
    struct soft_walk walk;
    phys_vec pull;
    uint32_t i = cloth_first_from(t->soft, 2, t->n_soft, row);
    if (i == t->n_soft)
        return;
    walk_begin(call, t, step, &walk);
    for (; i < t->n_soft && t->soft[i][0] == row; i++) {
        find_pull(&walk, i, x, v, &pull);
        *sum += pull;
    }
}

void flow_soft_diagonal(const duite_call *call, const struct flow_table *t,
                        const struct flow_step_args *step, double *diagonal)
{
    const double h = step->h;
    struct soft_walk walk;
    if (!t->n_soft)
        return;
    walk_begin(call, t, step, &walk);
    for (uint32_t i = 0; i < t->n_soft; i++)
        diagonal[t->soft[i][0]] +=
            factor_of(&walk, i) * h * (t->soft_damping[i] + h * t->soft_stiffness[i]);
}

void flow_soft_stiffness(const duite_call *call, const struct flow_table *t,
                         const struct flow_step_args *step, const phys_vec *v, phys_vec *y)
{
    const double square = step->h * step->h;
    struct soft_walk walk;
    if (!t->n_soft)
        return;
    walk_begin(call, t, step, &walk);
    for (uint32_t i = 0; i < t->n_soft; i++)
        y[t->soft[i][0]] -= factor_of(&walk, i) * square * t->soft_stiffness[i] * v[t->soft[i][0]];
}

double flow_soft_energy(const duite_call *call, const struct flow_table *t,
                        const struct flow_step_args *step, const phys_vec *x)
{
    struct soft_walk walk;
    phys_vec way;
    double sum = 0;
    if (!t->n_soft)
        return 0;
    walk_begin(call, t, step, &walk);
    for (uint32_t i = 0; i < t->n_soft; i++) {
        find_way(&walk, i, x, &way);
        sum += 0.5 * factor_of(&walk, i) * t->soft_stiffness[i] * phys_dot(&way, &way);
    }
    return sum;
}
