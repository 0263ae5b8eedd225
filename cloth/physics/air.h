#ifndef CLOTH_PHYSICS_AIR_H
#define CLOTH_PHYSICS_AIR_H

#include "cloth/physics/element.h"

/* Drag and wind on triangles. Let u be the velocity of the wind minus the mean of the corners', n
 * the unit normal and A the present area of a triangle. The air pushes the triangle by
 *
 *     F = density / 2  A  (normal |u_n| u_n + tangent |u_t| u_t),   u_n = (u . n) n,  u_t = u - u_n
 *
 * A third of it acts on each corner, or, where a fourth corner is named, a quarter on each. This is
 * dynamic pressure times area, with two coefficients: of a plate across the stream (measured: 1.17
 * to 1.28, Hoerner 1965) and of friction along it. Both sides of a triangle are alike. Pure
 * functions; nothing is allocated. */
struct phys_air {
    double density;         /* kg/m^3; 0: no air */
    double wind[3];         /* m/s */
    double normal, tangent; /* coefficients, >= 0 */
};

/* A face has the corners of a triangle, and the fourth corner of its cell, which shares the force,
 * or PHYS_NO_CORNER. There is no force on a triangle without area. */
phys_force phys_air_force;

/* A gas that presses on triangles. With n the unit normal, on the side from which the corners are
 * counter-clockwise, and A the present area, the gas behind a triangle pushes it by
 *
 *     F = p A n
 *
 * a third on each corner. On a closed surface that is p times the derivative of the volume inside,
 * so the forces sum to zero. */

/* Numbers of a triangle: p, Pa, of any sign: that behind it less that in front of it. */
enum { PHYS_PRESSURE };

phys_force phys_pressure_force;

#endif
