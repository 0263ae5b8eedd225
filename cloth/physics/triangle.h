#ifndef CLOTH_PHYSICS_TRIANGLE_H
#define CLOTH_PHYSICS_TRIANGLE_H

#include "cloth/physics/element.h"

/* Triangles of an orthotropic membrane in plane stress, with corotated linear strain (Etzmuss,
 * Keckeisen, Strasser 2003). The rest shape is in material coordinates u (warp) and v (weft). F =
 * dx / d(u, v) is 3 x 2, and F = R S is its polar decomposition (R with orthonormal columns, S
 * symmetric, not negative). J is the quarter turn and C are the moduli.
 *     energy  W = area / 2 (S - I) : C : (S - I)                                          (J)
 *     stress  T = C : (S - I + damping dS/dt)                                             (N/m)
 *     forces  f_i = -area P g_i,  P = R (T - c J),  c = (T : J S) / tr S                  (N)
 * with g_i the gradient of corner i's shape function. P is the exact gradient of the energy, so
 * that forces have no torque. The papers have P = R T (`uncorrected`): where moduli differ, a
 * torque -c (tr S) area about the normal is left (phys_triangles_torque).
 *
 * S needs square roots alone: F'F = S^2, det S = |F_u x F_v|, tr S = sqrt(tr F'F + 2 det S), S =
 * (F'F + det S) / tr S. A triangle without area has no normal: only forces along its line remain. A
 * triangle that is a point has no forces.
 *
 * K of a step is R k R' with k the stiffness at rest, and those parts of the stress that resist a
 * rotation. They are, times the area, (S^-1 (T - c J))+ against moves along the normal and max(T :
 * S, 0) against rotation in the plane. The parts of compression, and how the strain depends on the
 * rotation, are left out: K is never indefinite. `full` has them all. Pure functions; nothing is
 * allocated.
 *
 * Threads may stiffen. With e the strain S - I along a thread, the energy has beside W
 *     area / 2 sum of more (e - at)^2  over those knees that e is beyond                     (J)
 * so that the stress along the thread is straight between knees, and K has `more` in C there. */

/* Knees of warp (0) and weft (1): the strain of each, ascending, and by how much the modulus is
 * higher beyond it, N/m, below 0 where a thread softens. Those that are not used are all 0. */
enum { PHYS_KNEES = 3 };
struct phys_stiffening {
    double at[2][PHYS_KNEES], more[2][PHYS_KNEES];
};

/* Plane stress: stresses (N/m) of strains. */
struct phys_membrane {
    phys_vec modulus; /* C11 C12 C22 C33, N/m; C33 of the shear angle, 2 e_uv */
    double damping;   /* s, times these moduli */
    int uncorrected;  /* forces as the papers have them */
    int curved;       /* it has knees */
    struct phys_stiffening stiffening;
};

/* Makes a membrane from moduli (N/m) along warp and weft and of shear, and the Poisson ratio nu12,
 * by which a pull along the warp narrows the weft; nu21 = nu12 weft / warp. Returns 0, or -1 unless
 * moduli are finite and not negative and nu12 nu21 < 1. */
int phys_membrane_make(double warp, double weft, double shear, double poisson, double damping,
                       struct phys_membrane *membrane);

/* Makes the knees of a thread (0 or 1), and its modulus at rest (N/m), of the curve through 0 and n
 * points of strain and stress (N/m), straight between them and on from the last; 1 <= n <=
 * PHYS_KNEES + 1. Returns n, or the number of the first point that is not beyond and above the one
 * before. */
size_t phys_stiffening_make(size_t n, const double (*point)[2], int thread,
                            struct phys_stiffening *stiffening, double *modulus);

/* Gives a membrane knees. Returns 0, or -1 where the moduli beyond some of them, with its Poisson
 * ratio, would resist some strain with less than nothing. */
int phys_membrane_stiffen(struct phys_membrane *membrane, const struct phys_stiffening *stiffening);

/* A triangle has three corners, then the number of its membrane, of those that are the list's
 * material. Its vector is g_1u g_1v g_2u g_2v, 1/m, with g_0 = -g_1 - g_2; its number is its area
 * at rest, m^2, > 0. */
enum { PHYS_TRIANGLE_AREA };

/* Finds coordinates along warp and weft of a triangle whose corners lie at x (m; x y z of each).
 * Lengths are the triangle's own. uv (u v of each corner, of any size) gives the directions;
 * without any, warp lies along the first edge. local: u v of each corner, m, from corner 0. */
void phys_triangle_local(const double x[9], const double uv[6], double local[6]);

/* Rest shape of a triangle with corners at `uv` (m; u v of each): its gradient and area. 0, or -1
 * if it has no area. */
int phys_triangle_rest(const double uv[6], double gradient[4], double *area);

/* Pairs of a triangle: (0, 1), (0, 2), (1, 2). The torque is what uncorrected triangles leave. */
phys_force phys_triangles_force;
phys_matrix phys_triangles_matrix;
phys_matrix phys_triangles_stiffest; /* with all of `more` that is above 0, whatever the strain */
phys_system phys_triangles_system;
phys_energy phys_triangles_energy;
phys_torque phys_triangles_torque;

/* Finds the largest principal strain of each of the n triangles, the larger eigenvalue of S - I.
 * stress, unless NULL: the elastic stress C : (S - I) along warp, along weft, and of shear (N/m).
 */
void phys_triangles_strain(const struct phys_elements *triangles, const struct phys_sight *sight,
                           double *largest, double (*stress)[3]);

#endif
