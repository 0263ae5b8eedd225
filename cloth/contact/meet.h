#ifndef CLOTH_CONTACT_MEET_H
#define CLOTH_CONTACT_MEET_H

#include "cloth/contact/shape.h"

/* The response of a vertex to a shape, along the normal alone, without friction. Pure functions
 * without allocations. */

/* After a step: puts the vertices that are on or in a shape onto its surface, and gives those that
 * go into it the normal velocity of the surface. Tangential velocities do not change. Returns how
 * many vertices it put there. free: 1 for a vertex that moves, 0 for one that is held; x: m, v:
 * m/s. */
size_t contact_project(const struct contact_shape *shape, const struct contact_pose *pose, size_t n,
                       const double *free, phys_vec *x, phys_vec *v);

/* The same for one vertex, which leaves the shape along `way` with way.normal = 1. hit: that of
 * contact_closest at x. */
bool contact_leave(const struct contact_hit *hit, const phys_vec *way, phys_vec *x, phys_vec *v);

#endif
