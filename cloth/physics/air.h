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
    struct phys_turbulence {
        double
            intensity; /* root mean square of each component of the gusts, over |wind|; 0: none */
        double length; /* m, > 0: L */
        uint32_t seed;
        double way[3]; /* m, that the gusts have gone so far */
    } turbulence;
};

/* Gusts are a frozen field that the wind carries along (Taylor 1938): a sum of waves across their
 * directions, so that it has no divergence, each of one amplitude, with random directions and
 * phases (Kraichnan 1970). Wave numbers k have the density of Dryden's spectrum, k^4 / (1 + k^2
 * L^2)^3. So the mean over seeds of u_i(x) u_i(x + r) / sigma^2 is exp(-r / L) along r, and (1 - r
 * / 2 L) exp(-r / L) across it. All follows from the seed by + - * / and sqrt. */
enum { PHYS_WAVES = 32 };
struct phys_gusts {
    phys_vec wave[PHYS_WAVES];   /* turns / m; its last lane: the phase, turns */
    phys_vec across[PHYS_WAVES]; /* m/s: the amplitude */
};
/* sigma: m/s, of each component. At a place, m, of the field: `to`, m/s. */
void phys_gusts_make(const struct phys_turbulence *turbulence, double sigma,
                     struct phys_gusts *gusts);
void phys_gusts_at(const struct phys_gusts *gusts, const phys_vec *place, phys_vec *to);

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
