#ifndef CLOTH_MESH_DETAIL_POLYGON_H
#define CLOTH_MESH_DETAIL_POLYGON_H

#include "cloth/base/error.h"

#include <stdint.h>

enum { MESH_MAX_CORNERS = 10000 }; /* of a polygon that is not convex: it takes n^2 or more */

/* How a cut ended. */
enum mesh_polygon {
    MESH_POLYGON_CUT,
    MESH_POLYGON_NO_AREA,   /* its corners are on one line, or its parts cancel */
    MESH_POLYGON_CROSSES,   /* two of its sides meet where they are no neighbours, or fold back */
    MESH_POLYGON_TOO_LARGE, /* more than MESH_MAX_CORNERS corners, and not convex */
    MESH_POLYGON_NO_MEMORY
};

/* Cuts a polygon into n - 2 triangles of its corners, wound as it is. They are a fan from its first
 * corner if all triangles of that fan lie in the polygon, as those of any strictly convex polygon
 * do. Else ears are clipped (Meisters 1975), the first one at or after each corner in turn. The
 * polygon is projected along the axis nearest to its normal (Newell's, as in Sutherland, Sproull &
 * Schumacker 1974); for flat polygons that is its own plane. position: x 3 of all vertices; corner:
 * n >= 3 of these; triangle: (n - 2) x 3. Angles below 1e-9 count as flat; ears with an angle below
 * 1e-3 come last. side: those that cross, from these corners on to the next ones, from 0. Only the
 * lack of memory has a message. Local. */
enum mesh_polygon mesh_polygon_cut(const double *position, uint32_t n, const uint32_t *corner,
                                   uint32_t *triangle, uint32_t side[2], struct cloth_error *error);

/* The n - 2 triangles that its first corner makes with its sides, whatever its shape. */
void mesh_polygon_fan(uint32_t n, const uint32_t *corner, uint32_t *triangle);

#endif
