#ifndef CLOTH_BASE_VECTOR_H
#define CLOTH_BASE_VECTOR_H

#include <math.h>
#include <stddef.h>

/* Places and vectors of three doubles, and of two in a plane: + - * / and sqrt only, always in this
 * order of operations. */

static inline double cloth_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Square of the distance. */
static inline double cloth_square(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return cloth_dot(d, d);
}

static inline double cloth_distance(const double a[3], const double b[3])
{
    return sqrt(cloth_square(a, b));
}

/* y = a x b. */
static inline void cloth_cross(const double a[3], const double b[3], double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* The normal of a triangle, as long as twice its area. */
static inline void cloth_normal(const double a[3], const double b[3], const double c[3],
                                double normal[3])
{
    const double p[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double q[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    cloth_cross(p, q, normal);
}

/* ---- In a plane ---- */

/* Twice the area of a, b, c: above 0 if they are counterclockwise. */
static inline double cloth_turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Square of the distance. */
static inline double cloth_square_2(const double a[2], const double b[2])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

/* The sine and the cosine of the angle at b from a to c, both times the lengths of its two sides.
 * Returns the product of the squares of these lengths. */
static inline double cloth_angle(const double a[2], const double b[2], const double c[2],
                                 double *sine, double *cosine)
{
    const double p[2] = {a[0] - b[0], a[1] - b[1]}, q[2] = {c[0] - b[0], c[1] - b[1]};
    *sine = p[0] * q[1] - p[1] * q[0];
    *cosine = p[0] * q[0] + p[1] * q[1];
    return (p[0] * p[0] + p[1] * p[1]) * (q[0] * q[0] + q[1] * q[1]);
}

/* How far along the segment from a to b, 0 to 1, its place nearest to x is. */
static inline double cloth_segment_part(const double x[2], const double a[2], const double b[2])
{
    const double along[2] = {b[0] - a[0], b[1] - a[1]}, to[2] = {x[0] - a[0], x[1] - a[1]};
    const double length = along[0] * along[0] + along[1] * along[1];
    const double s = length > 0 ? (to[0] * along[0] + to[1] * along[1]) / length : 0;
    return s < 0 ? 0 : s > 1 ? 1 : s;
}

/* Square of the distance from x to the segment from a to b. */
static inline double cloth_segment_square(const double x[2], const double a[2], const double b[2])
{
    const double along[2] = {b[0] - a[0], b[1] - a[1]}, to[2] = {x[0] - a[0], x[1] - a[1]};
    const double s = cloth_segment_part(x, a, b);
    const double d[2] = {to[0] - s * along[0], to[1] - s * along[1]};
    return d[0] * d[0] + d[1] * d[1];
}

/* The box around n places. */
static inline void cloth_box(size_t n, const double (*x)[2], double low[2], double high[2])
{
    for (int k = 0; k < 2; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            low[k] = fmin(low[k], x[i][k]);
            high[k] = fmax(high[k], x[i][k]);
        }
    }
}

#endif
