#ifndef CLOTH_VIEW_PICK_H
#define CLOTH_VIEW_PICK_H

#include "cloth/mesh/mesh.h"
#include "cloth/view/view.h"

/* Vertices that somebody points at. Pure functions. */

#define VIEW_PICKED_NONE UINT32_MAX /* no vertex */

/* The vertex that is seen at a place of a window, in pixels from its left upper corner: the nearest
 * corner of the nearest triangle there, else the nearest vertex of a lone edge within a few pixels.
 * position: of the mesh's vertices, x 3, m. Returns VIEW_PICKED_NONE where there is none. */
uint32_t view_pick(const struct view_camera *camera, int width, int height, const struct mesh *mesh,
                   const double *position, double x, double y);

/* A vertex by the names of its cloth and panel. The mesh has the cloths' names as groups, as a
 * folder's cloth.obj has them. end: one behind the last vertex of each of n_cloths; n_cloths 0:
 * there is one. */
struct view_picked {
    uint32_t vertex;           /* in the numbering of its cloth, from 0 */
    const char *cloth, *panel; /* NULL: it has none; they are the mesh's */
};
struct view_picked view_picked_of(const struct mesh *mesh, uint32_t n_cloths, const uint32_t *end,
                                  uint32_t vertex);
/* The line of a scene that probes it. */
void view_picked_probe(const struct view_picked *picked, size_t size, char line[size]);

#endif
