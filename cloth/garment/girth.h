#ifndef CLOTH_GARMENT_GIRTH_H
#define CLOTH_GARMENT_GIRTH_H

#include "cloth/mesh/slice.h"

#include <stdbool.h>
#include <stdint.h>

/* Checks that a garment is wide enough for a body, before it is sewn. */

/* Pairs of vertices along a seam, in their order. */
struct girth_seam {
    uint32_t n;
    const uint32_t (*pair)[2];
};

struct girth_worst {
    bool found;              /* else nothing could be compared */
    double y, garment, body; /* m: the height, and both girths there */
};

/* Compares the girths of a garment, whose panels stand around a body, with the body's, y up, and
 * finds the height where their ratio is least. Panels are cut by horizontal planes; cuts that meet
 * at seams are joined, and those that close are girths. The body's girth is the length around the
 * convex hull of its parts inside the garment's loop. The least within 4 cm of the height counts,
 * since panels are not yet where they will be worn. Heights where a part of the body is only partly
 * surrounded are left out. Error: CLOTH_E_MEMORY. Local. */
int girth_compare(struct girth_worst *worst, const struct slice_mesh *garment, uint32_t n_seams,
                  const struct girth_seam *seam, const struct slice_mesh *body,
                  struct cloth_error *error);

/* True if the garment is too small by more than 2 %, which cloth gives. */
static inline bool girth_too_small(const struct girth_worst *worst)
{
    return worst->found && worst->body > 1.02 * worst->garment;
}

#endif
