#ifndef CLOTH_PHYSICS_PRESSURE_H
#define CLOTH_PHYSICS_PRESSURE_H

#include "cloth/physics/element.h"

/* A gas that presses on triangles. With n the unit normal, on the side from which the corners are
 * counter-clockwise, and A the present area, the gas behind a triangle pushes it by
 *
 *     F = p A n
 *
 * a third on each corner. On a closed surface that is p times the derivative of the volume inside,
 * so the forces sum to zero. Pure functions; nothing is allocated. */

/* Numbers of a triangle: p, Pa, of any sign: that behind it less that in front of it. */
enum { PHYS_PRESSURE };

phys_force phys_pressure_force;

#endif
