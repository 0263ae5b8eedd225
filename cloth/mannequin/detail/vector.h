#ifndef CLOTH_MANNEQUIN_DETAIL_VECTOR_H
#define CLOTH_MANNEQUIN_DETAIL_VECTOR_H

#include <math.h>

/* Vectors of three doubles. */

static inline double vector_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double vector_distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(vector_dot(d, d));
}

/* The normal of a triangle, as long as twice its area. */
static inline void vector_normal(const double a[3], const double b[3], const double c[3],
                                 double normal[3])
{
    const double p[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double q[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    normal[0] = p[1] * q[2] - p[2] * q[1];
    normal[1] = p[2] * q[0] - p[0] * q[2];
    normal[2] = p[0] * q[1] - p[1] * q[0];
}

/* The cosine of the angle between two vectors; 0 if one has no length. */
static inline double vector_cosine(const double a[3], const double b[3])
{
    const double lengths = sqrt(vector_dot(a, a) * vector_dot(b, b));
    return lengths > 0 ? vector_dot(a, b) / lengths : 0;
}

#endif
