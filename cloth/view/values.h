#ifndef CLOTH_VIEW_VALUES_H
#define CLOTH_VIEW_VALUES_H

#include "cloth/output/output.h"
#include "cloth/view/colour.h"

/* Numbers that colour the vertices of a folder's frames. Local; one thread. */

struct view_values;

/* cache and folder stay the caller's, and outlive it. Files are opened when they are asked for.
 * *values: to be closed in any case. Error: CLOTH_E_MEMORY. */
int view_values_open(struct view_values **values, struct output_cache *cache, const char *folder,
                     struct cloth_error *error);
/* Gives each vertex of a frame the number of its part, or its number on a scale; NaN: there is
 * none. position: n_vertices x 3 of the frame, m. Strain of a vertex: the mean of that of its
 * triangles (cloth/element/strain.h), by their area at rest; without triangles, that of its edges,
 * by length. Stress is averaged likewise, from the larger eigenvalue of each triangle's elastic
 * stress; vertices of springs have none. Errors: CLOTH_E_INPUT, the folder does not say;
 * CLOTH_E_MEMORY. */
int view_values_at(struct view_values *values, enum view_colour by, uint64_t frame,
                   const double *position, double *value, struct cloth_error *error);
/* How many frames have these numbers. Errors as before. */
int view_values_frames(struct view_values *values, enum view_colour by, uint64_t *n_frames,
                       struct cloth_error *error);
void view_values_close(struct view_values *values);

#endif
