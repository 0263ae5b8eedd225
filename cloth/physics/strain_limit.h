#ifndef CLOTH_PHYSICS_STRAIN_LIMIT_H
#define CLOTH_PHYSICS_STRAIN_LIMIT_H

#include "cloth/physics/element.h"

/* Springs that act one way: an edge longer than a limit is pulled back, a shorter one is free. Let
 * l = |x1 - x0|, u = (x1 - x0) / l and the limit l0 = (1 + a) L, with a the strain from which on it
 * acts and L the length at rest. Then
 *     energy  W = k / 2 (l - l0)^2  where l > l0, else 0                                     (J)
 *     force   k (l - l0) u on corner 0, the opposite on corner 1                             (N)
 *     K = k (u u' + t (I - u u')),  t = 1 - l0 / l,  where l > l0, else 0                    (N/m)
 * Provot (1995) moves the ends of such a spring until it is short enough. Here the limit is an
 * energy; force and K are its derivatives, as of any spring. W and the force are continuous, K is
 * not. K is never indefinite, so nothing is left out of it. There is no damping. Pure functions;
 * nothing is allocated. */

/* Numbers of an edge: k, N/m, >= 0; l0, m, > 0. */
enum { PHYS_LIMIT_STIFFNESS, PHYS_LIMIT_LENGTH };

/* Like the functions of triangles (triangle.h), with one pair each. */
phys_force phys_strain_limits_force;
phys_stiffness phys_strain_limits_stiffness;
phys_matrix phys_strain_limits_matrix;
phys_energy phys_strain_limits_energy;

/* The same matrix as if each edge, where it is now, had just reached its limit: K = k u u' at
 * least. */
phys_matrix phys_strain_limits_stiffest;

#endif
