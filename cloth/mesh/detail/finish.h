#ifndef CLOTH_MESH_DETAIL_FINISH_H
#define CLOTH_MESH_DETAIL_FINISH_H

#include "cloth/mesh/mesh.h"

/* Where a mesh came from, so that an error can name the place. */
struct mesh_source {
    const char *path;        /* NULL: arrays of a caller, whose entries are counted from 0 */
    const size_t *face_line; /* with a path: the line of each face, NULL: they have none, */
    const size_t *edge_line; /* and of each lone edge */
    bool fans;               /* faces that cross or touch themselves are fanned */
};

#define MESH_MAX 0x80000000u /* vertices and corners a mesh may have at most */

/* The end of a path that is too long for a sentence, so that the reason is never cut off. */
const char *mesh_path_shown(const char *path);

/* Checks faces and lone edges (indices, repeated corners), cuts the faces into mesh->triangle, and
 * looks for edges with more than two triangles and lone edges that stand twice. Errors:
 * CLOTH_E_INPUT with the file and line, or the entry; CLOTH_E_MEMORY. The mesh owns all that
 * is built, also after an error. Local. */
int mesh_finish(struct mesh *mesh, const struct mesh_source *source, struct cloth_error *error);

/* ---- Polygons ---- */

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
