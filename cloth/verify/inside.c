/* A line from the point to somewhere beyond the surface crosses an odd number of its triangles if
 * the point is inside. If the line touches an edge or a corner, or its end is in the plane of a
 * triangle, another line is tried. */
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"

#include <math.h>

enum { LINES = 16 };

/* 1 if the line crosses the triangle, 0 if not, -1 if only touching tells. */
static int crosses(const double from[3], const double to[3], const double *a, const double *b,
                   const double *c)
{
    const int begin = verify_orient(a, b, c, from), end = verify_orient(a, b, c, to);
    if (begin * end > 0)
        return 0;
    const int ab = verify_orient(from, to, a, b), bc = verify_orient(from, to, b, c);
    const int ca = verify_orient(from, to, c, a);
    if (ab * bc < 0 || bc * ca < 0 || ca * ab < 0)
        return 0;
    return begin && end && ab && bc && ca ? 1 : -1;
}

/* The number of triangles that the line crosses; -1: undecided. */
static int64_t count_crossed(const struct verify_soup *soup, uint32_t first, uint32_t end,
                             const double from[3], const double to[3])
{
    int64_t n = 0;
    for (uint32_t t = first; t < end; t++) {
        const uint32_t *corner = soup->corner[t];
        const int one =
            crosses(from, to, soup->x[corner[0]], soup->x[corner[1]], soup->x[corner[2]]);
        if (one < 0)
            return -1;
        n += one;
    }
    return n;
}

bool verify_inside(const struct verify_soup *soup, uint32_t first, uint32_t end, const double at[3])
{
    double high = at[0];
    for (uint32_t t = first; t < end; t++)
        for (int i = 0; i < 3; i++)
            high = fmax(high, soup->x[soup->corner[t][i]][0]);
    const double far = 2 * (high - at[0]) + 1;
    for (int k = 0; k < LINES; k++) {
        const double to[3] = {at[0] + far, at[1] + far * (k * 0.0371 + 0.0123),
                              at[2] - far * (k * 0.0173 - 0.0317)};
        const int64_t n = count_crossed(soup, first, end, at, to);
        if (n >= 0)
            return n % 2;
    }
    return false; /* it is on the surface */
}
