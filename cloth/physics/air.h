#ifndef CLOTH_PHYSICS_AIR_H
#define CLOTH_PHYSICS_AIR_H

#include "cloth/physics/element.h"

/* Drag and wind on triangles. With u the velocity of the wind against the mean of the corners', n
 * the unit normal and A the area of a triangle as it is now, the air pushes it by
 *
 *     F = density / 2  A  (normal |u_n| u_n + tangent |u_t| u_t),   u_n = (u . n) n,  u_t = u - u_n
 *
 * a third of it on each corner, or, where a fourth one is named, a quarter on each: dynamic
 * pressure by area and two coefficients, that of a plate across the stream (1.17 to 1.28 as
 * measured: Hoerner 1965) and that of friction along it. Both sides of a triangle are alike. Pure
 * functions; nothing is allocated. */
struct phys_air {
    double density;         /* kg/m^3; 0: no air */
    double wind[3];         /* m/s */
    double normal, tangent; /* coefficients, >= 0 */
};

/* Adds the forces (N) on the block's own corners to f. corner: of n triangles, and who else takes
 * part in their forces: the fourth corner of a cell, or PHYS_NO_CORNER. A triangle without area has
 * none. */
void phys_air_force(const struct phys_air *air, size_t n, const uint32_t (*corner)[4],
                    const struct phys_sight *sight, phys_vec *f);

#endif
