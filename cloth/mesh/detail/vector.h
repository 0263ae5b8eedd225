#ifndef CLOTH_MESH_DETAIL_VECTOR_H
#define CLOTH_MESH_DETAIL_VECTOR_H

#include "cloth/base/vector.h"

#include <stdint.h>

/* Lengths and areas in positions of n x 3 metres. */

static inline double mesh_distance(const double *position, uint32_t a, uint32_t b)
{
    return cloth_distance(position + 3 * (size_t)a, position + 3 * (size_t)b);
}

/* Of the triangle with these three corners, m^2. */
static inline double mesh_area(const double *position, const uint32_t *corner)
{
    double normal[3];
    cloth_normal(position + 3 * (size_t)corner[0], position + 3 * (size_t)corner[1],
                 position + 3 * (size_t)corner[2], normal);
    return 0.5 * sqrt(cloth_dot(normal, normal));
}

#endif
