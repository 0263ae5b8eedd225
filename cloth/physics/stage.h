#ifndef CLOTH_PHYSICS_STAGE_H
#define CLOTH_PHYSICS_STAGE_H

#include "cloth/physics/vec.h"

#include <stddef.h>

/* Explicit steps and parts of them. Arrays have n rows and the units of
 * cloth/physics/particle.h. Each row is computed from itself alone. Pure functions; nothing is
 * allocated. */

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

#endif
