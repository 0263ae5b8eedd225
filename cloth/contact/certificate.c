/* The cut of a pair. Only the comparisons of certificate_four.c make a pair certain: the choice of
 * direction and plane changes how many pairs are certain, never correctness. */
#include "cloth/contact/certificate.h"

#include "cloth/contact/direction.h"

#include <math.h>

PHYS_INLINE double lanes_size(const struct contact_lanes *x, const struct contact_lanes *y)
{
    const contact_mask sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
    phys_vec sum = {0};
    PHYS_UNROLL
    for (int c = 0; c < 3; c++)
        sum += (phys_vec)((contact_mask)x->c[c] & sign) + (phys_vec)((contact_mask)y->c[c] & sign);
    return phys_lanes(&sum);
}

/* The least f(1), m. */
PHYS_INLINE double least_after(double before, double thickness)
{
    const double half = 0.5 * before, part = 0.1 * thickness;
    return half < part ? half : part;
}

/* A cut along a unit direction. Heights are above corner 0 at x; those at the end lack the motion
 * that all corners share. A plane divides the features at the end. */
struct cut {
    enum contact_pair pair;
    unsigned held;
    phys_vec begin, end; /* m, by corner */
    double shared;       /* m */
    double half, off;    /* m: the least distance left; the rounding of the ends */
    double low, high;    /* of the plane, m */
};

PHYS_INLINE bool is_first(const struct cut *cut, int corner)
{
    return corner < (cut->pair == CONTACT_VT ? 1 : 2);
}

static bool certificate_is_held(const struct cut *cut, int corner)
{
    return cut->held >> corner & 1;
}

/* A rounded x + t (y - x) is off by less than 3 u of its coordinates, its height by less than 5 u
 * of its differences. This bound is more than twice as large; it is not finite if an input is
 * not. */
static double cut_rounding(const phys_vec x[4], const phys_vec y[4],
                           const struct contact_lanes *begin, const struct contact_lanes *end)
{
    double most = 0;
    for (int k = 0; k < 4; k++) {
        double size = 0;
        for (int c = 0; c < 3; c++)
            size += fabs(x[k][c]) + fabs(y[k][c]);
        most = fmax(most, size);
    }
    return 0x1p-50 * most + 0x1p-49 * lanes_size(begin, end);
}

/* The plane moves with the slowest corner where all go the same way, and far. Those in front are
 * then not cut, since they do not come nearer to it. */
static void cut_share(struct cut *cut, double far)
{
    const phys_vec way = cut->end - cut->begin;
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < 4; k++) {
        least = fmin(least, way[k]);
        most = fmax(most, way[k]);
    }
    cut->shared = least > far ? least : most < -far ? most : 0;
    for (int k = 0; k < 4; k++)
        cut->end[k] -= cut->shared;
}

/* The range of the plane: each cut corner has room at x, and each held one at y. */
static void cut_bounds(struct cut *cut)
{
    cut->low = -INFINITY;
    cut->high = INFINITY;
    for (int k = 0; k < 4; k++) {
        const double at = certificate_is_held(cut, k) ? cut->end[k] : cut->begin[k];
        if (is_first(cut, k))
            cut->high = fmin(cut->high, at - cut->half);
        else
            cut->low = fmax(cut->low, at + cut->half);
    }
}

/* The plane: the side that comes nearer takes the room. */
static double cut_plane(const struct cut *cut)
{
    double first = 0, second = 0;
    for (int k = 0; k < 4; k++) {
        const double rise = certificate_is_held(cut, k) ? 0 : cut->end[k] - cut->begin[k];
        if (is_first(cut, k))
            first = fmax(first, -rise);
        else
            second = fmax(second, rise);
    }
    const double both = first + second;
    const double part = both > 0 ? second / both : 0.5;
    return cut->low + part * (cut->high - cut->low);
}

static void cut_corners(const struct cut *cut, double plane, double t[4])
{
    for (int k = 0; k < 4; k++) {
        const double side = is_first(cut, k) ? 1 : -1;
        const double from = side * (cut->begin[k] - plane), to = side * (cut->end[k] - plane);
        const double least = fmax(cut->half, 0.1 * from), all = from - side * cut->shared;
        if (!certificate_is_held(cut, k) && to < least - 0.5 * cut->off)
            t[k] = fmin(t[k], fmax((all - least) / (all - to), 0));
    }
}

/* All that is not held stays where it is. */
static bool cut_all(const struct cut *cut, const phys_vec x[4], const phys_vec y[4],
                    double thickness, double t[4])
{
    phys_vec end[4];
    for (int k = 0; k < 4; k++)
        end[k] = certificate_is_held(cut, k) ? y[k] : x[k];
    if (!contact_certify(cut->pair, x, end, thickness))
        return false;
    for (int k = 0; k < 4; k++)
        if (!certificate_is_held(cut, k))
            t[k] = 0;
    return true;
}

/* The direction that parts the features most at x, of those that contact_certify tries; returns by
 * how much, m. */
static double cut_direction(enum contact_pair pair, const phys_vec x[4], phys_vec *best)
{
    struct contact_lanes at;
    phys_vec n[3];
    double gap = 0;
    contact_lanes_of(x, x, &at);
    contact_across(pair, x, &at, n);
    const double square = contact_between(pair, &at, n + 1);
    const bool is_near = !(square > CONTACT_NEAR * CONTACT_NEAR * contact_square(&at));
    if (is_near)
        contact_direction_best(pair, x, n + 2);
    for (int i = 0; i < 2 + is_near; i++) {
        const double length = sqrt(phys_dot(n + i, n + i));
        phys_vec along;
        contact_along(&at, n + i, &along);
        const double own = length > CONTACT_TINY ? contact_apart(pair, &along) / length : 0;
        if (!(own > gap))
            continue;
        gap = own;
        *best = n[i] / length;
    }
    return gap;
}

bool contact_cut(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4], double thickness,
                 unsigned held, double t[4])
{
    /* Somewhat more than contact_certify asks, so that a cut that is cut again still passes. */
    static const double MORE = 1.1;
    static const double FAR = 2; /* thicknesses */
    struct cut cut = {.pair = pair, .held = held};
    struct contact_lanes begin, end;
    phys_vec n = {0};
    const double gap = cut_direction(pair, x, &n), least = least_after(gap, thickness);
    contact_lanes_of(x, x, &begin);
    contact_lanes_of(x, y, &end);
    cut.off = cut_rounding(x, y, &begin, &end);
    cut.half = 0.5 * MORE * (CONTACT_MARGIN > least ? CONTACT_MARGIN : least) + cut.off;
    if (!isfinite(cut.half))
        return false;
    contact_along(&begin, &n, &cut.begin);
    contact_along(&end, &n, &cut.end);
    cut_share(&cut, FAR * thickness);
    cut_bounds(&cut);
    if (!(gap > CONTACT_LEAST + cut.off) || !(cut.low <= cut.high))
        return cut_all(&cut, x, y, thickness, t);
    cut_corners(&cut, cut_plane(&cut), t);
    return true;
}
