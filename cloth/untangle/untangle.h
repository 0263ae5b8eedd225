#ifndef CLOTH_UNTANGLE_UNTANGLE_H
#define CLOTH_UNTANGLE_UNTANGLE_H

#include "cloth/base/error.h"
#include "cloth/contact/apart.h"
#include "cloth/contact/shape.h"

#include <stdbool.h>
#include <stdint.h>

/* Moves cloths that go through each other, through themselves or through obstacles apart, before a
 * run starts. Local, on one rank; the same input gives the same bits. */

/* Points that a weld makes one have one number, which all corners give. */
struct untangle_cloths {
    uint32_t n_points, n_triangles, n_cloths;
    const uint32_t (*corner)[3]; /* n_triangles; counterclockwise as seen from outside */
    const uint32_t *cloth;     /* n_triangles: each one's cloth; those of a cloth follow each other,
                                * and cloths each other */
    const uint32_t *layer;     /* n_cloths: of two the higher is outside; equal: neither is */
    const unsigned char *held; /* n_points: 1: must not move */
    const struct contact_apart *apart; /* what does not meet; NULL: all does, but that */
    bool self_off;                     /* no cloth meets itself */
    double thickness;                  /* m */
    size_t n_obstacles;
    const struct contact_shape *obstacles; /* where they are at time 0 */
    const struct phys_key *keys;           /* of their motions */
    const struct contact_bodies *bodies;
};

/* What is wrong. All are 0 at the end. */
struct untangle_count {
    uint64_t pairs;   /* of triangles that intersect, of cloths and with bodies */
    uint64_t entered; /* vertices and triangles in, or nearly at, obstacles */
    uint64_t near;    /* pairs of features nearer than a tenth of the thickness */
    uint64_t layers;  /* vertices of an outer cloth that are inside of an inner one */
};

struct untangle_result {
    uint32_t rounds; /* 0: nothing was to be done, and x is as it was */
    uint64_t moved;  /* points */
    double largest;  /* m: the largest move of a point */
    struct untangle_count left;
    uint32_t near[4]; /* if left.near: the points of the first such pair, some of bodies,
                       * which follow the cloths' */
};

/* Told before each round, and after the last. May be NULL. */
struct untangle_listener {
    void *context;
    void (*round)(void *context, uint32_t round, const struct untangle_count *count);
};

/* Moves x (m, n_points) until nothing of what untangle_count has is left, or the rounds are over:
 * then x is that of the round with the least of it, and result->left says how much. CLOTH_E_RUN for
 * coordinates that cannot be checked, CLOTH_E_MEMORY.
 *
 * A round finds all that is wrong, makes of each thing one inequality on the way of a few points,
 * and goes over all inequalities a few times, each time moving the points as little as that one
 * asks. So it does with edges that became a fifth longer or shorter than x had them. The
 * inequalities:
 *
 * - obstacles: vertices go out along the normal of the nearest point;
 * - layers: vertices of the outer cloth go to the side of the inner one that its triangles face;
 * - equal layers: edges that cross triangles cut the cloth into parts, and all but the largest are
 *   on the wrong side (global intersection analysis: Baraff, Witkin & Kass, Untangling cloth,
 *   2003). Their vertices go through the nearest place of what they crossed;
 * - where the contour of an intersection of two cloths that lie along each other ends at their
 *   borders, it cuts nothing off: the vertices of one that are beside the other go to the side
 * where most of them are that hang together;
 * - else edges go where the contour of the intersection becomes
 *   shorter (Volino & Magnenat-Thalmann, Resolving surface collisions through intersection contour
 *   minimization, 2006);
 * - features that are too near go apart. */
int untangle(const struct untangle_cloths *cloths, phys_vec *x,
             const struct untangle_listener *listener, struct untangle_result *result,
             struct cloth_error *error);

#endif
