#ifndef CLOTH_PHYSICS_BENDING_H
#define CLOTH_PHYSICS_BENDING_H

#include "cloth/physics/element.h"

/* Bending about the inner edges of a mesh. Corners 0 and 1 of an element are the ends of the edge,
 * 2 and 3 the vertices opposite in its two triangles, (0, 1, 2) and (1, 0, 3). theta is the angle
 * between their normals, |theta| < pi, above 0 where the edge is a ridge on their side. The
 * energies are:
 *     hinge      W = k / 2 (s - s0)^2,  s = 2 sin(theta / 2),  s0 that of the rest shape     (J)
 *     quadratic  W = 1 / 2 |sum of w_i x_i|^2,  for a rest shape that is flat                (J)
 * (Grinspun, Hirani, Desbrun, Schroeder 2003; Bergou, Wardetzky, Harmon, Zorin, Grinspun 2006.) s
 * comes by square roots: |n1 - n2| with the sign of (n1 x n2) . e. The stiffness of an edge of
 * length L between triangles of areas A1 and A2 is
 *     k = D L^2 / (A1 + A2)                                                                   (N m)
 * with D the rigidity (N m) of the threads that cross the edge. So a regular mesh that is bent to a
 * cylinder has D / 2 times curvature squared for each area. This holds along the edges of a
 * right-angled grid and in any direction of equilateral triangles; docs/physics.md says how far
 * others miss it.
 *
 * Forces have neither sum nor torque. K of a hinge is k (ds/dx)(ds/dx)'. It leaves out the second
 * derivative of s, which vanishes at rest and is in `full`. K of the quadratic energy is constant
 * and whole. The quadratic energy has no damping of its own, which would brake rotations of a bent
 * cloth: a hinge without stiffness has the damping. A hinge whose triangle lost its area acts
 * through the other alone. Pure functions; nothing is allocated. */

/* Numbers of a hinge: k, N m; the damping of ds/dt, N m s; s0. The vector of a quadratic energy is
 * w_0 .. w_3, sqrt(N/m), which sum to nothing. */
enum { PHYS_HINGE_STIFFNESS, PHYS_HINGE_DAMPING, PHYS_HINGE_REST };

/* The rest shape of an element whose corners lie at x (m; x y z of each), flat or not. */
struct phys_bend_rest {
    double shape;     /* L^2 / (A1 + A2) */
    double s;         /* of the hinge */
    double weight[4]; /* of the positions, 1/m: theta of small moves along the normal */
};

/* 0, or -1 if a triangle has no area or numbers are not finite. */
int phys_bend_rest(const double x[12], struct phys_bend_rest *rest);

/* Rigidity (N m) across an edge of that direction (along warp, along weft; any length). An edge
 * along the weft has that of the warp; others are between by the square of the cosine. */
double phys_bend_rigidity(double warp, double weft, const double direction[2]);

/* As of triangles (triangle.h); pairs of each element: (0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2,
 * 3). */
enum { PHYS_BEND_PAIRS = 6 };
phys_force phys_hinges_force, phys_quadratic_force;
phys_stiffness phys_hinges_stiffness, phys_quadratic_stiffness;
phys_matrix phys_hinges_matrix, phys_quadratic_matrix;
phys_energy phys_hinges_energy, phys_quadratic_energy;

#endif
