#ifndef CLOTH_CONTACT_DIRECTION_H
#define CLOTH_CONTACT_DIRECTION_H

#include "cloth/contact/certificate.h"
#include "cloth/contact/pair.h"
#include "cloth/contact/shape.h"

#include <stdbool.h>

/* Shared by pair.c and the files of certificates: the directions that a pair may be closest in.
 * Lane k is corner k of four, as its difference against corner 0.
 *
 * Two features may be closest inside both (the foot of the vertex in the triangle, the feet of the
 * common perpendicular on both edges): the direction is then across both. Else they are closest at
 * a vertex of one and a point of an edge of the other: a triangle has three edges, and two edges
 * have four ends. Those are four lanes of the same computation. The direction that separates the
 * corners most is the closest, so the others need no test. */

struct contact_lanes {
    phys_vec c[3]; /* by coordinate */
};

typedef int64_t contact_mask __attribute__((vector_size(32)));

/* Lanes of two vectors, those of the second from 4. */
#if defined(__clang__)
#define CONTACT_PICK(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define CONTACT_PICK(a, b, i, j, k, l) __builtin_shuffle(a, b, (contact_mask){i, j, k, l})
#endif

/* Lane k of each is of vector k. */
PHYS_INLINE void contact_transpose(const phys_vec *a, const phys_vec *b, const phys_vec *c,
                                   const phys_vec *d, struct contact_lanes *to)
{
    const phys_vec ab_even = CONTACT_PICK(*a, *b, 0, 4, 2, 6),
                   ab_odd = CONTACT_PICK(*a, *b, 1, 5, 3, 7);
    const phys_vec cd_even = CONTACT_PICK(*c, *d, 0, 4, 2, 6),
                   cd_odd = CONTACT_PICK(*c, *d, 1, 5, 3, 7);
    to->c[0] = CONTACT_PICK(ab_even, cd_even, 0, 1, 4, 5);
    to->c[1] = CONTACT_PICK(ab_odd, cd_odd, 0, 1, 4, 5);
    to->c[2] = CONTACT_PICK(ab_even, cd_even, 2, 3, 6, 7);
}

PHYS_INLINE void contact_lanes_of(const phys_vec *origin, const phys_vec x[4],
                                  struct contact_lanes *to)
{
    const phys_vec a = x[0] - *origin, b = x[1] - *origin, c = x[2] - *origin, d = x[3] - *origin;
    contact_transpose(&a, &b, &c, &d, to);
}

/* n.x of the corners. */
PHYS_INLINE void contact_along(const struct contact_lanes *x, const phys_vec *n, phys_vec *along)
{
    *along = ((*n)[0] * x->c[0] + (*n)[1] * x->c[1]) + (*n)[2] * x->c[2];
}

/* The least of the first feature less the largest of the second. */
PHYS_INLINE double contact_apart(enum contact_pair pair, const phys_vec *along)
{
    const double a = (*along)[0], b = (*along)[1], c = (*along)[2], d = (*along)[3];
    const double last = c > d ? c : d;
    if (pair == CONTACT_VT)
        return a - (b > last ? b : last);
    return (a < b ? a : b) - last;
}

/* ---- Across both features ---- */

/* The product with its lanes turned: z x y. */
PHYS_INLINE void contact_product_turned(const phys_vec *a, const phys_vec *b, phys_vec *product)
{
    const phys_vec turned_a = CONTACT_PICK(*a, *a, 1, 2, 0, 3);
    const phys_vec turned_b = CONTACT_PICK(*b, *b, 1, 2, 0, 3);
    *product = *a * turned_b - turned_a * *b;
}

PHYS_INLINE void contact_product(const phys_vec *a, const phys_vec *b, phys_vec *product)
{
    phys_vec turned;
    contact_product_turned(a, b, &turned);
    *product = CONTACT_PICK(turned, turned, 1, 2, 0, 3);
}

/* Two ways along the features; of VT, of the triangle's sides. */
PHYS_INLINE void contact_ways(enum contact_pair pair, const phys_vec x[4], phys_vec *a, phys_vec *b)
{
    *a = pair == CONTACT_VT ? x[2] - x[1] : x[1] - x[0];
    *b = pair == CONTACT_VT ? x[3] - x[1] : x[3] - x[2];
}

/* Across both, from the second feature to the first. at: x against x[0]. */
PHYS_INLINE void contact_across(enum contact_pair pair, const phys_vec x[4],
                                const struct contact_lanes *at, phys_vec *n)
{
    phys_vec a, b, along;
    contact_ways(pair, x, &a, &b);
    contact_product(&a, &b, n);
    contact_along(at, n, &along);
    const double second = pair == CONTACT_VT ? along[1] : along[2];
    *n *= __builtin_copysign(1, along[0] - second);
}

/* ---- A vertex of one and an edge of the other ---- */

/* Lanes: VT: the edges 1 2, 2 3, 3 1 (and 1 2 again); EE: the vertices 0 to 3. */
struct contact_ends {
    struct contact_lanes edge, way; /* way: from the second feature to the first */
    phys_vec dot, length; /* of the edge with the way from its begin to the vertex; its square */
    phys_vec part;        /* of the edge, to that point */
    phys_vec square;      /* of the way */
};

PHYS_INLINE void contact_choose(const contact_mask *which, const phys_vec *a, const phys_vec *b,
                                phys_vec *to)
{
    *to = (phys_vec)((*which & (contact_mask)*a) | (~*which & (contact_mask)*b));
}

PHYS_INLINE void contact_lanes_dot(const struct contact_lanes *a, const struct contact_lanes *b,
                                   phys_vec *to)
{
    *to = (a->c[0] * b->c[0] + a->c[1] * b->c[1]) + a->c[2] * b->c[2];
}

/* a x b. */
PHYS_INLINE void contact_lanes_product(const struct contact_lanes *a, const struct contact_lanes *b,
                                       struct contact_lanes *to)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        to->c[c] = a->c[d] * b->c[e] - a->c[e] * b->c[d];
    }
}

/* The sum of the squares of all. */
PHYS_INLINE double contact_square(const struct contact_lanes *x)
{
    phys_vec square;
    contact_lanes_dot(x, x, &square);
    return phys_lanes(&square);
}

/* Finds the rest, from edges and from the ways from their begins to the vertices. sign: -1 where
 * the vertex is of the second feature. */
PHYS_INLINE void contact_ends_solve(const phys_vec *sign, struct contact_ends *to)
{
    const phys_vec nothing = {0}, one = {1, 1, 1, 1}, tiny = {1e-300, 1e-300, 1e-300, 1e-300};
    phys_vec ahead;
    contact_lanes_dot(&to->way, &to->edge, &to->dot);
    contact_lanes_dot(&to->edge, &to->edge, &to->length);
    const contact_mask is_ahead = to->dot > nothing;
    contact_choose(&is_ahead, &to->dot, &nothing, &ahead);
    to->part = ahead / (to->length + tiny);
    const contact_mask on = to->part < one;
    contact_choose(&on, &to->part, &one, &to->part);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        to->way.c[c] = *sign * (to->way.c[c] - to->part * to->edge.c[c]);
    contact_lanes_dot(&to->way, &to->way, &to->square);
}

PHYS_INLINE void contact_ends_of(enum contact_pair pair, const struct contact_lanes *x,
                                 struct contact_ends *to)
{
    const phys_vec nothing = {0}, one = {1, 1, 1, 1};
    const phys_vec sign = pair == CONTACT_VT ? one : (phys_vec){1, 1, -1, -1};
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const phys_vec v = x->c[c];
        const phys_vec begin =
            pair == CONTACT_VT ? CONTACT_PICK(v, v, 1, 2, 3, 1) : CONTACT_PICK(v, v, 2, 2, 0, 0);
        const phys_vec end =
            pair == CONTACT_VT ? CONTACT_PICK(v, v, 2, 3, 1, 2) : CONTACT_PICK(v, v, 3, 3, 1, 1);
        to->edge.c[c] = end - begin;
        to->way.c[c] = (pair == CONTACT_VT ? nothing : v) - begin;
    }
    contact_ends_solve(&sign, to);
}

/* The lane with the shortest way, of equal ones the first. */
PHYS_INLINE int contact_ends_least(const struct contact_ends *ends)
{
    const phys_vec s = ends->square;
    const int a = s[1] < s[0] ? 1 : 0, b = s[3] < s[2] ? 3 : 2;
    const double least_a = s[1] < s[0] ? s[1] : s[0], least_b = s[3] < s[2] ? s[3] : s[2];
    return least_b < least_a ? b : a;
}

PHYS_INLINE void contact_lanes_get(const struct contact_lanes *lanes, int lane, phys_vec *x)
{
    *x = (phys_vec){lanes->c[0][lane], lanes->c[1][lane], lanes->c[2][lane], 0};
}

/* The shortest way between a vertex of one and an edge of the other; returns its square. */
PHYS_INLINE double contact_between(enum contact_pair pair, const struct contact_lanes *x,
                                   phys_vec *n)
{
    struct contact_ends ends;
    contact_ends_of(pair, x, &ends);
    const int lane = contact_ends_least(&ends);
    contact_lanes_get(&ends.way, lane, n);
    return ends.square[lane];
}

/* Ways shorter than this part of the corners' size count as rounding. */
#define CONTACT_NEAR 1e-6

/* The candidate direction that separates the corners most, for features that are nearly parallel,
 * degenerate, or so near that a direction between points is only rounding. n has length 1, or 0 if
 * there is none. x: as in contact_nearest_of. */
void contact_direction_best(enum contact_pair pair, const phys_vec x[4], phys_vec *n);

/* ---- Certainty ---- */

/* The loss of f by rounding, see the header. */
#define CONTACT_ROUNDING 0x1p-50

/* The least f at the start: rounding of a direction must not lose a pair that the step before has
 * left at the margin. */
#define CONTACT_LEAST (CONTACT_MARGIN / 2)

/* The f at both ends, m, that shows features to be farther apart than reach. Its margin covers the
 * other roundings of nearest points. */
PHYS_INLINE double contact_far_of(double reach)
{
    return reach * (1 + 1e-9) + 1e-9;
}

/* contact_pass_all of those that have not passed yet, by the closest directions. */
void contact_pass_rest(size_t n, const struct contact_moving *moving, double thickness,
                       double reach, enum contact_passing *passing);

#endif
