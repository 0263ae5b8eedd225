/* Most pairs are certified by the sum of the directions across both features at the start and at
 * the end, four of one kind at once, a lane each. Lanes do not depend on each other, so a pair has
 * the same verdict among others as alone. */
#include "cloth/contact/direction.h"

#include <math.h>
#include <string.h>

/* One end of four pairs: their corners, and these against the first. */
struct quick_end {
    struct contact_lanes corner[4], against[3];
};

PHYS_INLINE void quick_subtract(const struct contact_lanes *a, const struct contact_lanes *b,
                                struct contact_lanes *to)
{
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        to->c[c] = a->c[c] - b->c[c];
}

/* The corners of four pairs at their steps' begin, or at the end. */
PHYS_INLINE void quick_open(const phys_vec *const x[4], struct quick_end *to)
{
    PHYS_UNROLL
    for (int k = 0; k < 4; k++)
        contact_transpose(x[0] + k, x[1] + k, x[2] + k, x[3] + k, to->corner + k);
    PHYS_UNROLL
    for (int k = 0; k < 3; k++)
        quick_subtract(to->corner + 1 + k, to->corner, to->against + k);
}

/* As phys_dot adds. */
PHYS_INLINE void quick_dot(const struct contact_lanes *a, const struct contact_lanes *b,
                           phys_vec *to)
{
    *to = (a->c[2] * b->c[2] + a->c[1] * b->c[1]) + (a->c[0] * b->c[0] + 0.0);
}

/* Adds the direction across both features, from the second to the first. */
PHYS_INLINE void quick_across(enum contact_pair pair, const struct quick_end *end,
                              struct contact_lanes *n)
{
    const bool is_edges = pair == CONTACT_EE;
    const contact_mask bit = {INT64_MIN, INT64_MIN, INT64_MIN, INT64_MIN};
    const struct contact_lanes *p = end->corner;
    struct contact_lanes a, b, way, across;
    phys_vec dot;
    quick_subtract(p + 2 - is_edges, p + 1 - is_edges, &a);
    quick_subtract(p + 3, p + 1 + is_edges, &b);
    quick_subtract(p, p + 1 + is_edges, &way);
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        across.c[c] = a.c[d] * b.c[e] - a.c[e] * b.c[d];
    }
    quick_dot(&across, &way, &dot);
    const contact_mask sign = (contact_mask)dot & bit;
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        n->c[c] += (phys_vec)((contact_mask)across.c[c] ^ sign);
}

PHYS_INLINE void quick_choose(bool most, const phys_vec *a, const phys_vec *b, phys_vec *to)
{
    const contact_mask is = most ? *a > *b : *a < *b;
    contact_choose(&is, a, b, to);
}

/* contact_apart along n; the first corner is at 0. */
PHYS_INLINE void quick_apart(enum contact_pair pair, const struct quick_end *end,
                             const struct contact_lanes *n, phys_vec *to)
{
    phys_vec along[3], first = {0}, last;
    PHYS_UNROLL
    for (int k = 0; k < 3; k++) {
        const phys_vec *x = end->against[k].c;
        along[k] = (n->c[0] * x[0] + n->c[1] * x[1]) + n->c[2] * x[2];
    }
    quick_choose(true, along + 1, along + 2, &last);
    if (pair == CONTACT_VT)
        quick_choose(true, along, &last, &last);
    else
        quick_choose(false, along, &first, &first);
    *to = first - last;
}

/* True if all differences are numbers below 2 m. All bits or'ed together are no less than the bits
 * of each. */
PHYS_INLINE void quick_small(const struct quick_end *x, const struct quick_end *y, contact_mask *is)
{
    const contact_mask two = (contact_mask)(phys_vec){2, 2, 2, 2},
                       number = ~(contact_mask){INT64_MIN, INT64_MIN, INT64_MIN, INT64_MIN};
    contact_mask bits = {0};
    PHYS_UNROLL
    for (int k = 0; k < 3; k++) {
        PHYS_UNROLL
        for (int c = 0; c < 3; c++)
            bits |= (contact_mask)x->against[k].c[c] | (contact_mask)y->against[k].c[c];
    }
    *is = (bits & number) < two;
}

/* Finds which of four pairs the sum of the directions across both features at the start and at the
 * end proves, with an f(1) that is enough after any gap. Most pairs end here. */
PHYS_INLINE void pass_quickly(enum contact_pair pair, const phys_vec *const x[4],
                              const phys_vec *const y[4], double thickness, double reach,
                              contact_mask *passing)
{
    static const double OFF = 36 * CONTACT_ROUNDING; /* m: of 18 differences below 2 m */
    const double part = 0.1 * thickness, far = contact_far_of(reach) + OFF;
    const double least = part > CONTACT_MARGIN + OFF ? part : CONTACT_MARGIN + OFF;
    struct quick_end begin, end;
    struct contact_lanes n = {{{0}}};
    phys_vec square, before, after, nearer;
    contact_mask small;
    quick_open(x, &begin);
    quick_open(y, &end);
    quick_across(pair, &begin, &n);
    quick_across(pair, &end, &n);
    quick_dot(&n, &n, &square);
    quick_apart(pair, &begin, &n, &before);
    quick_apart(pair, &end, &n, &after);
    quick_small(&begin, &end, &small);
    quick_choose(false, &before, &after, &nearer);
    const contact_mask passes =
        (before > CONTACT_TINY) &
        (before * before > square * ((CONTACT_LEAST + OFF) * (CONTACT_LEAST + OFF))) & (after > 0) &
        (after * after >= square * (least * least)) & small;
    const contact_mask by = nearer * nearer > square * (far * far);
    *passing = (int64_t)CONTACT_MAY_TOUCH + passes + (passes & by); /* true is -1 */
}

/* Certifies n pairs of one kind, at most four. */
PHYS_INLINE void pass_four(enum contact_pair pair, size_t n, const size_t at[4],
                           const struct contact_moving *moving, double thickness, double reach,
                           enum contact_passing *passing)
{
    const phys_vec *x[4], *y[4];
    contact_mask is;
    for (size_t k = 0; k < 4; k++) {
        const struct contact_moving *of = moving + at[k < n ? k : 0];
        x[k] = of->x;
        y[k] = of->y;
    }
    pass_quickly(pair, x, y, thickness, reach, &is);
    for (size_t k = 0; k < n; k++)
        passing[at[k]] = (enum contact_passing)is[k];
}

PHYS_KERNEL(contact_pass_all,
            (size_t n, const struct contact_moving *moving, double thickness, double reach,
             enum contact_passing *passing),
            (n, moving, thickness, reach, passing))
{
    size_t points[4], edges[4], n_points = 0, n_edges = 0;
    for (size_t i = 0; i < n; i++) {
        const bool is_edges = moving[i].pair == CONTACT_EE;
        if (is_edges)
            edges[n_edges++] = i;
        else
            points[n_points++] = i;
        if (n_edges == 4 || (i + 1 == n && n_edges)) {
            pass_four(CONTACT_EE, n_edges, edges, moving, thickness, reach, passing);
            n_edges = 0;
        }
        if (n_points == 4 || (i + 1 == n && n_points)) {
            pass_four(CONTACT_VT, n_points, points, moving, thickness, reach, passing);
            n_points = 0;
        }
    }
    for (size_t i = 0; i < n; i++)
        if (passing[i] == CONTACT_MAY_TOUCH)
            passing[i] =
                contact_pass_closely(moving[i].pair, moving[i].x, moving[i].y, thickness, reach);
}

enum contact_passing contact_pass(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                                  double thickness, double reach)
{
    struct contact_moving moving = {.pair = pair};
    enum contact_passing passing;
    memcpy(moving.x, x, sizeof moving.x);
    memcpy(moving.y, y, sizeof moving.y);
    contact_pass_all(1, &moving, thickness, reach, &passing);
    return passing;
}

bool contact_certify(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                     double thickness)
{
    return contact_pass(pair, x, y, thickness, INFINITY) != CONTACT_MAY_TOUCH;
}
