#ifndef CLOTH_PHYSICS_PARTICLE_H
#define CLOTH_PHYSICS_PARTICLE_H

#include "cloth/physics/vec.h"

#include <stddef.h>

/* Particles one by one: forces from outside, steps of time. Arrays have n rows; `free` is 1
 * for a particle that moves and 0 for one that is held. Pure functions; nothing is allocated. */

/* f = load - drag v. load: N, gravity included; drag: kg/s; v: m/s. */
void phys_outside(size_t n, const phys_vec *load, const double *drag, const phys_vec *v,
                  phys_vec *f);

/* f (N) -> free f / mass (m/s^2). mass: kg, > 0. */
void phys_accelerate(size_t n, const double *mass, const double *free, phys_vec *f);

/* y += scale d: v += h a, v += dv, x += h v. */
void phys_advance(size_t n, double scale, const phys_vec *d, phys_vec *y);

/* Sum of m v.v / 2 (J), rows in order; widens *most to the largest v.v (m^2/s^2). mass: kg. */
double phys_kinetic(size_t n, const double *mass, const phys_vec *v, double *max);

/* The first row of which a component is not finite or not below `bound` in size; n if all are well.
 */
size_t phys_diverged(size_t n, double bound, const phys_vec *y);

#endif
