#ifndef CLOTH_PHYSICS_IMPLICIT_H
#define CLOTH_PHYSICS_IMPLICIT_H

#include "cloth/physics/vec.h"

#include <stddef.h>

/* Rows of implicit steps. A step seeks v with
 *
 *     M (v - base_v) = t f(base_x + t v, v)
 *
 * by implicit Euler t = h and the bases are x and v before the step; by BDF2 (Gear 1971) t = 2 h /
 * 3 and they are the ones below. Arrays have n rows and the units of cloth/physics/particle.h. Each
 * row is computed from itself alone. Pure functions; nothing is allocated. */

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
