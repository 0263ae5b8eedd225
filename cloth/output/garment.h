#ifndef CLOTH_OUTPUT_GARMENT_H
#define CLOTH_OUTPUT_GARMENT_H

#include "cloth/garment/garment.h"

/* Writes the mesh of a garment as a Wavefront OBJ: v in metres, vt of every vertex in metres, a
 * group a panel in the pattern's order. An old file of that name is replaced when the new one is
 * whole. Errors: CLOTH_E_INPUT where it cannot be written to, CLOTH_E_IO, CLOTH_E_MEMORY. Local. */
int output_garment_obj(const char *path, const struct garment *garment,
                       const struct garment_pattern *pattern, struct cloth_error *error);

/* Writes what belongs to that mesh as JSON: the vertices of each panel and edge, and the pairs of
 * vertices of each stitch, counted from 0 (docs/garments.md). Errors as above. Local. */
int output_garment_seams(const char *path, const struct garment *garment,
                         const struct garment_pattern *pattern, struct cloth_error *error);

/* Writes a pattern in the format of docs/garments.md, in metres; scene_read_pattern reads back the
 * same bits. Errors as above. Local. */
int output_pattern(const char *path, const struct garment_pattern *pattern,
                   struct cloth_error *error);

#endif
