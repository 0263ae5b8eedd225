#ifndef TESTS_CLOTH_CONTACT_DISTANCES_H
#define TESTS_CLOTH_CONTACT_DISTANCES_H

#include "cloth/physics/vec.h"

#include <math.h>
#include <stdbool.h>

/* Distances of features in the ways of a textbook (m), which share no code with the product. */

static inline double clamp(double part)
{
    return part < 0 ? 0 : part > 1 ? 1 : part;
}

static inline double length(const phys_vec *of)
{
    return sqrt(phys_dot(of, of));
}

static inline double point_segment(const phys_vec *p, const phys_vec *a, const phys_vec *b)
{
    const phys_vec ab = *b - *a, ap = *p - *a;
    const phys_vec rest = ap - clamp(phys_dot(&ab, &ap) / phys_dot(&ab, &ab)) * ab;
    return length(&rest);
}

/* By the plane if the point is above the inside, else by the edges. */
static inline double vertex_distance(const phys_vec p[4])
{
    const phys_vec u = p[2] - p[1], w = p[3] - p[1];
    const phys_vec normal = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                             u[0] * w[1] - u[1] * w[0], 0};
    double least = (double)INFINITY;
    bool above = true;
    for (int k = 0; k < 3; k++) {
        const phys_vec *a = p + 1 + k, *b = p + 1 + (k + 1) % 3, e = *b - *a, away = p[0] - *a;
        const phys_vec in = {normal[1] * e[2] - normal[2] * e[1],
                             normal[2] * e[0] - normal[0] * e[2],
                             normal[0] * e[1] - normal[1] * e[0], 0};
        above = above && phys_dot(&in, &away) >= 0;
        least = fmin(least, point_segment(p, a, b));
    }
    const phys_vec away = p[0] - p[1];
    return above ? fabs(phys_dot(&normal, &away)) / length(&normal) : least;
}

/* The least distance of ends from the other edge, or where the lines are nearest if that is inside
 * of both. */
static inline double edge_distance(const phys_vec p[4])
{
    const phys_vec u = p[1] - p[0], w = p[3] - p[2], r = p[0] - p[2];
    const double uu = phys_dot(&u, &u), ww = phys_dot(&w, &w), uw = phys_dot(&u, &w);
    const double ur = phys_dot(&u, &r), wr = phys_dot(&w, &r), rest = uu * ww - uw * uw;
    double least = fmin(fmin(point_segment(p, p + 2, p + 3), point_segment(p + 1, p + 2, p + 3)),
                        fmin(point_segment(p + 2, p, p + 1), point_segment(p + 3, p, p + 1)));
    if (rest > 1e-12 * uu * ww) {
        const double s = (uw * wr - ww * ur) / rest, t = (uu * wr - uw * ur) / rest;
        const phys_vec way = r + s * u - t * w;
        if (s > 0 && s < 1 && t > 0 && t < 1)
            least = fmin(least, length(&way));
    }
    return least;
}

#endif
