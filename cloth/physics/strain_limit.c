/* Edges are worked on in order, four at a time (detail/lanes.h). The force on corner 1 is minus
 * that on corner 0, so that the forces of an edge sum to zero. */
#include "cloth/physics/strain_limit.h"

#include "cloth/physics/detail/lanes.h"

/* Four edges. */
struct edge {
    struct phys_wide u;  /* 0 where an edge has no length */
    phys_vec k, over, t; /* k, and l - l0 and t; these are 0 where an edge is not over its limit */
};

PHYS_INLINE void edge_make(const struct phys_elements *limits, const struct phys_four *four,
                           const struct phys_sight *sight, struct edge *edge)
{
    struct phys_wide a, b;
    phys_vec square, length, inverse, limit;
    phys_gather(four, limits->corner, 0, sight->n, sight->x, sight->x_ghost, &a);
    phys_gather(four, limits->corner, 1, sight->n, sight->x, sight->x_ghost, &b);
    phys_gather_numbers(four, limits->number[PHYS_LIMIT_STIFFNESS], &edge->k);
    phys_gather_numbers(four, limits->number[PHYS_LIMIT_LENGTH], &limit);
    phys_wide_from(&b, &a, &b);
    phys_wide_dot(&b, &b, &square);
    phys_sqrt(&square, &length);
    phys_inverse(&length, &inverse);
    phys_wide_scale(&inverse, &b, &edge->u);
    const phys_vec over = length - limit;
    phys_positive(&over, &edge->over);
    edge->t = edge->over * inverse;
}

/* Adds pull (N along u) to corner 0, and takes it from corner 1. */
PHYS_INLINE void add_pull(const struct phys_elements *limits, const struct phys_four *four,
                          const struct phys_wide *pull, uint32_t n, phys_vec *f)
{
    const phys_vec minus = {-1, -1, -1, -1};
    struct phys_wide back;
    phys_wide_scale(&minus, pull, &back);
    phys_scatter(four, limits->corner, 0, n, pull, f);
    phys_scatter(four, limits->corner, 1, n, &back, f);
}

PHYS_KERNEL(phys_strain_limits_force,
            (const struct phys_elements *limits, const struct phys_air *air,
             const struct phys_sight *sight, phys_vec *f),
            (limits, air, sight, f))
{
    (void)air;
    for (size_t first = 0; first < limits->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct edge edge;
        struct phys_wide pull;
        phys_four_from(first, limits->n, &four);
        edge_make(limits, &four, sight, &edge);
        const phys_vec size = edge.k * edge.over;
        phys_wide_scale(&size, &edge.u, &pull);
        add_pull(limits, &four, &pull, sight->n, f);
    }
}

/* K = along u u' + across I; taut: as if all edges were over their limits. */
PHYS_INLINE void factors_of(const struct edge *edge, int taut, phys_vec *along, phys_vec *across)
{
    const phys_vec zero = {0}, one = {1, 1, 1, 1};
    const phys_mask over = edge->over > zero;
    phys_vec whole;
    phys_choose(&over, &one, &zero, &whole);
    if (taut)
        whole = one;
    *across = edge->k * edge->t;
    *along = edge->k * (whole - edge->t);
}

PHYS_KERNEL(phys_strain_limits_stiffness,
            (const struct phys_elements *limits, int full, double scale,
             const struct phys_sight *sight, phys_vec *y),
            (limits, full, scale, sight, y))
{
    (void)full;
    for (size_t first = 0; first < limits->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct edge edge;
        struct phys_wide a, b, pull;
        phys_vec along, across, speed;
        phys_four_from(first, limits->n, &four);
        edge_make(limits, &four, sight, &edge);
        factors_of(&edge, 0, &along, &across);
        phys_gather(&four, limits->corner, 0, sight->n, sight->v, sight->v_ghost, &a);
        phys_gather(&four, limits->corner, 1, sight->n, sight->v, sight->v_ghost, &b);
        phys_wide_from(&b, &a, &b);
        phys_wide_dot(&edge.u, &b, &speed);
        along *= scale * speed;
        across *= scale;
        phys_wide_mix(&along, &edge.u, &across, &b, &pull);
        add_pull(limits, &four, &pull, sight->n, y);
    }
}

PHYS_INLINE void matrix(const struct phys_elements *limits, size_t from, size_t to, double h,
                        int taut, const struct phys_sight *sight, struct phys_pair *pair)
{
    for (size_t first = from; first < to; first += PHYS_WIDE) {
        struct phys_four four;
        struct edge edge;
        phys_vec along, across, cyclic[3][3];
        phys_four_from(first, to, &four);
        edge_make(limits, &four, sight, &edge);
        factors_of(&edge, taut, &along, &across);
        along *= h * h;
        across *= h * h;
        for (int k = 0; k < 3; k++)
            for (int r = 0; r < 3; r++)
                cyclic[k][r] = along * (edge.u.c[r] * edge.u.c[(r + k) % 3]);
        for (int r = 0; r < 3; r++)
            cyclic[0][r] += across;
        phys_write_pairs(&four, cyclic, 1, pair + (first - from));
    }
}

/* Blocks are symmetric, and whole in either matrix. */
PHYS_KERNEL(phys_strain_limits_matrix,
            (const struct phys_elements *limits, size_t from, size_t to,
             const struct phys_step *step, const struct phys_sight *sight, const uint32_t *at,
             struct phys_pair *pair),
            (limits, from, to, step, sight, at, pair))
{
    (void)at;
    matrix(limits, from, to, step->h, 0, sight, pair);
}

void phys_strain_limits_stiffest(const struct phys_elements *limits, size_t from, size_t to,
                                 const struct phys_step *step, const struct phys_sight *sight,
                                 const uint32_t *at, struct phys_pair *pair)
{
    (void)at;
    matrix(limits, from, to, step->h, 1, sight, pair);
}

PHYS_KERNEL_OF(double, phys_strain_limits_energy,
               (const struct phys_elements *limits, const struct phys_sight *sight),
               (limits, sight))
{
    double sum = 0;
    for (size_t first = 0; first < limits->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct edge edge;
        phys_four_from(first, limits->n, &four);
        edge_make(limits, &four, sight, &edge);
        const phys_vec energy = 0.5 * edge.k * edge.over * edge.over;
        sum = phys_sum_own(&four, limits->corner, sight->n, &energy, sum);
    }
    return sum;
}
