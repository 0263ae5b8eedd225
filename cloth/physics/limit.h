#ifndef CLOTH_PHYSICS_LIMIT_H
#define CLOTH_PHYSICS_LIMIT_H

/* How long explicit steps may be. A mode of vibration is s'' + a s' + omega^2 s = 0, omega in
 * rad/s, a in 1/s (2 zeta omega). Every function returns the h, s, below which its steps do not let
 * the mode grow. It follows from the trace and determinant of one step, or from the polynomial of
 * Runge and Kutta. Pure functions. */

/* x by the old v: h = a / omega^2 = 2 zeta / omega, less where zeta > 1. Without damping it is 0:
 * each step makes the mode sqrt(1 + h^2 omega^2) times as large. */
double phys_limit_euler(double omega, double a);

/* x by the new v: 2 / omega, less where there is damping. */
double phys_limit_symplectic(double omega, double a);

/* Velocity Verlet as in cloth/physics/particle.h, a without the drag that it solves for: 2 / omega,
 * less where there is such damping. */
double phys_limit_verlet(double omega, double a);

/* The classical Runge-Kutta method: 2.83 / omega, and 2.79 / a where damping rules. */
double phys_limit_rk4(double omega, double a);

/* The largest eigenvalue of a symmetric positive semidefinite matrix xx yy zz xy yz zx, or up to
 * 1 % more. */
double phys_largest(const double m[6]);

#endif
