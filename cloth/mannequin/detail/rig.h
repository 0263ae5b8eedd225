#ifndef CLOTH_MANNEQUIN_DETAIL_RIG_H
#define CLOTH_MANNEQUIN_DETAIL_RIG_H

#include "cloth/mannequin/detail/surface.h"
#include "cloth/mannequin/pose.h"

/* The number of a bone in a rig: of the left and of the right side. */
static const uint32_t rig_bones[2][FIGURE_BONES] = {{0, 1, 2, 3, 4, 5, 6}, {0, 1, 7, 8, 9, 10, 11}};

/* Makes the rig of a figure's whole mesh, whose first half->n vertices are those of the half. Each
 * vertex belongs to the bone of its part, then weights are smoothed along the surface. low: the
 * height in the half where the mesh is 0; scale: by which heights are multiplied, and lengths
 * aside. Error: CLOTH_E_MEMORY. */
int rig_make(struct mannequin_rig *rig, const struct mesh *mesh, const struct surface *half,
             const struct figure *figure, double edge, double low, const double scale[2],
             struct cloth_error *error);

#endif
