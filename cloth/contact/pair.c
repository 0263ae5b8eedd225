/* Ways between features are found from differences against corner 0, so that where the pair is in
 * the room costs no digits. */
#include "cloth/contact/direction.h"

#include <math.h>

/* Makes it 1 long; false for nothing, or what is too short for that. */
PHYS_INLINE bool make_unit(phys_vec *n)
{
    const double length = sqrt(phys_dot(n, n));
    if (!(length > CONTACT_TINY) || isinf(length))
        return false;
    *n /= length;
    return true;
}

/* ---- The best of all directions ---- */

struct best {
    enum contact_pair pair;
    struct contact_lanes lanes;
    double apart;
    phys_vec n;
};

static void best_try(struct best *best, const phys_vec *n)
{
    phys_vec unit = *n, along;
    if (!make_unit(&unit))
        return;
    contact_along(&best->lanes, &unit, &along);
    const double apart = contact_apart(best->pair, &along);
    if (!(apart > best->apart))
        return;
    best->apart = apart;
    best->n = unit;
}

/* Tries a way without its part along an edge: if the way is short, that part is the rounding of its
 * ends. */
static void best_try_across(struct best *best, const struct contact_ends *ends, int lane)
{
    phys_vec edge, n;
    contact_lanes_get(&ends->edge, lane, &edge);
    contact_lanes_get(&ends->way, lane, &n);
    if (!make_unit(&n) || !make_unit(&edge))
        return;
    n -= phys_dot(&n, &edge) * edge;
    best_try(best, &n);
}

void contact_direction_best(enum contact_pair pair, const phys_vec x[4], phys_vec *n)
{
    struct contact_ends ends;
    struct best best = {.pair = pair, .apart = -INFINITY};
    phys_vec way;
    contact_lanes_of(x, x, &best.lanes);
    contact_across(pair, x, &best.lanes, &way);
    best_try(&best, &way);
    contact_ends_of(pair, &best.lanes, &ends);
    for (int lane = 0; lane < 4; lane++) {
        contact_lanes_get(&ends.way, lane, &way);
        best_try(&best, &way);
        best_try_across(&best, &ends, lane);
    }
    *n = best.n;
}

/* ---- The closest points ---- */

/* True if the ways along the features are so nearly parallel that their product n means little. */
PHYS_INLINE bool is_flat(const phys_vec *a, const phys_vec *b, const phys_vec *n)
{
    static const double SINE = 1e-12; /* its square */
    return !(phys_dot(n, n) > SINE * (phys_dot(a, a) * phys_dot(b, b)));
}

/* Feet of a perpendicular at u and v, in parts of the whole of their features. */
PHYS_INLINE bool is_inside(enum contact_pair pair, double u, double v, double whole)
{
    const double most = pair == CONTACT_VT ? u + v : u > v ? u : v;
    return (u > 0) & (v > 0) & (most < whole);
}

/* Finds the feet, u and v. VT: corner 0 lies from corner 1 by u a + v b and a way across both sides
 * a and b. EE: the begin of the second edge lies from that of the first by u a - v b and a way
 * across. Returns true if both feet lie inside. */
static bool find_feet(enum contact_pair pair, const phys_vec x[4], double *u, double *v)
{
    phys_vec a, b, n, across_a, across_b;
    contact_ways(pair, x, &a, &b);
    contact_product(&a, &b, &n);
    contact_product(&b, &n, &across_b);
    contact_product(&n, &a, &across_a);
    const phys_vec way = pair == CONTACT_VT ? x[0] - x[1] : x[2] - x[0];
    const double square = phys_dot(&n, &n), other = phys_dot(&way, &across_a) / square;
    *u = phys_dot(&way, &across_b) / square;
    *v = pair == CONTACT_VT ? other : -other;
    return is_inside(pair, *u, *v, 1) && !is_flat(&a, &b, &n);
}

/* The same from the known ends. That loses digits where angles are small. */
PHYS_INLINE bool find_feet_quickly(enum contact_pair pair, const phys_vec x[4],
                                   const struct contact_ends *ends, double *u, double *v)
{
    static const double SINE = 1e-6; /* its square */
    const bool is_vt = pair == CONTACT_VT;
    const double aa = is_vt ? ends->length[0] : ends->length[2];
    const double bb = is_vt ? ends->length[2] : ends->length[0];
    const double ab = is_vt ? 0.5 * ((aa + bb) - ends->length[1]) : ends->dot[1] - ends->dot[0];
    const double wa = is_vt ? ends->dot[0] : ends->dot[2];
    const double wb = is_vt ? bb - ends->dot[2] : ends->dot[0];
    const double square = aa * bb - ab * ab;
    if (!(square > SINE * (aa * bb)))
        return find_feet(pair, x, u, v);
    *u = is_vt ? wa * bb - wb * ab : wa * bb + wb * ab;
    *v = is_vt ? wb * aa - wa * ab : wb * aa + wa * ab;
    const bool inside = is_inside(pair, *u, *v, square);
    *u /= square;
    *v /= square;
    return inside;
}

PHYS_INLINE void weigh_inside(enum contact_pair pair, double u, double v, double weight[4])
{
    if (pair == CONTACT_VT) {
        weight[0] = 1;
        weight[1] = 1 - u - v > 0 ? -(1 - u - v) : 0;
        weight[2] = -u;
        weight[3] = -v;
        return;
    }
    weight[0] = 1 - u;
    weight[1] = u;
    weight[2] = -(1 - v);
    weight[3] = -v;
}

/* VT: lane k is the edge from corner 1 + k to the next. EE: lane k is vertex k, against the other
 * edge. */
PHYS_INLINE void weigh_end(enum contact_pair pair, double part, int lane, double weight[4])
{
    static const unsigned char VERTEX[2][4] = {{0, 0, 0, 0}, {0, 1, 2, 3}};
    static const unsigned char BEGIN[2][4] = {{1, 2, 3, 1}, {2, 2, 0, 0}};
    static const unsigned char END[2][4] = {{2, 3, 1, 2}, {3, 3, 1, 1}};
    static const double SIGN[2][4] = {{1, 1, 1, 1}, {1, 1, -1, -1}};
    const int kind = pair == CONTACT_EE;
    const double sign = SIGN[kind][lane];
    for (int k = 0; k < 4; k++)
        weight[k] = 0;
    weight[VERTEX[kind][lane]] = sign;
    weight[BEGIN[kind][lane]] = -sign * (1 - part);
    weight[END[kind][lane]] = -sign * part;
}

/* A direction across both features where they touch at the edge. */
static void pair_find_normal(enum contact_pair pair, const phys_vec x[4], const phys_vec *edge,
                             phys_vec *n)
{
    phys_vec a, b, axis = {0};
    contact_ways(pair, x, &a, &b);
    contact_product(&a, &b, n);
    if (!is_flat(&a, &b, n) && make_unit(n))
        return;
    int least = 0;
    for (int c = 1; c < 3; c++)
        if (fabs((*edge)[c]) < fabs((*edge)[least]))
            least = c;
    axis[least] = 1;
    contact_product(&axis, edge, n);
    if (!make_unit(n))
        *n = axis;
}

/* For features so near that the way between their points is only rounding: the normal is the
 * direction that separates them most. */
static void nearest_close(enum contact_pair pair, const phys_vec x[4],
                          const struct contact_lanes *lanes, const phys_vec *edge,
                          struct contact_nearest *to)
{
    const phys_vec way = to->normal;
    phys_vec along;
    contact_direction_best(pair, x, &to->normal);
    contact_along(lanes, &to->normal, &along);
    if (!(contact_apart(pair, &along) > 0))
        pair_find_normal(pair, x, edge, &to->normal);
    to->gap = fmax(phys_dot(&to->normal, &way), 0);
}

PHYS_INLINE void nearest_end(enum contact_pair pair, const phys_vec x[4],
                             const struct contact_lanes *lanes, const struct contact_ends *ends,
                             struct contact_nearest *to)
{
    const int lane = contact_ends_least(ends);
    phys_vec edge;
    contact_lanes_get(&ends->way, lane, &to->normal);
    weigh_end(pair, ends->part[lane], lane, to->weight);
    to->gap = sqrt(ends->square[lane]);
    if (ends->square[lane] > CONTACT_NEAR * CONTACT_NEAR * contact_square(lanes)) {
        to->normal /= to->gap;
        return;
    }
    contact_lanes_get(&ends->edge, lane, &edge);
    nearest_close(pair, x, lanes, &edge, to);
}

PHYS_INLINE void nearest(enum contact_pair pair, const phys_vec x[4], struct contact_nearest *to)
{
    struct contact_lanes lanes;
    struct contact_ends ends;
    phys_vec n;
    double u, v;
    contact_lanes_of(x, x, &lanes);
    contact_ends_of(pair, &lanes, &ends);
    if (!find_feet_quickly(pair, x, &ends, &u, &v)) {
        nearest_end(pair, x, &lanes, &ends, to);
        return;
    }
    const phys_vec way = x[0] - x[pair == CONTACT_VT ? 1 : 2];
    weigh_inside(pair, u, v, to->weight);
    contact_across(pair, x, &lanes, &n);
    to->normal = n / sqrt(phys_dot(&n, &n));
    to->gap = fabs(phys_dot(&to->normal, &way));
}

PHYS_KERNEL(contact_nearest_of,
            (enum contact_pair pair, const phys_vec x[4], struct contact_nearest *to),
            (pair, x, to))
{
    if (pair == CONTACT_VT)
        nearest(CONTACT_VT, x, to);
    else
        nearest(CONTACT_EE, x, to);
}
