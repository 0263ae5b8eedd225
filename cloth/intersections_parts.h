#ifndef CLOTH_INTERSECTIONS_PARTS_H
#define CLOTH_INTERSECTIONS_PARTS_H

#include "cloth/base/error.h"

#include <stdint.h>

/* A vertex of each part of n vertices whose triangles are joined, the lowest: *n_parts of them,
 * ascending, in *part, which the caller frees. Vertices without triangles are no part. Error:
 * CLOTH_E_MEMORY. */
int intersections_parts(uint32_t n, uint32_t n_triangles, const uint32_t (*corner)[3],
                        uint32_t **part, uint32_t *n_parts, struct cloth_error *error);

#endif
