#ifndef CLOTH_CONTACT_SOLID_DIVIDE_H
#define CLOTH_CONTACT_SOLID_DIVIDE_H

#include "cloth/contact/solid_core.h"

/* Shared by solid.c and solid_cut.c: the three numbers of solid.h, of a triangle and a pair of
 * directions. */

/* The relative rounding of all operations on numbers of one size together. */
#define CONTACT_SOLID_ROUNDING (64 * 0x1p-53)

/* A triangle in the core's axes: its begin and its end as each end of the step sees them. */
struct contact_solid_triangle {
    struct contact_lanes from, to;
    double rounding; /* m: the error of this triangle's numbers; not finite if the triangle is
                      * not */
};

PHYS_INLINE double contact_lanes_size(const struct contact_lanes *own)
{
    phys_vec sum = {0};
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const contact_mask sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
        sum += (phys_vec)((contact_mask)own->c[c] & sign);
    }
    return phys_lanes(&sum);
}

PHYS_INLINE void contact_triangle_of(const struct contact_solid *solid, const phys_vec x[3],
                                     const phys_vec y[3], struct contact_solid_triangle *triangle)
{
    contact_core_lanes(solid->place + CONTACT_BEGIN, x, &triangle->from);
    contact_core_lanes(solid->place + CONTACT_END, y, &triangle->to);
    triangle->rounding = CONTACT_SOLID_ROUNDING * (contact_lanes_size(&triangle->from) +
                                                   contact_lanes_size(&triangle->to) + solid->size);
}

/* Directions n0 of the begin (early) and n1 of the end (late), in the core's axes at the begin [0]
 * and at the end [1]. reach: the support functions of solid.h along them. */
struct contact_solid_divide {
    double early[2][3], late[2][3];
    double reach[3];
};

/* A direction of one end in the core's axes, as the other end sees it. */
PHYS_INLINE void contact_other_end(const struct contact_solid *solid, enum contact_end end,
                                   const double way[3], double there[3])
{
    double out[3] = {way[0], way[1], way[2]};
    if (solid->moves)
        contact_way_out(solid->place + end, way, out);
    for (int c = 0; c < 3; c++)
        there[c] = solid->moves ? contact_inner(solid->place[!end].axis[c], out) : out[c];
}

/* Makes the pair of a direction in the core's axes at the begin and one at the end. */
PHYS_INLINE void contact_divide_by(const struct contact_solid *solid, const double early[3],
                                   const double late[3], struct contact_solid_divide *divide)
{
    double both[3];
    contact_other_end(solid, CONTACT_BEGIN, early, divide->early[1]);
    contact_other_end(solid, CONTACT_END, late, divide->late[0]);
    for (int c = 0; c < 3; c++) {
        divide->early[0][c] = early[c];
        divide->late[1][c] = late[c];
        both[c] = divide->early[1][c] + divide->late[0][c];
    }
    divide->reach[0] = contact_core_support(solid, early) + solid->radius;
    divide->reach[1] = contact_core_support(solid, both) / 2 + solid->radius;
    divide->reach[2] = contact_core_support(solid, late) + solid->radius;
}

/* The three numbers of each corner, by lanes. */
PHYS_INLINE void contact_numbers(const struct contact_solid_divide *divide,
                                 const struct contact_lanes *from, const struct contact_lanes *to,
                                 phys_vec number[3])
{
    phys_vec before, after;
    contact_heights(from, divide->early[0], number);
    contact_heights(from, divide->late[0], &before);
    contact_heights(to, divide->early[1], &after);
    contact_heights(to, divide->late[1], number + 2);
    number[0] -= divide->reach[0];
    number[1] = (before + after) / 2 - divide->reach[1];
    number[2] -= divide->reach[2];
}

/* The least of each of the numbers: certificate.h has the rule. gap: that at the begin. */
PHYS_INLINE void contact_numbers_due(double gap, double thickness, double rounding, double due[3])
{
    const double least = CONTACT_MARGIN / 2 + rounding, margin = CONTACT_MARGIN + rounding;
    const double keep = gap / 2 < 0.1 * thickness ? gap / 2 : 0.1 * thickness;
    const double enough = keep > margin ? keep : margin, opens = gap > least ? gap : least;
    due[0] = due[1] = least;
    due[2] = enough < opens ? enough : opens;
}

/* Pairs of directions that may divide, made of the nearest directions at both ends, in the core's
 * axes: either one, fixed in the room; the one, then the other; their mean, fixed in the room;
 * either one, or their mean, carried along by the shape. A plane has the third alone. The last
 * three add none for a shape that stands still. */
enum { CONTACT_DIVIDES = 7, CONTACT_DIVIDES_STILL = 4, CONTACT_DIVIDES_BOTH = 2 };

PHYS_INLINE int contact_first_divide(const struct contact_solid *solid)
{
    return solid->endless ? CONTACT_DIVIDES_BOTH : 0;
}

PHYS_INLINE int contact_last_divide(const struct contact_solid *solid)
{
    return solid->endless ? CONTACT_DIVIDES_BOTH
                          : (solid->moves ? CONTACT_DIVIDES : CONTACT_DIVIDES_STILL) - 1;
}
void contact_divide_pair(const struct contact_solid *solid, int i, const double begin[3],
                         const double end[3], struct contact_solid_divide *divide);

/* Along it, in the core's axes, a triangle is farther from the shape than along any other; returns
 * how far, m. */
double contact_nearest_way(const struct contact_solid *solid, const struct contact_lanes *own,
                           double way[3]);

#endif
