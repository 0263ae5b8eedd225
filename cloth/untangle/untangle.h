#ifndef CLOTH_UNTANGLE_UNTANGLE_H
#define CLOTH_UNTANGLE_UNTANGLE_H

#include "cloth/base/error.h"
#include "cloth/contact/apart.h"
#include "cloth/contact/soup.h"

#include <stdbool.h>
#include <stdint.h>

/* Moves cloths apart that go through each other, themselves or obstacles, before a run starts.
 * Local, on one rank; the same input gives the same bits. */

/* Points that a weld makes one move together: corners are the welded ones of the soup. */
struct untangle_cloths {
    const struct contact_soup *soup;
    const uint32_t *layer;     /* n_cloths: the higher one of two is outside; equal: neither is */
    const unsigned char *held; /* points of cloth: 1: must not move */
    const struct contact_apart *apart;     /* cloths that do not meet; NULL: all meet */
    bool self_off;                         /* no cloth meets itself */
    double thickness;                      /* m */
    const struct contact_shape *obstacles; /* where they are at time 0 */
    const struct phys_key *keys;           /* of their motions */
    const struct contact_bodies *bodies;
};

/* Counts of faults; all are 0 after success. */
struct untangle_count {
    uint64_t pairs;   /* of triangles that intersect, of cloths and with bodies */
    uint64_t entered; /* vertices and triangles in, or nearly at, obstacles */
    uint64_t near;    /* pairs of features nearer than a tenth of the thickness */
    uint64_t layers;  /* vertices of an outer cloth that are inside of an inner one */
};

static inline uint64_t untangle_faults(const struct untangle_count *count)
{
    return count->pairs + count->entered + count->near + count->layers;
}

/* A connected part of a cloth. Where x begins, more points of outer cloths are on its inner side
 * than on its outer one: it is inside out, or they are in it. */
struct untangle_turned {
    uint32_t point, n; /* its lowest point; how many it has */
    uint32_t outer;    /* one of these cloths */
};
enum { UNTANGLE_TURNED = 5 };

struct untangle_result {
    uint32_t rounds;       /* 0: there were no faults, and x is unchanged */
    uint64_t moved;        /* points */
    double largest;        /* m: the largest move of a point */
    double stretch;        /* the most by which an edge is longer than before, a factor, and */
    uint32_t stretched[2]; /* its ends */
    uint32_t n_turned;     /* parts, the first of which are: */
    struct untangle_turned turned[UNTANGLE_TURNED];
    struct untangle_count left;
    uint32_t near[4]; /* if left.near: the points of the first such pair, some of bodies,
                       * which follow the cloths' */
};

/* Told before each round, and after the last. May be NULL. */
struct untangle_listener {
    void *context;
    void (*round)(void *context, uint32_t round, const struct untangle_count *count);
};

/* Moves x (m, n_points) until all counts are 0, or the rounds are over. Then x is that of the round
 * with the fewest faults; result->left counts these. CLOTH_E_RUN for coordinates that cannot be
 * checked, CLOTH_E_MEMORY.
 *
 * A round finds all faults, and makes of each one an inequality for a few points. It goes over all
 * inequalities a few times, and moves the points as little as each one demands. Edges that became a
 * fifth longer or shorter than in x are treated in the same way. The inequalities:
 *
 * - obstacles: vertices go out along the normal of the nearest point.
 * - layers: vertices of the outer cloth go to the side that the inner cloth's triangles face.
 * - equal layers: edges that cross triangles cut the cloth into parts. All parts but the largest
 *   are on the wrong side (global intersection analysis: Baraff, Witkin & Kass, Untangling cloth,
 *   2003). Their vertices go through the nearest place of the surface that they cross.
 * - open contours: the contour of an intersection of two cloths that lie along each other may end
 *   at their borders, and cuts nothing off. Each connected group of vertices of one cloth that are
 *   beside the other goes to the side where most of the group are.
 * - other contours: edges go where the contour becomes shorter (Volino & Magnenat-Thalmann,
 *   Resolving surface collisions through intersection contour minimization, 2006).
 * - features that are too near go apart. */
int untangle(const struct untangle_cloths *cloths, phys_vec *x,
             const struct untangle_listener *listener, struct untangle_result *result,
             struct cloth_error *error);

#endif
