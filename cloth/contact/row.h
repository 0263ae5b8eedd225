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
 * rests too deep without energy is lifted slowly, with lent energy (contact_row_lent).
 *
 * A pinched contact (cloth/flow/contact/pinch.c) is not lifted, as it has no room. Its load goes to
 * the push of compressed cloth at its gap (contact_row_law), faster from step to step, so that what
 * finds room after all is not thrown. Once there it follows that law, as a spring of its slope,
 * while it is pinched. So the force is the same for any length of step, and bounded. Pure
 * functions; N, m, N/m, J. */
struct contact_row {
    phys_vec normal; /* out of the second side, of length 1 */
    phys_vec origin; /* the point where the step began */
    phys_vec slip;   /* across the normal where the step began, less the way that the second side
                      * carries the point along in the step */
    double gap;      /* at the origin, to the second side where it ends the step */
    double load;
    double thickness, friction;
    double hard;           /* N: the area that it presses times the pressure that halves its gap;
                            * 0: it has no law of compression */
    double pinched;        /* 1: solids leave it no room; else 0 */
    double held;           /* for so many steps, halved ones as halves; CONTACT_ROW_FOLLOWS: it
                            * follows the law */
    double stiffness;      /* k */
    double slid;           /* the stretch of the spring at the end of the step before, uncut, and */
    double grows;          /* the factor by which it grew in that step; 0: as 1 */
    double opened;         /* m: by how much the gap grew in that step, and would in the next one at
                            * the same speed */
    double firm;           /* how many times as stiff as others it is; 1 or less: as stiff */
    double energy, rested; /* where the step began: the work taken up so far, the load */
    double start, aim;     /* the gap there; the gap where the push is the load */
    double hold, part;     /* stiffness across the normal; length of the step, of that of steps that
                            * are not halved: of the step before until this one begins */
    double pushed; /* by the solve before of the same step: 1 it was, -1 it was not; 0: there was
                    * none */
};

/* Numbers of the law (docs/physics.md), none of which has a unit: lengths are parts of the
 * thickness, forces of the load, stiffnesses of that of other contacts. */

/* A contact with a load that opens by less beyond the thickness stays active in the step: what
 * rests would bounce else. */
#define CONTACT_ROW_OPENS 0.1
/* The same for a contact that follows the law: it springs open, and must not fall freely in the
 * step in which it would come to rest. */
#define CONTACT_ROW_SPRINGS 0.25
/* Part of the lack of a gap to the thickness that a step makes up for. A mass resting on a contact
 * swings if this is more than k h^2 / mass, as in piles; it is so for less than m / 8 then. */
#define CONTACT_ROW_RISES 0.125
/* The same for a contact that was made stiffer, as its pair failed: a wrung sheet finds no room
 * with less. */
#define CONTACT_ROW_YIELDS 0.5
/* The same where a load rests, though the row has not taken up the energy for it. With an eighth a
 * pile of eight sheets of 2 mm jumps by millimetres every second; with this it rests. */
#define CONTACT_ROW_LIFTS 0.02
/* Part of the thickness: a gap that is off by less is right. A pile has more contacts than ways to
 * move: it would shift load between them for ever, and never rest. */
#define CONTACT_ROW_RIGHT 0.0002
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
/* Part of the thickness: a gap that lacks less has room. Fabrics are measured thick at a hundredth
 * of the pressure that compresses them (KES-C: 49 Pa, 4.9 kPa). */
#define CONTACT_ROW_COUNTS 0.01
/* With so many steps a contact follows the law in any case: its load was there long before. */
#define CONTACT_ROW_FOLLOWS 64
/* The part of the thickness that steps leave open: less of it presses no harder. */
#define CONTACT_ROW_LEFT 0.1
/* The stretch across the normal is expected to grow by this factor at most, or to shrink: what
 * begins to slide stretches the spring from 0. */
#define CONTACT_ROW_GROWS 2

/* ---- Compression ---- */

/* The push of cloth compressed to a gap. */
PHYS_INLINE double contact_row_law(const struct contact_row *row, double gap)
{
    const double left = fmax(gap / row->thickness, CONTACT_ROW_LEFT);
    return left < 1 ? row->hard * (1 / left - 1) : 0;
}

/* Its negative derivative by the gap. */
PHYS_INLINE double contact_row_slope(const struct contact_row *row, double gap)
{
    const double left = fmax(gap / row->thickness, CONTACT_ROW_LEFT);
    return row->hard / (row->thickness * left * left);
}

/* m: what the gap, where a step begins, lacks that has no room; at most 0: it has. */
PHYS_INLINE double contact_row_lacks(const struct contact_row *row)
{
    return (1 - CONTACT_ROW_COUNTS) * row->thickness - row->gap;
}

/* True if a row may be pinched: it lacks room, or presses as hard as one that does. */
PHYS_INLINE bool contact_row_is_tight(const struct contact_row *row)
{
    return contact_row_lacks(row) > 0 || row->rested > CONTACT_ROW_COUNTS * row->hard;
}

PHYS_INLINE bool contact_row_follows(const struct contact_row *row)
{
    return row->pinched > 0 && row->held >= CONTACT_ROW_FOLLOWS;
}

/* The change of the load with which a step of a pinched contact begins. It grows twofold a step, up
 * to what ordinary contacts rise by; what is too much halves. stiffness: of rows that are not firm.
 */
PHYS_INLINE double contact_row_change(const struct contact_row *row, double stiffness)
{
    const double change = contact_row_law(row, row->start) - row->rested;
    const double lacks = row->thickness - row->start;
    const double grown = ldexp(CONTACT_ROW_LIFTS * stiffness, (int)row->held);
    const double most =
        row->part * lacks * fmin(grown, CONTACT_ROW_RISES * contact_row_slope(row, row->start));
    const double least = fmin(-most, 0.5 * change);
    return contact_row_follows(row) ? change : fmax(least, fmin(most, change));
}

/* Begins a step of a pinched contact. In a repeated solve one whose pair failed has its load
 * from the solve before. */
PHYS_INLINE void contact_row_compress(struct contact_row *row, double stiffness)
{
    const double firm = row->firm > 1 ? row->firm : 1;
    const double grown = ldexp(stiffness, (int)row->held);
    row->stiffness = fmax(stiffness * firm, fmin(contact_row_slope(row, row->gap), grown));
    row->aim = row->gap;
    if (row->pushed == 0 || !(firm > 1))
        row->load = row->rested + contact_row_change(row, stiffness);
    if (!contact_row_follows(row))
        row->energy = fmax(row->energy, 0.5 * row->load * row->load / stiffness);
}

/* The energy of a contact that followed the law, or does so from now on. It is at most that of a
 * straight line, as the law bends upwards. One that leaves it has the energy of its load. */
PHYS_INLINE double contact_row_stored(const struct contact_row *row, double gap, double load,
                                      bool stays)
{
    return 0.5 *
           (stays ? contact_row_law(row, gap) * (row->thickness - gap) : load * load / row->hold);
}

/* The count of steps when one has ended with this gap. */
PHYS_INLINE double contact_row_held(const struct contact_row *row, double gap)
{
    const double change = contact_row_law(row, row->start) - row->rested;
    if (!(row->pinched > 0 && row->hard > 0 && gap < row->thickness))
        return 0;
    return contact_row_change(row, row->hold) == change ? CONTACT_ROW_FOLLOWS
                                                        : row->held + row->part;
}

/* ---- A step ---- */

/* The lift, m, of one asked for that a contact of stiffness k is lent where its load rests. It is
 * slower in shorter steps, which are stiffer and would throw what they lift, and no harder than
 * compressed cloth pushes at its gap: two wrung layers, each of which lifts against the other,
 * would push ever harder. */
PHYS_INLINE double contact_row_raises(const struct contact_row *row, double lift, double k)
{
    const double most = fmax(contact_row_law(row, row->gap), CONTACT_ROW_COUNTS * row->hard);
    const double slow = row->part * row->part * lift;
    return row->hard > 0 ? fmin(slow, fmax(most - row->rested, 0) / k) : lift;
}

/* The stiffness along the normal of a contact that may open: at least load / thickness, as far as a
 * row may be firm. The gap of a softer one would close before its load has doubled, and wrung cloth
 * adds so much in a few steps. */
PHYS_INLINE double contact_row_stiffness(const struct contact_row *row, double stiffness)
{
    const double loaded = fmin(row->rested / row->thickness, CONTACT_ROW_FIRMEST * stiffness);
    return fmax(row->firm > 1 ? row->firm * stiffness : stiffness, loaded);
}

/* m: by how much the gap is too small, or, below 0, too large. */
PHYS_INLINE double contact_row_off(const struct contact_row *row)
{
    const double off = row->thickness - row->gap, right = CONTACT_ROW_RIGHT * row->thickness;
    return off > right ? off - right : fmin(off + right, 0);
}

/* Begins a step of a contact that may open. */
PHYS_INLINE void contact_row_lift(struct contact_row *row, double stiffness)
{
    const double firm = row->firm > 1 ? row->firm : 1, k = contact_row_stiffness(row, stiffness);
    const double lacks = contact_row_off(row);
    const double rises = firm > 1 ? CONTACT_ROW_YIELDS : CONTACT_ROW_RISES;
    const double rise = lacks > 0 ? rises * lacks : lacks;
    const double most = (sqrt(2 * k * row->energy) - row->rested) / k;
    const bool rests = row->rested > 0 && most * k > -CONTACT_ROW_EMPTY * row->rested;
    const double lifts =
        lacks > 0 && rests ? contact_row_raises(row, CONTACT_ROW_LIFTS * lacks, k) : most;
    const double allowed = firm > 1 && lacks > 0 ? rise : fmax(most, lifts);
    const double push = row->rested + k * fmin(rise, allowed);
    const double needs = push > 0 ? 0.5 * push * push / k : 0;
    row->energy = fmax(row->energy, needs);
    row->aim = row->gap + fmin(rise, allowed);
    row->stiffness = k;
}

/* A step begins, or is solved again, with a row that has the gap of its begin. stiffness: of rows
 * that are not firm; part: its length, of that of steps that are not halved. */
PHYS_INLINE void contact_row_begin(struct contact_row *row, double stiffness, double part)
{
    const double softer = row->hold > 0 ? row->hold / stiffness : 1;
    row->start = row->gap;
    row->slid *= row->part > 0 ? part / row->part : 1;
    row->opened *= row->part > 0 ? part / row->part : 1;
    row->part = part;
    if (row->held > 0 && !(row->pinched > 0)) {
        row->energy = 0.5 * row->rested * row->rested / row->hold;
        row->held = 0;
    }
    if (row->pinched > 0 && row->hard > 0 && row->gap < row->thickness)
        contact_row_compress(row, stiffness);
    else
        contact_row_lift(row, stiffness);
    row->hold = stiffness;
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
 * has a load and hardly opens. If the step was solved before, that solve decides:
 * an active set. */
PHYS_INLINE bool contact_row_acts(const struct contact_row *row, double gap, double push)
{
    const double opens = contact_row_follows(row) ? CONTACT_ROW_SPRINGS : CONTACT_ROW_OPENS;
    const bool stays = push > 0 || (row->load > 0 && gap < (1 + opens) * row->thickness);
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

/* True if the solve, which foretells the gap from the last step's growth, had the contact in the
 * matrix of the step that is over. */
PHYS_INLINE bool contact_row_acted(const struct contact_row *row)
{
    const double gap = row->gap + row->opened;
    return contact_row_acts(row, gap, row->load + row->stiffness * (row->aim - gap));
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

/* Fills the next step's row after a step that ended at this point; whether it is pinched follows.
 * Stretch beyond friction's hold becomes sliding. */
PHYS_INLINE void contact_row_end(const struct contact_row *row, const phys_vec *point,
                                 struct contact_row *next)
{
    phys_vec stretch;
    contact_row_stretch(row, point, &stretch);
    const double gap = contact_row_gap(row, point);
    const double push = contact_row_push(row, point), load = push > 0 ? push : 0;
    const double length = sqrt(phys_dot(&stretch, &stretch));
    const double most = row->friction * load, pull = row->hold * length;
    const double grows = row->slid > 0 ? length / row->slid : 1;
    next->slid = length;
    next->opened = gap - row->start;
    const double most_grown = CONTACT_ROW_GROWS, least_grown = 1.0 / CONTACT_ROW_GROWS;
    next->grows = grows < most_grown ? (grows > least_grown ? grows : least_grown) : most_grown;
    next->slip = pull <= most ? stretch : most / pull * stretch;
    next->slip -= phys_dot(&next->normal, &next->slip) * next->normal;
    /* A contact out of the matrix pushed nothing: a push that it has where the cloth fell to is no
     * load yet. */
    next->load = next->rested =
        contact_row_acted(row) || !(row->load > 0) ? load : fmin(load, row->load);
    next->held = contact_row_held(row, gap);
    next->energy = contact_row_follows(row) || next->held >= CONTACT_ROW_FOLLOWS
                       ? contact_row_stored(row, gap, load, next->held > 0)
                       : contact_row_energy(row, point, load);
    next->hold = row->hold;
    next->part = row->part;
    next->pushed = 0;
    next->firm = fmax(next->firm, CONTACT_ROW_SOFTENS * row->firm);
}

#endif
