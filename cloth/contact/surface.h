#ifndef CLOTH_CONTACT_SURFACE_H
#define CLOTH_CONTACT_SURFACE_H

#include "cloth/contact/shape.h"

/* The surface of a shape in triangles, for pictures. Pure functions. */

enum {
    CONTACT_CELLS = 32, /* along each edge of the box around it */
    CONTACT_SURFACE_VERTICES = 6 * (CONTACT_CELLS + 1) * (CONTACT_CELLS + 1),
    CONTACT_SURFACE_TRIANGLES = 12 * CONTACT_CELLS * CONTACT_CELLS
};

/* Makes the surface of a shape with bounds, in the axes of its parameters. vertex: point (m) and
 * normal of each; each side of the box around the shape has vertices of its own. triangle: numbers
 * of vertices, counterclockwise from outside. */
void contact_surface(const struct contact_shape *shape, double (*vertex)[6],
                     uint32_t (*triangle)[3]);

#endif
