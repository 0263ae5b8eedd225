#ifndef CLOTH_OUTPUT_MANNEQUIN_H
#define CLOTH_OUTPUT_MANNEQUIN_H

#include "cloth/base/error.h"
#include "cloth/mesh/mesh.h"

/* Writes a body's mesh as a Wavefront OBJ, v in metres, with 17 digits. An old file of that name is
 * replaced when the new one is whole. Errors: CLOTH_E_INPUT where it cannot be written to,
 * CLOTH_E_IO, CLOTH_E_MEMORY. Local. */
int output_mannequin_obj(const char *path, const struct mesh *mesh, struct cloth_error *error);

#endif
