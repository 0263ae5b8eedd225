#ifndef CLOTH_MESH_DETAIL_EQUILATERAL_H
#define CLOTH_MESH_DETAIL_EQUILATERAL_H

#include "cloth/mesh/mesh.h"

/* The part of mesh_grid that is about MESH_EQUILATERAL; the sizes are checked. Error:
 * CLOTH_E_MEMORY. Local. */
int mesh_equilateral(struct mesh *mesh, double width, uint32_t nx, uint32_t ny,
                     struct cloth_error *error);

#endif
