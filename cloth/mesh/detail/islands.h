#ifndef CLOTH_MESH_DETAIL_ISLANDS_H
#define CLOTH_MESH_DETAIL_ISLANDS_H

#include "cloth/mesh/mesh.h"

#define MESH_NO_UV 0xffffffffu

/* Gives the uv of corners to a mesh that has its faces and triangles. uv: a list of u and v;
 * corner: of all faces in turn, the vertex and a number in the list, which exists, or MESH_NO_UV.
 * Error: CLOTH_E_MEMORY. Local. */
int mesh_islands_make(struct mesh *mesh, const double (*uv)[2], const uint32_t (*corner)[2],
                      struct cloth_error *error);

#endif
