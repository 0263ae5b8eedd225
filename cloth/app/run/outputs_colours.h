#ifndef CLOTH_APP_RUN_OUTPUTS_COLOURS_H
#define CLOTH_APP_RUN_OUTPUTS_COLOURS_H

#include "cloth/flow/run.h"
#include "cloth/output/colours.h"

/* Data that viewers colour the cloth of a run by, on rank 0. A full disk does not end the run: one
 * warning says so, *colours becomes NULL, and nothing more is written. Local functions. */

/* Its size on the disk for a run of this model alone, bytes, about. While there are meshes. */
double outputs_colours_bytes(const struct model *model, uint64_t n_vertices);

/* Shapes at rest of the cloths of a model, from a frame on. While there are meshes. Errors:
 * CLOTH_E_MEMORY. */
int outputs_colours_rest(struct output_colours **colours, const struct model *model, uint64_t frame,
                         struct cloth_error *error);
/* The places of a frame. Error: CLOTH_E_MEMORY. */
int outputs_colours_places(struct output_colours **colours, uint64_t frame,
                           const struct flow_places *places, struct cloth_error *error);

#endif
