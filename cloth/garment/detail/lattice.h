#ifndef CLOTH_GARMENT_DETAIL_LATTICE_H
#define CLOTH_GARMENT_DETAIL_LATTICE_H

#include "cloth/base/error.h"

#include <stdint.h>

/* The vertices of equilateral triangles of a given edge length that are inside a polygon, and not
 * nearer to its boundary than a part of that length: row by row, every other one from right to
 * left. n places of a closed loop; *places (*count of them) belong to the caller. Errors:
 * CLOTH_E_INPUT for more than 2^28 places in the polygon's box, CLOTH_E_MEMORY. Local. */
int garment_lattice(uint32_t n, const double (*loop)[2], double edge, uint32_t *count,
                    double (**places)[2], struct cloth_error *error);

#endif
