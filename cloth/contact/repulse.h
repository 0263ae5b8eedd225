#ifndef CLOTH_CONTACT_REPULSE_H
#define CLOTH_CONTACT_REPULSE_H

#include "cloth/contact/row.h"

/* A contact as a spring that pushes apart, in the manner of Vassilev, Spanlang & Chrysanthou
 * (2001). It has no state between steps, and no guarantee. Let g be the gap at the point of a row
 * (row.h), u the speed of the point along the normal n, and v its velocity across, both against the
 * second side. The force on the first side is
 *     push n - rub v,   rub = min(friction push / |v|, hold),
 *     push = max(0, k (thickness - g) - c u) where g < thickness, else 0.
 * It never pulls. Sliding contacts slow by Coulomb's law; sticking ones creep as through a fluid.
 * Along v friction does not change with |v|, so its slope is 0 there, and a step would reverse slow
 * motion. So the slope is the part of rub beyond `spare`: with m / h or less, no friction reverses
 * a mass m in a step of h.
 *
 * The slope by the point is still k up to the thickness without a push, and falls to 0 over the
 * band behind it. An implicit step pushes a stiff contact out to where the force ends. Without the
 * slope, the next step would let it fall back in, and it would hop for ever. A slope without a
 * force leaves rest unchanged. Pure functions; N, m, N/m, N s/m. */
struct contact_spring {
    double stiffness, damping; /* k, c */
    double hold;               /* the most that friction resists a velocity by, k h or less */
    double spare;
    double reach; /* thicknesses, >= 1: to the end of the band */
};

/* The force on the first side, and its negative derivatives: by the point stiffness n n', by its
 * velocity damping n n' + rub (I - n n'). */
struct contact_repelled {
    phys_vec force;
    double stiffness, damping, rub;
};

/* speed: of the point against the second side. The row's normal, origin, gap, thickness and
 * friction count. */
PHYS_INLINE void contact_repel(const struct contact_spring *spring, const struct contact_row *row,
                               const phys_vec *point, const phys_vec *speed,
                               struct contact_repelled *to)
{
    const double depth = row->thickness - contact_row_gap(row, point);
    const double band = spring->reach * row->thickness - row->thickness;
    const double along = phys_dot(&row->normal, speed);
    const double push = spring->stiffness * depth - spring->damping * along;
    *to = (struct contact_repelled){0};
    if (depth > -band)
        to->stiffness = spring->stiffness * (depth < 0 ? 1 + depth / band : 1);
    if (!(depth > 0 && push > 0))
        return;
    const phys_vec across = *speed - along * row->normal;
    const double length = sqrt(phys_dot(&across, &across)), most = row->friction * push;
    const double hold = most > 0 ? spring->hold : 0;
    const double rub = most < spring->hold * length ? most / length : hold;
    to->damping = spring->damping;
    to->rub = rub > spring->spare ? rub - spring->spare : 0;
    to->force = push * row->normal - rub * across;
}

/* The loss of a force to a change of velocity in a step of h, over h. It is alpha I + w w' in the
 * form of a spring's value: w, alpha. hold is k h at most, so w is real. */
PHYS_INLINE void contact_repelled_value(const struct contact_repelled *of, const phys_vec *normal,
                                        double h, phys_vec *value)
{
    const double square = of->stiffness + (of->damping - of->rub) / h;
    *value = sqrt(square > 0 ? square : 0) * *normal + (phys_vec){0, 0, 0, of->rub / h};
}

#endif
