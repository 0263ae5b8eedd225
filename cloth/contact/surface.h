#ifndef CLOTH_CONTACT_SURFACE_H
#define CLOTH_CONTACT_SURFACE_H

#include "cloth/contact/shape.h"

/* The surface of a shape in triangles, for pictures. Pure functions. */

enum {
    CONTACT_CELLS = 32, /* along each edge of the box around it */
    CONTACT_SURFACE_VERTICES = 6 * (CONTACT_CELLS + 1) * (CONTACT_CELLS + 1),
    CONTACT_SURFACE_TRIANGLES = 12 * CONTACT_CELLS * CONTACT_CELLS
};

/* Counts the vertices and triangles of a surface; none: the shape has no bounds. body: that of the
 * shape, or NULL. */
void contact_surface_count(const struct contact_shape *shape, const struct contact_body *body,
                           uint32_t *n_vertices, uint32_t *n_triangles);

/* Makes the surface of a shape with bounds, in the axes of its parameters. vertex: point (m) and
 * normal of each. Each side of the box around the shape has vertices of its own, of a body each
 * corner of a triangle. triangle: numbers of vertices, counterclockwise from outside. */
void contact_surface(const struct contact_shape *shape, const struct contact_body *body,
                     double (*vertex)[6], uint32_t (*triangle)[3]);

#endif
