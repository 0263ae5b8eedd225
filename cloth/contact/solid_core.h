#ifndef CLOTH_CONTACT_SOLID_CORE_H
#define CLOTH_CONTACT_SOLID_CORE_H

#include "cloth/contact/direction.h"
#include "cloth/contact/solid.h"

#include <math.h>

/* Shared by the files of this topic: a triangle in the axes of a core, and the core itself. */

PHYS_INLINE double contact_inner(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* n.x of each lane. */
PHYS_INLINE void contact_heights(const struct contact_lanes *x, const double n[3], phys_vec *height)
{
    *height = (n[0] * x->c[0] + n[1] * x->c[1]) + n[2] * x->c[2];
}

/* The axes of the core at one end. Lane k is corner k of the triangle, lane 3 its middle. */
PHYS_INLINE void contact_core_lanes(const struct contact_place *place, const phys_vec x[3],
                                    struct contact_lanes *own)
{
    const phys_vec middle = (x[0] + x[1] + x[2]) / 3, at[4] = {x[0], x[1], x[2], middle};
    struct contact_lanes room;
    contact_lanes_of(&place->at, at, &room);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        contact_heights(&room, place->axis[c], own->c + c);
}

/* The least of the three corners. */
PHYS_INLINE double contact_least(const phys_vec *along)
{
    const double a = (*along)[0], b = (*along)[1], c = (*along)[2], least = a < b ? a : b;
    return least < c ? least : c;
}

/* Directions: from the room to the axes of the core, and back. */
PHYS_INLINE void contact_way_in(const struct contact_place *place, const double way[3],
                                double own[3])
{
    for (int c = 0; c < 3; c++)
        own[c] = contact_inner(place->axis[c], way);
}
PHYS_INLINE void contact_way_out(const struct contact_place *place, const double own[3],
                                 double way[3])
{
    for (int c = 0; c < 3; c++)
        way[c] =
            own[0] * place->axis[0][c] + own[1] * place->axis[1][c] + own[2] * place->axis[2][c];
}

PHYS_INLINE double contact_core_within(double value, double half)
{
    const double below = value < half ? value : half;
    return below > -half ? below : -half;
}

/* The way to a point, in the core's axes, from the point of the core that is nearest to it. */
PHYS_INLINE void contact_core_away(const struct contact_solid *solid, const double x[3],
                                   double away[3])
{
    away[0] = x[0] - contact_core_within(x[0], solid->half[0]);
    if (solid->round) {
        const double far = sqrt(x[1] * x[1] + x[2] * x[2]);
        const double part = far > solid->half[1] ? 1 - solid->half[1] / far : 0;
        away[1] = part * x[1];
        away[2] = part * x[2];
        return;
    }
    away[1] = x[1] - contact_core_within(x[1], solid->half[1]);
    away[2] = x[2] - contact_core_within(x[2], solid->half[2]);
}

/* The support function of the core along a direction of any length. */
PHYS_INLINE double contact_core_support(const struct contact_solid *solid, const double n[3])
{
    const double along = fabs(n[0]) * solid->half[0];
    if (solid->round)
        return along + solid->half[1] * sqrt(n[1] * n[1] + n[2] * n[2]);
    return along + fabs(n[1]) * solid->half[1] + fabs(n[2]) * solid->half[2];
}

/* Weights, normal (in the core's axes) and gap of a triangle there. */
void contact_core_nearest(const struct contact_solid *solid, const struct contact_lanes *own,
                          struct contact_solid_point *to);

#endif
