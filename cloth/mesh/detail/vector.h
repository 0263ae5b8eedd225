#ifndef CLOTH_MESH_DETAIL_VECTOR_H
#define CLOTH_MESH_DETAIL_VECTOR_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* Lengths and areas in positions of n x 3 metres; + - * and sqrt only, always in this order of
 * operations. */

static inline double mesh_distance(const double *position, uint32_t a, uint32_t b)
{
    const double *p = position + 3 * (size_t)a, *q = position + 3 * (size_t)b;
    double x = q[0] - p[0], y = q[1] - p[1], z = q[2] - p[2];
    return sqrt(x * x + y * y + z * z);
}

/* Of the triangle with these three corners, m^2. */
static inline double mesh_area(const double *position, const uint32_t *corner)
{
    const double *p = position + 3 * (size_t)corner[0];
    const double *q = position + 3 * (size_t)corner[1], *r = position + 3 * (size_t)corner[2];
    double u[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    double v[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2],
           z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z); /* |u x v| / 2 */
}

#endif
