#ifndef CLOTH_PHYSICS_PARTICLE_H
#define CLOTH_PHYSICS_PARTICLE_H

#include "cloth/physics/vec.h"

#include <stddef.h>

/* Particles one by one: forces from outside, energies, explicit and implicit steps of time. Arrays
 * have n rows; `free` is 1 for a particle that moves and 0 for one that is held. Each row is
 * computed from itself alone; sums go in the order of the rows. Pure functions; nothing is
 * allocated. */

/* f = load - drag v. load: N, gravity included; drag: kg/s; v: m/s. */
void phys_outside(size_t n, const phys_vec *load, const double *drag, const phys_vec *v,
                  phys_vec *f);

/* f (N) -> free f / mass (m/s^2). mass: kg, > 0. */
void phys_accelerate(size_t n, const double *mass, const double *free, phys_vec *f);

/* y += scale d: v += h a, v += dv, x += h v. */
void phys_advance(size_t n, double scale, const phys_vec *d, phys_vec *y);

/* The first row of which a component is not finite or not below `bound` in size; n if all are well.
 */
size_t phys_diverged(size_t n, double bound, const phys_vec *y);

/* ---- Energies ---- */

/* Sum of m v.v / 2 (J), rows in order; widens *most to the largest v.v (m^2/s^2). mass: kg. */
double phys_kinetic(size_t n, const double *mass, const phys_vec *v, double *max);

/* Minus the sum of m gravity.x, J: of weights in a field of gravity (m/s^2), zero at the origin. */
double phys_energy_weight(size_t n, const double *mass, const double gravity[3], const phys_vec *x);

/* Minus the sum of (load - m gravity).x, J: of constant forces besides the weight, zero at the
 * origin. load: N, the weight included. */
double phys_energy_load(size_t n, const double *mass, const double gravity[3], const phys_vec *load,
                        const phys_vec *x);

/* ---- Explicit steps, and parts of them ---- */

/* A step of h seconds by explicit Euler, x += h v, v += h a with a = free f / mass; ahead: by
 * symplectic Euler, where x moves by the new v. f: N. The results go to x_next and v_next, which
 * may be x and v. 0 if a row diverged (phys_diverged). */
int phys_euler(size_t n, double h, int ahead, double bound, const double *mass, const double *free,
               const phys_vec *f, const phys_vec *x, const phys_vec *v, phys_vec *x_next,
               phys_vec *v_next);

/* A half step of velocity Verlet of t seconds:
 *
 *     w = v + t free (f - drag v) / (mass + ahead t drag)
 *
 * f: N, without the drag. Drag is linear in its own vertex's velocity, so it can be solved for
 * there: ahead = 1 is implicit in it (v the velocity before), ahead = 0 explicit. The two halves of
 * a step, one of each kind, are second order together and damp at any t drag / mass. w may be v. */
void phys_kick(size_t n, double t, double ahead, const double *mass, const double *drag,
               const double *free, const phys_vec *f, const phys_vec *v, phys_vec *w);

/* The state of a step of the classical Runge-Kutta method (Kutta 1901), n rows each: x0, v0 where
 * it began; sum_x, sum_v the weighted slopes so far. */
struct phys_runge {
    phys_vec *x0, *v0, *sum_x, *sum_v;
};

/* A stage: its time in the step, and how far its slopes take the state to the next stage, in h;
 * their weight, of six in all. After the last stage the sum takes the state to the end of the step.
 */
enum { PHYS_RUNGE_STAGES = 4 };
struct phys_runge_row {
    double at, weight, ahead;
};
extern const struct phys_runge_row phys_runge_rows[PHYS_RUNGE_STAGES];

/* Ends a stage, from 0, of a step of h seconds. The slopes of the stage are v and the
 * acceleration a at x, v. Keeps the slopes and moves x, v to the next stage, after the last to the
 * end of the step. Stage 0 needs nothing of *runge. */
void phys_runge_stage(size_t n, double h, int stage, const phys_vec *a,
                      const struct phys_runge *runge, phys_vec *x, phys_vec *v);

/* ---- Implicit steps ---- */

/* A step seeks v with
 *
 *     M (v - base_v) = t f(base_x + t v, v)
 *
 * by implicit Euler t = h and the bases are x and v before the step; by BDF2 (Gear 1971) t = 2 h /
 * 3 and they are the ones below. */

/* The bases of BDF2 from x, v now and x, v a step before, base = (4 now - before) / 3, then the
 * state before becomes that of now. A row that is held has a base_x that takes it on by 3 t / 2 =
 * h, as its v says. */
struct phys_states {
    const phys_vec *x, *v;
    phys_vec *last_x, *last_v, *base_x, *base_v;
};
void phys_bdf2_bases(size_t n, double t, const double *free, const struct phys_states *states);

/* x = base_x + t v. */
void phys_place(size_t n, double t, const phys_vec *base_x, const phys_vec *v, phys_vec *x);

/* f (N) -> t f - M (v - base_v) (kg m/s): nothing where v solves the step. mass: kg. */
void phys_residual(size_t n, double t, const double *mass, const phys_vec *base_v,
                   const phys_vec *v, phys_vec *f);

/* Sum over the free rows of a.b. */
double phys_slope(size_t n, const double *free, const phys_vec *a, const phys_vec *b);

/* Sum of mass (a - b).(a - b); b NULL: of a alone. */
double phys_distance(size_t n, const double *mass, const phys_vec *a, const phys_vec *b);

#endif
