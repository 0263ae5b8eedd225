#ifndef CLOTH_SCENE_PATTERN_H
#define CLOTH_SCENE_PATTERN_H

#include "cloth/garment/pattern.h"

/* Reads a sewing pattern (JSON, or DXF by its ending; docs/garments.md) and checks it by
 * garment_pattern_check. choice: of a DXF file; may be NULL. Unknown keys, values of
 * a wrong kind and panels that cannot be sewn are CLOTH_E_INPUT errors, which name the file, and
 * panel, edge, line and column where there is one. Lengths become metres. White space in the names
 * of panels becomes `_`. The pattern belongs to the caller (garment_pattern_free), also after an
 * error. Other errors: CLOTH_E_MEMORY. Local. */
int scene_read_pattern(struct garment_pattern *pattern, const char *path,
                       const struct garment_choice *choice, struct cloth_error *error);

#endif
