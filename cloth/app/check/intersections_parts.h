#ifndef CLOTH_APP_CHECK_INTERSECTIONS_PARTS_H
#define CLOTH_APP_CHECK_INTERSECTIONS_PARTS_H

#include "cloth/base/error.h"

#include <stdint.h>

/* A vertex that no triangle has. */
#define INTERSECTIONS_NO_PART UINT32_MAX

/* Finds the part of each of n vertices: the lowest vertex that triangles join it to, directly or
 * through others. The caller frees *part. Error: CLOTH_E_MEMORY. */
int intersections_parts(uint32_t n, uint32_t n_triangles, const uint32_t (*corner)[3],
                        uint32_t **part, struct cloth_error *error);

#endif
