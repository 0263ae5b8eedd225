/* Nothing is said to be certain but by contact_certify's two comparisons, each with its bound on
 * rounding. Which direction and which plane are taken decides how often, never whether truly. */
#include "cloth/contact/certificate.h"

#include "cloth/contact/direction.h"

#include <math.h>

/* ---- Certify ---- */

/* What rounding may take from f, see the header. */
static const double ROUNDING = 0x1p-50;

/* At the start, and at least: rounding of a direction must not lose a pair that a step before has
 * left at the margin. */
static const double LEAST = CONTACT_MARGIN / 2;

PHYS_INLINE double lanes_size(const struct contact_lanes *x)
{
    phys_vec sum = {0};
    PHYS_UNROLL
    for (int c = 0; c < 3; c++) {
        const contact_mask sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
        sum += (phys_vec)((contact_mask)x->c[c] & sign);
    }
    return phys_lanes(&sum);
}

/* The corners at both ends, and what their rounding may come to. */
struct ends {
    struct contact_lanes x, y;
    double off_x, off_y; /* m */
};

PHYS_INLINE void ends_of(const phys_vec x[4], const phys_vec y[4], struct ends *to)
{
    contact_lanes_of(x, x, &to->x);
    contact_lanes_of(y, y, &to->y);
    to->off_x = ROUNDING * lanes_size(&to->x);
    to->off_y = ROUNDING * lanes_size(&to->y);
}

/* What f(1) must be at least, m. */
PHYS_INLINE double least_after(double before, double thickness)
{
    const double half = 0.5 * before, part = 0.1 * thickness;
    return half < part ? half : part;
}

/* before, after: f(0), f(1) times the length of a direction. gap: the f(0), m, that must not shrink
 * too much. Comparisons are such that a NaN fails them. */
PHYS_INLINE bool ends_apart(const struct ends *ends, double length, double before, double after,
                            double gap, double thickness)
{
    const double least = least_after(gap, thickness), margin = CONTACT_MARGIN + ends->off_y;
    const bool certain = (length > CONTACT_TINY) & (before > length * (LEAST + ends->off_x)) &
                         (after > length * (LEAST + ends->off_y));
    const bool enough = (after >= length * least) & (after >= length * margin);
    return certain & (enough | (after >= length * gap));
}

PHYS_KERNEL_OF(bool, contact_certify,
               (enum contact_pair pair, const phys_vec x[4], const phys_vec y[4], double thickness),
               (pair, x, y, thickness))
{
    struct ends ends;
    double n[3];
    phys_vec along;
    ends_of(x, y, &ends);
    const double before = contact_direction(pair, x, &ends.x, n);
    double length = sqrt(contact_dot(n, n));
    contact_along(&ends.y, n, &along);
    const double gap = before / length;
    if (ends_apart(&ends, length, before, contact_apart(pair, &along), gap, thickness))
        return true;
    const double after = contact_direction(pair, y, &ends.y, n);
    length = sqrt(contact_dot(n, n));
    contact_along(&ends.x, n, &along);
    return ends_apart(&ends, length, contact_apart(pair, &along), after, gap, thickness);
}

/* ---- Cut ---- */

/* A direction of length 1, the heights along it above corner 0 at x, and for the plane that divides
 * the features at the end: how near to it a corner may come, and where it may lie. */
struct cut {
    enum contact_pair pair;
    unsigned held;
    phys_vec begin, end; /* m, by corner */
    double half, off;    /* m: the least distance that is left; what rounding of the ends is */
    double low, high;    /* of the plane, m */
};

PHYS_INLINE bool is_first(const struct cut *cut, int corner)
{
    return corner < (cut->pair == CONTACT_VT ? 1 : 2);
}

static bool is_held(const struct cut *cut, int corner)
{
    return cut->held >> corner & 1;
}

/* What a rounded x + t (y - x) is off by is less than 3 u of its coordinates, its height less than
 * 5 u of its differences; this is more than twice as much. What is not finite gives what is not. */
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
    return 0x1p-50 * most + 0x1p-49 * (lanes_size(begin) + lanes_size(end));
}

/* Where the plane may lie: each corner that is cut has room at x and each held one at y. */
static void cut_bounds(struct cut *cut)
{
    cut->low = -INFINITY;
    cut->high = INFINITY;
    for (int k = 0; k < 4; k++) {
        const double at = is_held(cut, k) ? cut->end[k] : cut->begin[k];
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
        const double rise = is_held(cut, k) ? 0 : cut->end[k] - cut->begin[k];
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
        const double least = fmax(cut->half, 0.1 * from);
        if (!is_held(cut, k) && to < least - 0.5 * cut->off)
            t[k] = fmin(t[k], fmax((from - least) / (from - to), 0));
    }
}

/* All that is not held stays where it is. */
static bool cut_all(const struct cut *cut, const phys_vec x[4], const phys_vec y[4],
                    double thickness, double t[4])
{
    phys_vec end[4];
    for (int k = 0; k < 4; k++)
        end[k] = is_held(cut, k) ? y[k] : x[k];
    if (!contact_certify(cut->pair, x, end, thickness))
        return false;
    for (int k = 0; k < 4; k++)
        if (!is_held(cut, k))
            t[k] = 0;
    return true;
}

bool contact_cut(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4], double thickness,
                 unsigned held, double t[4])
{
    /* Somewhat more than contact_certify asks, so that a cut that is cut again still passes. */
    static const double MORE = 1.1;
    struct cut cut = {.pair = pair, .held = held};
    struct contact_lanes begin, end;
    double n[3];
    contact_lanes_of(x, x, &begin);
    contact_lanes_of(x, y, &end);
    const double apart = contact_direction(pair, x, &begin, n), length = sqrt(contact_dot(n, n));
    const double gap = apart / length, least = least_after(gap, thickness);
    cut.off = cut_rounding(x, y, &begin, &end);
    cut.half = 0.5 * MORE * (CONTACT_MARGIN > least ? CONTACT_MARGIN : least) + cut.off;
    if (!isfinite(cut.half))
        return false;
    for (int c = 0; c < 3; c++)
        n[c] /= length;
    contact_along(&begin, n, &cut.begin);
    contact_along(&end, n, &cut.end);
    cut_bounds(&cut);
    if (!(gap > LEAST + cut.off) || !(cut.low <= cut.high))
        return cut_all(&cut, x, y, thickness, t);
    cut_corners(&cut, cut_plane(&cut), t);
    return true;
}
