#ifndef CLOTH_CONTACT_ROW_H
#define CLOTH_CONTACT_ROW_H

#include "cloth/physics/vec.h"

#include <math.h>

/* A contact as the solves of a step see it: a force between a point of the first side and one of
 * the second. The difference of both is the sum of weight times place over the corners of the
 * contact, `point` below (m). Along the normal it is the force of an augmented Lagrangian,
 * max(0, load + k (thickness - gap)): the multiplier `load` carries what rests on the contact, so k
 * may be soft. Across the normal it is a spring, cut to friction times the load (Coulomb's law):
 * `slip` is how far it is stretched. Steps are implicit, so the force is that of the end of the
 * step. Pure functions; N, m, N/m. */
struct contact_row {
    phys_vec normal; /* out of the second side, of length 1 */
    phys_vec origin; /* the point where the step began */
    phys_vec slip;   /* across the normal where the step began, less what the second side carries
                      * the point along in the step */
    double gap;      /* at the origin, to the second side where it ends the step */
    double load;
    double thickness, friction;
    double stiffness; /* k */
    double slid;  /* how far the spring was stretched at the end of the step before, uncut, and */
    double grows; /* by what factor that grew in it; 0: as 1 */
    double firm;  /* how many times as stiff as others it is; 0: as stiff */
};

/* Of the thickness: a contact with a load that opens by less in a step stays one in it. */
#define CONTACT_ROW_OPENS 0.1

/* The gap at a point. */
PHYS_INLINE double contact_row_gap(const struct contact_row *row, const phys_vec *point)
{
    const phys_vec way = *point - row->origin;
    return row->gap + phys_dot(&row->normal, &way);
}

/* How far the spring across the normal is stretched at a point. */
PHYS_INLINE void contact_row_stretch(const struct contact_row *row, const phys_vec *point,
                                     phys_vec *stretch)
{
    const phys_vec way = *point - row->origin + row->slip;
    *stretch = way - phys_dot(&row->normal, &way) * row->normal;
}

/* The force on the first side if the step ends at this point, and its negative derivative
 * alpha I + w w' as a spring's value has it: w, alpha. Both are zero where nothing presses. What
 * has a load and hardly opens stays for this step, and leaves in the next one if it was pulled: so
 * what rests does not bounce. Where the spring across would pull more than friction allows it is
 * softer by so much: the secant of Coulomb's law, which takes energy away in a step of any length.
 * The secant is that of the stretch as it will be, if it grows as it did in the step before. */
PHYS_INLINE void contact_row_linearise(const struct contact_row *row, const phys_vec *point,
                                       phys_vec *force, phys_vec *value)
{
    const double stiffness = row->stiffness;
    const double push = row->load + stiffness * (row->thickness - contact_row_gap(row, point));
    *force = *value = (phys_vec){0};
    const double opens = contact_row_gap(row, point) - row->thickness;
    if (!(push > 0 || (row->load > 0 && opens < CONTACT_ROW_OPENS * row->thickness)))
        return;
    phys_vec stretch;
    contact_row_stretch(row, point, &stretch);
    const double most = row->friction * row->load;
    const double length = sqrt(phys_dot(&stretch, &stretch)) * (row->grows > 0 ? row->grows : 1);
    const double across = most < stiffness * length ? most / length : (most > 0 ? stiffness : 0);
    *force = push * row->normal - across * stretch;
    *value = sqrt(stiffness - across) * row->normal + (phys_vec){0, 0, 0, across};
}

/* The step ended at this point, or is to be solved once more from its begin: the load becomes the
 * force along the normal. */
PHYS_INLINE void contact_row_press(struct contact_row *row, const phys_vec *point)
{
    const double push = row->load + row->stiffness * (row->thickness - contact_row_gap(row, point));
    row->load = push > 0 ? push : 0;
}

/* A contact whose pair fails again takes more than others can give: it is made stiffer while that
 * lasts, and softer from step to step after it. */
PHYS_INLINE double contact_row_firm(const struct contact_row *row)
{
    return row->firm > 1 ? row->firm : 1;
}
PHYS_INLINE void contact_row_stiffen(struct contact_row *row)
{
    const double firm = 4 * contact_row_firm(row);
    row->firm = firm < 256 ? firm : 256;
}

/* The step ended at this point, and the row was pressed: the slip that is left, in the row of the
 * next step. What friction cannot hold has slid. */
PHYS_INLINE void contact_row_slide(const struct contact_row *row, const phys_vec *point,
                                   struct contact_row *next)
{
    phys_vec stretch;
    contact_row_stretch(row, point, &stretch);
    const double length = sqrt(phys_dot(&stretch, &stretch));
    const double most = row->friction * row->load, pull = row->stiffness * length;
    const double grows = row->slid > 0 ? length / row->slid : 1;
    next->slid = length;
    next->grows = grows < 2 ? (grows > 0.5 ? grows : 0.5) : 2;
    next->slip = pull <= most ? stretch : most / pull * stretch;
    next->slip -= phys_dot(&next->normal, &next->slip) * next->normal;
    next->load = row->load;
    next->firm = 0.5 * row->firm;
}

#endif
