#ifndef CLOTH_CONTACT_ROW_H
#define CLOTH_CONTACT_ROW_H

#include "cloth/physics/vec.h"

#include <math.h>
#include <stdbool.h>

/* A contact as the solves of a step see it: a force between a point of the first side and one of
 * the second. The difference of both is the sum of weight times place over the corners of the
 * contact, `point` below (m). Along the normal the force is that of an augmented Lagrangian, max(0,
 * load + k (aim - gap)). The multiplier `load` carries the resting weight, so k may be soft. Across
 * the normal it is a spring, cut to friction times the load (Coulomb's law): `slip` is how far it
 * is stretched. Steps are implicit, so the force is that of the end of the step.
 *
 * A contact gives back no more energy than it took up: `energy` is the work that its force along
 * the normal did on it so far. A spring of stiffness k that pushes with F holds F^2 / 2k. So a step
 * begins with a push of sqrt(2 k energy) at most. It starts from the load of the step before and,
 * if the gap is below the thickness, lifts towards it as far as the energy allows. A contact that
 * rests too deep without energy is lifted slowly, with lent energy (contact_row_lent). Pure
 * functions; N, m, N/m, J. */
struct contact_row {
    phys_vec normal; /* out of the second side, of length 1 */
    phys_vec origin; /* the point where the step began */
    phys_vec slip;   /* across the normal where the step began, less the way that the second side
                      * carries the point along in the step */
    double gap;      /* at the origin, to the second side where it ends the step */
    double load;
    double thickness, friction;
    double stiffness;      /* k */
    double slid;           /* the stretch of the spring at the end of the step before, uncut, and */
    double grows;          /* the factor by which it grew in that step; 0: as 1 */
    double firm;           /* how many times as stiff as others it is; 1 or less: as stiff */
    double energy, rested; /* where the step began: the work taken up so far, the load */
    double start, aim;     /* the gap there; the gap where the push is the load */
    double hold, span;     /* stiffness across the normal; length of the step, s: of the step before
                            * until this one begins */
    double pushed; /* by the solve before of the same step: 1 it was, -1 it was not; 0: there was
                    * none */
};

/* Numbers of the law (docs/physics.md), none of which has a unit: lengths are parts of the
 * thickness, forces of the load, stiffnesses of that of other contacts. */

/* A contact with a load that opens by less beyond the thickness stays active in the step: what
 * rests would bounce else. */
#define CONTACT_ROW_OPENS 0.1
/* Part of the lack of a gap to the thickness that a step makes up for. A mass resting on a contact
 * swings if this is more than k h^2 / mass, as in piles; it is so for less than m / 8 then. */
#define CONTACT_ROW_RISES 0.125
/* The same for a contact that was made stiffer, as its pair failed: a wrung sheet finds no room
 * with less. */
#define CONTACT_ROW_YIELDS 0.5
/* The same where a load rests, though the row has not taken up the energy for it. With an eighth a
 * pile of eight sheets of 2 mm jumps by millimetres every second; with this it rests. */
#define CONTACT_ROW_LIFTS 0.02
/* Part of the resting load: an account of energy that lets a push begin with so little less than
 * that has nothing to give, but for rounding. */
#define CONTACT_ROW_EMPTY 1e-6
/* How many times as stiff a contact becomes whose pair fails although it is there, and at most: so
 * wrung cloth needs fewer solves and no halved steps. A step that is accepted takes the last of
 * these away. */
#define CONTACT_ROW_FIRMER  4
#define CONTACT_ROW_FIRMEST 256
#define CONTACT_ROW_SOFTENS 0.5
/* A new contact has this times the part of the thickness that is lacking: it stops an approach
 * within about half the thickness. */
#define CONTACT_ROW_STOPS 2
/* The stretch across the normal is expected to grow by this factor at most, or to shrink: what
 * begins to slide stretches the spring from 0. */
#define CONTACT_ROW_GROWS 2

/* A step begins, or is solved again, with a row that has the gap of its begin. stiffness: of rows
 * that are not firm; h: s, its length. */
PHYS_INLINE void contact_row_begin(struct contact_row *row, double stiffness, double h)
{
    const double firm = row->firm > 1 ? row->firm : 1, k = stiffness * firm;
    const double lacks = row->thickness - row->gap;
    const double rises = firm > 1 ? CONTACT_ROW_YIELDS : CONTACT_ROW_RISES;
    const double rise = lacks > 0 ? rises * lacks : lacks;
    const double most = (sqrt(2 * k * row->energy) - row->rested) / k;
    const double softer = row->hold > 0 ? row->hold / stiffness : 1;
    const double lifts = lacks > 0 && row->rested > 0 && most * k > -CONTACT_ROW_EMPTY * row->rested
                             ? CONTACT_ROW_LIFTS * lacks
                             : most;
    const double allowed = firm > 1 && lacks > 0 ? rise : (most > lifts ? most : lifts);
    const double push = row->rested + k * (rise < allowed ? rise : allowed);
    const double needs = push > 0 ? 0.5 * push * push / k : 0;
    row->energy = fmax(row->energy, needs);
    row->start = row->gap;
    row->aim = row->gap + (rise < allowed ? rise : allowed);
    row->stiffness = k;
    row->hold = stiffness;
    row->slid *= row->span > 0 ? h / row->span : 1;
    row->span = h;
    row->slip *= softer < 1 ? softer : sqrt(softer);
}

/* The gap at a point. */
PHYS_INLINE double contact_row_gap(const struct contact_row *row, const phys_vec *point)
{
    const phys_vec way = *point - row->origin;
    return row->gap + phys_dot(&row->normal, &way);
}

/* The stretch of the spring across the normal at a point. */
PHYS_INLINE void contact_row_stretch(const struct contact_row *row, const phys_vec *point,
                                     phys_vec *stretch)
{
    const phys_vec way = *point - row->origin + row->slip;
    *stretch = way - phys_dot(&row->normal, &way) * row->normal;
}

/* The force along the normal if the step ends at this point; below 0: it would pull. */
PHYS_INLINE double contact_row_push(const struct contact_row *row, const phys_vec *point)
{
    return row->load + row->stiffness * (row->aim - contact_row_gap(row, point));
}

/* The stiffness across the normal at a stretch: softer where the spring would pull more than
 * friction allows it, the secant of Coulomb's law. It is that of the expected stretch, if this
 * grows as in the step before. */
PHYS_INLINE double contact_row_across(const struct contact_row *row, const phys_vec *stretch)
{
    const double most = row->friction * row->load;
    const double length = sqrt(phys_dot(stretch, stretch)) * (row->grows > 0 ? row->grows : 1);
    return most < row->hold * length ? most / length : (most > 0 ? row->hold : 0);
}

/* True if the contact is in the matrix when the step ends with this gap and push: it presses, or
 * has a load and hardly opens. If the step was solved before, that solve decides: an active set. */
PHYS_INLINE bool contact_row_acts(const struct contact_row *row, double gap, double push)
{
    const bool stays =
        push > 0 || (row->load > 0 && gap < (1 + CONTACT_ROW_OPENS) * row->thickness);
    return row->pushed != 0 ? row->pushed > 0 : stays;
}

/* The force on the first side if the step ends at this point, and its negative derivative alpha I +
 * w w' as a spring's value has it: w, alpha. Both are zero if the contact is not active. A contact
 * with a load that hardly opens stays for this step, and leaves in the next one if it was pulled:
 * so resting contacts do not bounce. A positive stiffness across takes energy away in a step of any
 * length. */
PHYS_INLINE void contact_row_linearise(const struct contact_row *row, const phys_vec *point,
                                       phys_vec *force, phys_vec *value)
{
    const double gap = contact_row_gap(row, point), push = contact_row_push(row, point);
    *force = *value = (phys_vec){0};
    if (!contact_row_acts(row, gap, push))
        return;
    phys_vec stretch;
    contact_row_stretch(row, point, &stretch);
    const double across = contact_row_across(row, &stretch);
    *force = push * row->normal - across * stretch;
    *value = sqrt(row->stiffness - across) * row->normal + (phys_vec){0, 0, 0, across};
}

/* The step is to be solved once more from its begin: the load becomes the force along the normal
 * that it ended with. */
PHYS_INLINE void contact_row_press(struct contact_row *row, const phys_vec *point)
{
    const double push = contact_row_push(row, point);
    row->load = push > 0 ? push : 0;
    row->pushed = push > 0 ? 1 : -1;
}

/* The force on the first side in a step that ended at this point, by the linear solve that had this
 * value. Friction has the stiffness that it had there. */
PHYS_INLINE void contact_row_force(const struct contact_row *row, const phys_vec *point,
                                   const phys_vec *value, phys_vec *force)
{
    const double across = (*value)[3];
    const phys_vec w = *value * (phys_vec){1, 1, 1, 0};
    const double both = phys_dot(&w, &w) + across;
    phys_vec stretch;
    *force = (phys_vec){0};
    if (!(both > 0))
        return;
    contact_row_stretch(row, point, &stretch);
    *force =
        contact_row_push(row, point) * row->normal - row->stiffness * (across / both) * stretch;
}

/* A contact whose pair fails again takes more than others can give: it is made stiffer while that
 * lasts, and softer from step to step after it. */
PHYS_INLINE void contact_row_stiffen(struct contact_row *row)
{
    const double firm = CONTACT_ROW_FIRMER * (row->firm > 1 ? row->firm : 1);
    row->firm = firm < CONTACT_ROW_FIRMEST ? firm : CONTACT_ROW_FIRMEST;
}

/* The firmness of a row without a load that would end the step with this gap (m). */
PHYS_INLINE double contact_row_firm_for(const struct contact_row *row, double gap)
{
    const double firm = CONTACT_ROW_STOPS * (1 - gap / row->thickness);
    return firm > 1 ? (firm < CONTACT_ROW_FIRMEST ? firm : CONTACT_ROW_FIRMEST) : 0;
}

/* The energy that a row has taken up when the step ended at this point with this load, but no more
 * than can be of use. */
PHYS_INLINE double contact_row_energy(const struct contact_row *row, const phys_vec *point,
                                      double load)
{
    const double energy = row->energy + load * (row->start - contact_row_gap(row, point));
    const double push = load + row->stiffness * row->thickness;
    const double most = 0.5 * push * push / row->stiffness;
    return energy > 0 ? (energy < most ? energy : most) : 0;
}

/* The energy lent to a contact in a step that ended at this point: its energy after the step, plus
 * the work of its push, less its energy before. after: 0 if the contact ended. A push gives too
 * much if the solve before raised the load of a step that opens in the end. */
PHYS_INLINE double contact_row_lent(const struct contact_row *row, const phys_vec *point,
                                    double before, double after)
{
    const double gap = contact_row_gap(row, point), push = contact_row_push(row, point);
    const double gave = contact_row_acts(row, gap, push) ? push * (gap - row->start) : 0;
    return fmax(after + gave - before, 0);
}

/* The energy in the row of a coming step: its own, and that of the spring across. */
PHYS_INLINE double contact_row_holds(const struct contact_row *row)
{
    return row->energy + 0.5 * row->hold * phys_dot(&row->slip, &row->slip);
}

/* Fills the next step's row after a step that ended at this point. Stretch beyond friction's hold
 * becomes sliding. */
PHYS_INLINE void contact_row_end(const struct contact_row *row, const phys_vec *point,
                                 struct contact_row *next)
{
    phys_vec stretch;
    contact_row_stretch(row, point, &stretch);
    const double push = contact_row_push(row, point), load = push > 0 ? push : 0;
    const double length = sqrt(phys_dot(&stretch, &stretch));
    const double most = row->friction * load, pull = row->hold * length;
    const double grows = row->slid > 0 ? length / row->slid : 1;
    next->slid = length;
    const double most_grown = CONTACT_ROW_GROWS, least_grown = 1.0 / CONTACT_ROW_GROWS;
    next->grows = grows < most_grown ? (grows > least_grown ? grows : least_grown) : most_grown;
    next->slip = pull <= most ? stretch : most / pull * stretch;
    next->slip -= phys_dot(&next->normal, &next->slip) * next->normal;
    next->load = next->rested = load;
    next->energy = contact_row_energy(row, point, load);
    next->hold = row->hold;
    next->span = row->span;
    next->pushed = 0;
    next->firm = fmax(next->firm, CONTACT_ROW_SOFTENS * row->firm);
}

#endif
