#ifndef CLOTH_MESH_DETAIL_FINISH_H
#define CLOTH_MESH_DETAIL_FINISH_H

#include "cloth/mesh/mesh.h"

/* Where a mesh came from, so that an error can name the place. */
struct mesh_source {
    const char *path;        /* NULL: arrays of a caller, whose entries are counted from 0 */
    const size_t *face_line; /* with a path: the line of each face, */
    const size_t *edge_line; /* and of each lone edge */
    bool fans;               /* faces that cross or touch themselves are fanned */
};

#define MESH_MAX 0x80000000u /* vertices and corners a mesh may have at most */

/* The end of a path that is too long for a sentence, so that the reason is never cut off. */
const char *mesh_path_shown(const char *path);

/* Checks faces and lone edges (indices, repeated corners), cuts the faces into mesh->triangle
 * (detail/polygon.h) and looks for edges with more than two triangles and lone edges that stand
 * twice. Errors: CLOTH_E_INPUT with the file and line, or
 * the entry; CLOTH_E_MEMORY. What is built belongs to the mesh, also after an error. Local. */
int mesh_finish(struct mesh *mesh, const struct mesh_source *source, struct cloth_error *error);

#endif
