#ifndef CLOTH_PHYSICS_ENERGY_H
#define CLOTH_PHYSICS_ENERGY_H

#include "cloth/physics/spring.h"

/* Energies besides that of motion (phys_kinetic), J, summed in the order of the rows or springs.
 * Units as of cloth/physics/particle.h and spring.h. Pure functions; nothing is allocated. */

/* Minus the sum of m gravity.x: of weights in a field of gravity (m/s^2), zero at the origin. */
double phys_energy_weight(size_t n, const double *mass, const double gravity[3], const phys_vec *x);

/* Minus the sum of (load - m gravity).x: of constant forces besides the weight, zero at the origin.
 * load: N, the weight included. */
double phys_energy_load(size_t n, const double *mass, const double gravity[3], const phys_vec *load,
                        const phys_vec *x);

/* Sum of k (l - L)^2 / 2. End 1 is looked up in x_other, which is x where both ends are here. */
double phys_energy_springs(const struct phys_springs *springs, const phys_vec *x,
                           const phys_vec *x_other);

#endif
