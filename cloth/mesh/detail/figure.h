#ifndef CLOTH_MESH_DETAIL_FIGURE_H
#define CLOTH_MESH_DETAIL_FIGURE_H

#include "cloth/mesh/mesh.h"

/* Meshes of files of other programs, read by the library Assimp where that is built in. Local. */

/* The length of a path whose ending is that of glTF, FBX, Collada, PLY or STL; # and the name of a
 * node may follow. 0: it has another ending. */
size_t mesh_figure_path(const char *path);

/* Reads such a file: the polygons of all its nodes, or of the node that is named and what hangs at
 * it, where they are when nothing is animated, in the lengths and axes that the file has. Vertices
 * of one node at one place are one, so that a surface that is cut for uv, normals or materials is
 * whole. Polygons that this leaves fewer than three corners go; points and lines are not read. Each
 * node with polygons is a group. uv: the first ones. fans: as of struct mesh_source. Errors:
 * CLOTH_E_INPUT, with the file and what Assimp says; CLOTH_E_IO, CLOTH_E_MEMORY, and
 * CLOTH_E_LIBRARY where Assimp is left out. After an error the mesh is empty. */
int mesh_read_figure(struct mesh *mesh, const char *path, bool fans, struct cloth_error *error);

#endif
