/* Hinges are worked on in order, four at a time (detail/lanes.h). The slope of theta at corner 0 is
 * minus the sum of the others, so that a hinge's forces sum to zero but for rounding. */
#include "cloth/physics/bending.h"

#include "cloth/physics/detail/hinge.h"

#include <math.h>

PHYS_KERNEL(phys_hinges_force,
            (const struct phys_elements *hinges, const struct phys_air *air,
             const struct phys_sight *sight, phys_vec *f),
            (hinges, air, sight, f))
{
    (void)air;
    for (size_t first = 0; first < hinges->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_hinge h;
        struct phys_wide v;
        phys_vec k, damping, rest, part, speed = {0};
        phys_four_from(first, hinges->n, &four);
        phys_hinge_make(&four, hinges->corner, sight, &h);
        phys_gather_numbers(&four, hinges->number[PHYS_HINGE_STIFFNESS], &k);
        phys_gather_numbers(&four, hinges->number[PHYS_HINGE_DAMPING], &damping);
        phys_gather_numbers(&four, hinges->number[PHYS_HINGE_REST], &rest);
        for (int i = 0; i < 4; i++) {
            phys_gather(&four, hinges->corner, i, sight->n, sight->v, sight->v_ghost, &v);
            phys_wide_dot(h.slope + i, &v, &part);
            speed += part;
        }
        const phys_vec pull = -(k * (h.s - rest) + damping * h.cosine * speed) * h.cosine;
        for (int i = 0; i < 4; i++) {
            struct phys_wide add;
            phys_wide_scale(&pull, h.slope + i, &add);
            phys_scatter(&four, hinges->corner, i, sight->n, &add, f);
        }
    }
}

/* Factors for a times the slope of d W / d x plus b times that of the damping: of theta's slopes,
 * and of their change. */
struct factors {
    phys_vec slope, change;
};

PHYS_INLINE void factors_of(const struct phys_elements *hinges, const struct phys_four *four,
                            const struct phys_hinge *h, int full, double a, double b,
                            struct factors *factors)
{
    phys_vec k, damping, rest;
    phys_gather_numbers(four, hinges->number[PHYS_HINGE_STIFFNESS], &k);
    phys_gather_numbers(four, hinges->number[PHYS_HINGE_DAMPING], &damping);
    phys_gather_numbers(four, hinges->number[PHYS_HINGE_REST], &rest);
    factors->slope = (a * k + b * damping) * h->cosine * h->cosine;
    factors->change = (phys_vec){0};
    if (!full)
        return;
    factors->slope -= a * k * (h->s - rest) * 0.25 * h->s;
    factors->change = a * k * (h->s - rest) * h->cosine;
}

PHYS_INLINE void stiffness(const struct phys_elements *hinges, int full, double scale,
                           const struct phys_sight *sight, phys_vec *y)
{
    for (size_t first = 0; first < hinges->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_hinge h;
        struct phys_wide v[4], change[4];
        struct factors factors;
        phys_vec speed = {0}, part;
        phys_four_from(first, hinges->n, &four);
        phys_hinge_make(&four, hinges->corner, sight, &h);
        factors_of(hinges, &four, &h, full, scale, 0, &factors);
        for (int i = 0; i < 4; i++) {
            phys_gather(&four, hinges->corner, i, sight->n, sight->v, sight->v_ghost, v + i);
            phys_wide_dot(h.slope + i, v + i, &part);
            speed += part;
        }
        if (full)
            phys_hinge_change(&h, v, change);
        const phys_vec pull = -factors.slope * speed, bent = -factors.change;
        for (int i = 0; i < 4; i++) {
            struct phys_wide add;
            if (full)
                phys_wide_mix(&pull, h.slope + i, &bent, change + i, &add);
            else
                phys_wide_scale(&pull, h.slope + i, &add);
            phys_scatter(&four, hinges->corner, i, sight->n, &add, y);
        }
    }
}

PHYS_KERNEL(phys_hinges_stiffness,
            (const struct phys_elements *hinges, int full, double scale,
             const struct phys_sight *sight, phys_vec *y),
            (hinges, full, scale, sight, y))
{
    if (full)
        stiffness(hinges, 1, scale, sight, y);
    else
        stiffness(hinges, 0, scale, sight, y);
}

/* Changes of theta's slopes by moves of corner j along each axis. */
PHYS_INLINE void changes(const struct phys_hinge *h, int j, struct phys_wide change[3][4])
{
    for (int c = 0; c < 3; c++) {
        struct phys_wide move[4] = {{{{0}}}};
        move[j].c[c] = (phys_vec){1, 1, 1, 1};
        phys_hinge_change(h, move, change[c]);
    }
}

/* The block of corners i and j, with a minus, transposed where at says so. change: by moves of
 * corner j; NULL: left out. */
PHYS_INLINE void write_block(const struct phys_four *four, const struct phys_hinge *h,
                             const struct factors *factors, struct phys_wide (*change)[4], int i,
                             int j, const uint32_t *at, struct phys_pair *pair)
{
    phys_vec n[3][3], cyclic[3][3];
    phys_mask transposed;
    phys_transposed(four, at, PHYS_BEND_PAIRS, &transposed);
    for (int c = 0; c < 3; c++) {
        const phys_vec pull = -factors->slope * h->slope[j].c[c];
        for (int r = 0; r < 3; r++) {
            n[r][c] = pull * h->slope[i].c[r];
            if (change)
                n[r][c] -= factors->change * change[c][i].c[r];
        }
    }
    for (int r = 0; r < 3; r++) {
        const int c = (r + 1) % 3;
        cyclic[0][r] = n[r][r];
        phys_choose(&transposed, &n[c][r], &n[r][c], &cyclic[1][r]);
        phys_choose(&transposed, &n[r][c], &n[c][r], &cyclic[2][c]);
    }
    phys_write_pairs(four, cyclic, PHYS_BEND_PAIRS, pair);
}

PHYS_INLINE void matrix(const struct phys_elements *hinges, size_t from, size_t to,
                        const struct phys_step *step, int full, const struct phys_sight *sight,
                        const uint32_t *at, struct phys_pair *pair)
{
    for (size_t first = from; first < to; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_hinge h;
        struct factors factors;
        struct phys_wide change[3][4];
        size_t k = PHYS_BEND_PAIRS * (first - from);
        phys_four_from(first, to, &four);
        phys_hinge_make(&four, hinges->corner, sight, &h);
        factors_of(hinges, &four, &h, full, step->h * step->h, step->h, &factors);
        for (int j = 1; j < 4; j++) {
            if (full)
                changes(&h, j, change);
            for (int i = 0; i < j; i++, k++)
                write_block(&four, &h, &factors, full ? change : NULL, i, j, at ? at + k : NULL,
                            pair + k);
        }
    }
}

PHYS_KERNEL(phys_hinges_matrix,
            (const struct phys_elements *hinges, size_t from, size_t to,
             const struct phys_step *step, const struct phys_sight *sight, const uint32_t *at,
             struct phys_pair *pair),
            (hinges, from, to, step, sight, at, pair))
{
    if (step->full)
        matrix(hinges, from, to, step, 1, sight, at, pair);
    else
        matrix(hinges, from, to, step, 0, sight, at, pair);
}

PHYS_KERNEL_OF(double, phys_hinges_energy,
               (const struct phys_elements *hinges, const struct phys_sight *sight),
               (hinges, sight))
{
    double sum = 0;
    for (size_t first = 0; first < hinges->n; first += PHYS_WIDE) {
        struct phys_four four;
        struct phys_hinge h;
        phys_vec k, rest;
        phys_four_from(first, hinges->n, &four);
        phys_hinge_make(&four, hinges->corner, sight, &h);
        phys_gather_numbers(&four, hinges->number[PHYS_HINGE_STIFFNESS], &k);
        phys_gather_numbers(&four, hinges->number[PHYS_HINGE_REST], &rest);
        const phys_vec energy = 0.5 * k * (h.s - rest) * (h.s - rest);
        sum = phys_sum_own(&four, hinges->corner, sight->n, &energy, sum);
    }
    return sum;
}

double phys_bend_rigidity(double warp, double weft, const double direction[2])
{
    const double u = direction[0] * direction[0], v = direction[1] * direction[1];
    return u + v > 0 ? (warp * v + weft * u) / (u + v) : 0.5 * (warp + weft);
}

int phys_bend_rest(const double x[12], struct phys_bend_rest *rest)
{
    uint32_t corner[1][4] = {{0, 1, 2, 3}};
    phys_vec row[4];
    for (int i = 0; i < 4; i++)
        row[i] = (phys_vec){x[3 * i], x[3 * i + 1], x[3 * i + 2], 0};
    const struct phys_sight sight = {.n = 4, .x = row};
    struct phys_four four;
    struct phys_hinge h;
    phys_four_from(0, 1, &four);
    phys_hinge_make(&four, corner, &sight, &h);
    double high[2]; /* 1 / height */
    for (int i = 0; i < 2; i++)
        high[i] = h.length[0] * h.hinge_face[i].inverse[0];
    const double length = h.length[0], f[2] = {h.hinge_face[0].foot[0], h.hinge_face[1].foot[0]};
    rest->s = h.s[0];
    rest->shape = 2 * length / (1 / high[0] + 1 / high[1]);
    rest->weight[2] = -high[0];
    rest->weight[3] = -high[1];
    rest->weight[1] = f[0] * high[0] + f[1] * high[1];
    rest->weight[0] = high[0] + high[1] - rest->weight[1];
    return high[0] > 0 && high[1] > 0 && isfinite(rest->shape + rest->weight[0]) ? 0 : -1;
}
