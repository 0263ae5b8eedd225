/* Pairs are certified four of one kind at once, a lane each: most of them by the sum of the
 * directions across both features at the start and at the end, the others by the closest directions
 * at either end or by their volume. Lanes do not depend on each other, so a pair has the same
 * verdict among others as alone. Only the comparisons with a bound on rounding, here, make a pair
 * certain. */
#include "cloth/contact/direction.h"
#include "cloth/contact/volume.h"

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
    contact_lanes_product(&a, &b, &across);
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

/* ---- The closest directions ---- */

PHYS_INLINE void closely_root(const phys_vec *of, phys_vec *to)
{
#if defined(__SSE2__)
    typedef double half __attribute__((vector_size(16)));
    half part[2];
    memcpy(part, of, sizeof part);
    part[0] = __builtin_ia32_sqrtpd(part[0]);
    part[1] = __builtin_ia32_sqrtpd(part[1]);
    memcpy(to, part, sizeof part);
#else
    for (int k = 0; k < 4; k++)
        (*to)[k] = sqrt((*of)[k]);
#endif
}

/* The sum of the absolute components of all differences. */
PHYS_INLINE void closely_size(const struct quick_end *x, const struct quick_end *y, phys_vec *size)
{
    const contact_mask number = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
    phys_vec sum[3] = {{0}};
    PHYS_UNROLL
    for (int k = 0; k < 3; k++) {
        PHYS_UNROLL
        for (int c = 0; c < 3; c++)
            sum[k] += (phys_vec)((contact_mask)x->against[k].c[c] & number) +
                      (phys_vec)((contact_mask)y->against[k].c[c] & number);
    }
    *size = sum[1] + (sum[0] + sum[2]);
}

/* The shortest way between a vertex of one and an edge of the other, and its square. */
PHYS_INLINE void closely_between(enum contact_pair pair, const struct quick_end *end,
                                 struct contact_lanes *n, phys_vec *square)
{
    static const unsigned char VERTEX[2][4] = {{0, 0, 0}, {0, 1, 2, 3}};
    static const unsigned char BEGIN[2][4] = {{1, 2, 3}, {2, 2, 0, 0}};
    static const unsigned char END[2][4] = {{2, 3, 1}, {3, 3, 1, 1}};
    const int kind = pair == CONTACT_EE;
    const struct contact_lanes first = {{{0}}};
    const struct contact_lanes *const at[4] = {&first, end->against, end->against + 1,
                                               end->against + 2};
    PHYS_UNROLL
    for (int i = 0; i < 3 + kind; i++) {
        const double side = kind && i > 1 ? -1 : 1;
        const phys_vec sign = {side, side, side, side};
        struct contact_ends ends;
        quick_subtract(at[END[kind][i]], at[BEGIN[kind][i]], &ends.edge);
        quick_subtract(at[VERTEX[kind][i]], at[BEGIN[kind][i]], &ends.way);
        contact_ends_solve(&sign, &ends);
        const contact_mask is = i ? ends.square < *square : (contact_mask){-1, -1, -1, -1};
        contact_choose(&is, &ends.square, i ? square : &ends.square, square);
        PHYS_UNROLL
        for (int c = 0; c < 3; c++)
            contact_choose(&is, ends.way.c + c, i ? n->c + c : ends.way.c + c, n->c + c);
    }
}

/* A direction: f(0) and f(1) along it, all times its length. */
struct closely_along {
    phys_vec length, before, after;
};

PHYS_INLINE void closely_measure(enum contact_pair pair, const struct quick_end *begin,
                                 const struct quick_end *end, const struct contact_lanes *n,
                                 struct closely_along *to)
{
    phys_vec square = (n->c[0] * n->c[0] + n->c[2] * n->c[2]) + n->c[1] * n->c[1];
    closely_root(&square, &to->length);
    quick_apart(pair, begin, n, &to->before);
    quick_apart(pair, end, n, &to->after);
}

/* gap (m) becomes at least that along a direction. */
PHYS_INLINE void closely_widen(const struct closely_along *along, phys_vec *gap)
{
    const phys_vec own = along->before / along->length;
    const contact_mask is = (along->length > CONTACT_TINY) & (own > *gap);
    contact_choose(&is, &own, gap, gap);
}

/* Adds the lanes in which f(1) is enough after a gap, m, and those that are proven, as f(0) is
 * above 0, too. NaN fails. */
PHYS_INLINE void closely_prove(const struct closely_along *along, const phys_vec *gap,
                               double thickness, const phys_vec *off, contact_mask *enough,
                               contact_mask *proven)
{
    const double part = 0.1 * thickness;
    const phys_vec half = 0.5 * *gap, parts = {part, part, part, part};
    const phys_vec margin = CONTACT_MARGIN + *off, certain = along->length * (CONTACT_LEAST + *off);
    phys_vec asked;
    quick_choose(false, &half, &parts, &asked);
    quick_choose(true, &asked, &margin, &asked);
    quick_choose(false, &asked, gap, &asked);
    const contact_mask is = (along->length > CONTACT_TINY) & (along->after > certain) &
                            (along->after >= along->length * asked);
    *enough |= is;
    *proven |= is & (along->before > certain);
}

/* The lanes in which both are above `far`, m. */
PHYS_INLINE void closely_pass_by(const struct closely_along *along, const phys_vec *far,
                                 contact_mask *by)
{
    phys_vec nearer;
    quick_choose(false, &along->before, &along->after, &nearer);
    *by |= (along->length > CONTACT_TINY) & (nearer > along->length * *far);
}

/* The two directions that features may be closest in at one end. *near: features so near that these
 * may be only rounding. */
PHYS_INLINE void closely_directions(enum contact_pair pair, const struct quick_end *end,
                                    struct contact_lanes n[2], contact_mask *near)
{
    phys_vec square, size[3], all;
    n[0] = (struct contact_lanes){{{0}}};
    quick_across(pair, end, n);
    closely_between(pair, end, n + 1, &square);
    PHYS_UNROLL
    for (int k = 0; k < 3; k++)
        contact_lanes_dot(end->against + k, end->against + k, size + k);
    all = CONTACT_NEAR * CONTACT_NEAR * (size[1] + (size[0] + size[2]));
    *near = ~(square > all);
}

/* The best directions of features that are very near; of others none. */
static void closely_best(enum contact_pair pair, const phys_vec *const x[4],
                         const contact_mask *near, struct contact_lanes *n)
{
    phys_vec best[4] = {{0}};
    for (int k = 0; k < 4; k++)
        if ((*near)[k])
            contact_direction_best(pair, x[k], best + k);
    contact_transpose(best, best + 1, best + 2, best + 3, n);
}

PHYS_INLINE bool closely_any(const contact_mask *is)
{
    return (*is)[0] | (*is)[1] | (*is)[2] | (*is)[3];
}

/* Finds which of four pairs the closest directions at the start and at the end prove, the best ones
 * of features that are very near, or the volume that their corners span. */
PHYS_INLINE void pass_closely(enum contact_pair pair, const phys_vec *const x[4],
                              const phys_vec *const y[4], double thickness, double reach,
                              contact_mask *passing)
{
    struct quick_end begin, end;
    struct contact_lanes n[6];
    struct closely_along along[6];
    phys_vec size, off, gap = {0};
    contact_mask near[2], enough = {0}, proven = {0}, by = {0};
    quick_open(x, &begin);
    quick_open(y, &end);
    closely_size(&begin, &end, &size);
    off = CONTACT_ROUNDING * size;
    const phys_vec far = contact_far_of(reach) + off;
    closely_directions(pair, &begin, n, near);
    closely_directions(pair, &end, n + 2, near + 1);
    PHYS_UNROLL
    for (int i = 0; i < 4; i++) {
        closely_measure(pair, &begin, &end, n + i, along + i);
        closely_pass_by(along + i, &far, &by);
    }
    closely_widen(along + 1, &gap);
    closely_widen(along, &gap);
    for (int i = 0; i < 2; i++) {
        if (!closely_any(near + i))
            continue;
        closely_best(pair, i ? y : x, near + i, n + 4 + i);
        closely_measure(pair, &begin, &end, n + 4 + i, along + 4 + i);
        if (!i)
            closely_widen(along + 4, &gap);
        closely_prove(along + 4 + i, &gap, thickness, &off, &enough, &proven);
    }
    PHYS_UNROLL
    for (int i = 0; i < 4; i++)
        closely_prove(along + i, &gap, thickness, &off, &enough, &proven);
    const contact_mask rest = enough & ~proven;
    if (closely_any(&rest)) {
        contact_mask spans;
        contact_spans(begin.against, end.against, &size, &spans);
        proven |= rest & spans;
    }
    *passing = (int64_t)CONTACT_MAY_TOUCH + proven + (proven & by); /* true is -1 */
}

/* ---- All pairs ---- */

/* Certifies n pairs of one kind, at most four. */
PHYS_INLINE void pass_four(bool closely, enum contact_pair pair, size_t n, const size_t at[4],
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
    if (closely)
        pass_closely(pair, x, y, thickness, reach, &is);
    else
        pass_quickly(pair, x, y, thickness, reach, &is);
    for (size_t k = 0; k < n; k++)
        passing[at[k]] = (enum contact_passing)is[k];
}

/* Certifies all pairs quickly, or those that did not pass closely. */
PHYS_INLINE void pass_fours(bool closely, size_t n, const struct contact_moving *moving,
                            double thickness, double reach, enum contact_passing *passing)
{
    size_t at[2][4], some[2] = {0, 0};
    for (size_t i = 0; i <= n; i++) {
        const bool ends = i == n;
        const int kind = !ends && moving[i].pair == CONTACT_EE;
        if (!ends && closely && passing[i] != CONTACT_MAY_TOUCH)
            continue;
        if (!ends)
            at[kind][some[kind]++] = i;
        if (some[0] == 4 || (ends && some[0])) {
            pass_four(closely, CONTACT_VT, some[0], at[0], moving, thickness, reach, passing);
            some[0] = 0;
        }
        if (some[1] == 4 || (ends && some[1])) {
            pass_four(closely, CONTACT_EE, some[1], at[1], moving, thickness, reach, passing);
            some[1] = 0;
        }
    }
}

/* Most calls do not come here. */
PHYS_KERNEL(contact_pass_rest,
            (size_t n, const struct contact_moving *moving, double thickness, double reach,
             enum contact_passing *passing),
            (n, moving, thickness, reach, passing))
{
    pass_fours(true, n, moving, thickness, reach, passing);
}

PHYS_KERNEL(contact_pass_all,
            (size_t n, const struct contact_moving *moving, double thickness, double reach,
             enum contact_passing *passing),
            (n, moving, thickness, reach, passing))
{
    bool rest = false;
    pass_fours(false, n, moving, thickness, reach, passing);
    for (size_t i = 0; i < n; i++)
        rest |= passing[i] == CONTACT_MAY_TOUCH;
    if (rest)
        contact_pass_rest(n, moving, thickness, reach, passing);
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
