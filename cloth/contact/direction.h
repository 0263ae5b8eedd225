#ifndef CLOTH_CONTACT_DIRECTION_H
#define CLOTH_CONTACT_DIRECTION_H

#include "cloth/contact/pair.h"
#include "cloth/contact/shape.h"

#include <stdbool.h>

/* What pair.c and certificate.c share: the closest direction of a pair. Four corners lie side by
 * side, lane k is corner k, as differences against corner 0.
 *
 * Two features are closest inside both (the foot of the vertex in the triangle, the feet of the
 * common perpendicular on both edges), and then across both; or else at a vertex of one and a point
 * of an edge of the other: of the three edges of a triangle, of the two ends of either edge. Those
 * are four lanes of the same computation. */

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

PHYS_INLINE void contact_lanes_of(const phys_vec *origin, const phys_vec x[4],
                                  struct contact_lanes *to)
{
    const phys_vec a = x[0] - *origin, b = x[1] - *origin, c = x[2] - *origin, d = x[3] - *origin;
    const phys_vec ab_even = CONTACT_PICK(a, b, 0, 4, 2, 6),
                   ab_odd = CONTACT_PICK(a, b, 1, 5, 3, 7);
    const phys_vec cd_even = CONTACT_PICK(c, d, 0, 4, 2, 6),
                   cd_odd = CONTACT_PICK(c, d, 1, 5, 3, 7);
    to->c[0] = CONTACT_PICK(ab_even, cd_even, 0, 1, 4, 5);
    to->c[1] = CONTACT_PICK(ab_odd, cd_odd, 0, 1, 4, 5);
    to->c[2] = CONTACT_PICK(ab_even, cd_even, 2, 3, 6, 7);
}

/* n.x of the corners. */
PHYS_INLINE void contact_along(const struct contact_lanes *x, const double n[3], phys_vec *along)
{
    *along = (n[0] * x->c[0] + n[1] * x->c[1]) + n[2] * x->c[2];
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

/* The place of the second feature's begin (of VT: of the vertex) in the axes d1, d2 and their
 * product n: u, v and height times n.n. */
struct contact_across {
    double n[3], square, u, v, height;
    bool flat; /* d1 and d2 are too near to parallel for n to mean much, or one is nothing */
};

PHYS_INLINE void contact_product(const double a[3], const double b[3], double product[3])
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

PHYS_INLINE double contact_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

PHYS_INLINE void contact_way(const phys_vec *from, const phys_vec *to, double way[3])
{
    const phys_vec difference = *to - *from;
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        way[c] = difference[c];
}

PHYS_INLINE void contact_across_of(enum contact_pair pair, const phys_vec x[4],
                                   struct contact_across *to)
{
    static const double SINE = 1e-12; /* its square */
    double d1[3], d2[3], w[3], other[3];
    contact_way(x + (pair == CONTACT_VT), x + (pair == CONTACT_VT ? 2 : 1), d1);
    contact_way(x + (pair == CONTACT_VT ? 1 : 2), x + 3, d2);
    contact_way(x + (pair == CONTACT_VT), x + (pair == CONTACT_VT ? 0 : 2), w);
    contact_product(d1, d2, to->n);
    to->square = contact_dot(to->n, to->n);
    to->flat = !(to->square > SINE * (contact_dot(d1, d1) * contact_dot(d2, d2)));
    contact_product(w, d2, other);
    to->u = contact_dot(other, to->n);
    contact_product(d1, w, other);
    to->v = contact_dot(other, to->n);
    to->height = contact_dot(w, to->n);
}

/* Whether the feet lie inside: u and v in parts of the square. */
PHYS_INLINE bool contact_inside(enum contact_pair pair, const struct contact_across *a)
{
    if (pair == CONTACT_VT)
        return !a->flat & (a->u > 0) & (a->v > 0) & (a->u + a->v < a->square);
    return !a->flat & (a->u > 0) & (a->u < a->square) & (a->v < 0) & (-a->v < a->square);
}

/* From the second feature to the first. */
PHYS_INLINE void contact_turn(enum contact_pair pair, const struct contact_across *a, double n[3])
{
    const bool turned = (a->height < 0) == (pair == CONTACT_VT);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        n[c] = turned ? -a->n[c] : a->n[c];
}

/* ---- A vertex of one and an edge of the other ---- */

/* Lanes: VT: the edges 1 2, 2 3, 3 1 (and 1 2 again); EE: the vertices 0 to 3. */
struct contact_ends {
    struct contact_lanes edge, way; /* way: to the vertex from the closest point */
    phys_vec part;                  /* of the edge, to that point */
    phys_vec square;                /* of the way */
};

PHYS_INLINE void contact_choose(const contact_mask *which, const phys_vec *a, const phys_vec *b,
                                phys_vec *to)
{
    *to = (phys_vec)((*which & (contact_mask)*a) | (~*which & (contact_mask)*b));
}

PHYS_INLINE void contact_lanes_square(const struct contact_lanes *a, const struct contact_lanes *b,
                                      phys_vec *to)
{
    *to = (a->c[0] * b->c[0] + a->c[1] * b->c[1]) + a->c[2] * b->c[2];
}

PHYS_INLINE void contact_ends_of(enum contact_pair pair, const struct contact_lanes *x,
                                 struct contact_ends *to)
{
    const phys_vec nothing = {0}, one = {1, 1, 1, 1}, tiny = {1e-300, 1e-300, 1e-300, 1e-300};
    phys_vec dot, square;
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
    contact_lanes_square(&to->way, &to->edge, &dot);
    contact_lanes_square(&to->edge, &to->edge, &square);
    const contact_mask ahead = dot > nothing;
    contact_choose(&ahead, &dot, &nothing, &dot);
    to->part = dot / (square + tiny);
    const contact_mask on = to->part < one;
    contact_choose(&on, &to->part, &one, &to->part);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        to->way.c[c] -= to->part * to->edge.c[c];
    contact_lanes_square(&to->way, &to->way, &to->square);
}

/* The lane with the shortest way, of equal ones the first. */
PHYS_INLINE int contact_ends_least(const struct contact_ends *ends)
{
    const phys_vec s = ends->square;
    const int a = s[1] < s[0] ? 1 : 0, b = s[3] < s[2] ? 3 : 2;
    const double least_a = s[1] < s[0] ? s[1] : s[0], least_b = s[3] < s[2] ? s[3] : s[2];
    return least_b < least_a ? b : a;
}

/* A lane's way, from the second feature to the first. */
PHYS_INLINE void contact_ends_way(enum contact_pair pair, const struct contact_ends *ends, int lane,
                                  double n[3])
{
    const double sign = pair == CONTACT_EE && lane > 1 ? -1 : 1;
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        n[c] = sign * ends->way.c[c][lane];
}

/* ---- The closest direction ---- */

/* For features that are nearly parallel, degenerate, or so near that a direction between points is
 * but rounding: the direction of all that could be meant which parts the corners most; of length 1,
 * or 0 if there is none. Returns f times that length. x: as contact_nearest_of has it. */
double contact_direction_best(enum contact_pair pair, const phys_vec x[4], double n[3]);

/* The direction from the second feature to the first, of any length, and f times that length.
 * lanes: of x against x[0]. */
PHYS_INLINE double contact_direction(enum contact_pair pair, const phys_vec x[4],
                                     const struct contact_lanes *lanes, double n[3])
{
    static const double NEARLY = 0.99; /* of the gap; the rest is rounding, or another feature */
    struct contact_across across;
    double expected;
    phys_vec along;
    contact_across_of(pair, x, &across);
    if (contact_inside(pair, &across)) {
        contact_turn(pair, &across, n);
        expected = across.height < 0 ? -across.height : across.height;
    } else {
        struct contact_ends ends;
        contact_ends_of(pair, lanes, &ends);
        contact_ends_way(pair, &ends, contact_ends_least(&ends), n);
        expected = contact_dot(n, n);
    }
    contact_along(lanes, n, &along);
    const double apart = contact_apart(pair, &along);
    return apart >= NEARLY * expected ? apart : contact_direction_best(pair, x, n);
}

#endif
