#ifndef CLOTH_GARMENT_DETAIL_SEAMS_H
#define CLOTH_GARMENT_DETAIL_SEAMS_H

#include "cloth/garment/garment.h"

/* Pairs the vertices of all stitches of a garment that has its pieces, each in the direction that
 * docs/garments.md says. Error: CLOTH_E_MEMORY. Local. */
int seams_make(struct garment *garment, const struct garment_pattern *pattern,
               struct cloth_error *error);

#endif
