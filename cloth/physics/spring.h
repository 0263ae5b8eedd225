#ifndef CLOTH_PHYSICS_SPRING_H
#define CLOTH_PHYSICS_SPRING_H

#include "cloth/physics/vec.h"

#include <stddef.h>
#include <stdint.h>

/* Damped springs between particles. With l = |xb - xa| and u = (xb - xa) / l, a spring pulls a by
 *     f = k (l - L) u + c (u . (vb - va)) u        and b by -f                      (N)
 * and its stiffness towards a difference of positions is
 *     K = k (u u' + t (I - u u')),  t = max(0, 1 - L / l)                           (N/m)
 * This drops the negative transverse term of a compressed spring, so that K is never indefinite.
 * PHYS_FULL keeps it, t = 1 - L / l: K is then the exact slope of the force. PHYS_ABSOLUTE changes
 * its sign, t = min(1, |1 - L / l|) (the eigenvalues' absolute values, after Chen et al. 2024). So
 * a step moves compressed springs aside no further than the slope of their force holds. Two
 * particles at one place have no direction: there u = 0 and t = 0, with PHYS_ABSOLUTE t = 1. With
 * an L just below 0 (for 0) t = 1 there, too, but not with PHYS_FULL.
 *
 * x_other, v_other NULL: both ends are in x and v, and both rows are written. Else end 1 is in
 * those arrays, of another block, and the rows of end 0 alone are written; the other block does the
 * same for its end. Both compute the same bits with opposite signs, so momentum is kept to roundoff
 * of the sums. Springs are worked on in order. Pure functions; nothing is allocated. */
enum phys_slope { PHYS_DEFINITE, PHYS_FULL, PHYS_ABSOLUTE };
struct phys_springs {
    size_t n;
    const uint32_t (*end)[2]; /* n: rows of the two ends */
    const double *stiffness;  /* n: k, N/m */
    const double *damping;    /* n: c, kg/s */
    const double *length;     /* n: L, m, > 0; or below 0 and tiny, as good as 0 */
    int full;                 /* which K: an enum phys_slope */
};

/* Adds the forces (N) to f. x: m, v: m/s. */
void phys_springs_force(const struct phys_springs *springs, const phys_vec *x, const phys_vec *v,
                        const phys_vec *x_other, const phys_vec *v_other, phys_vec *f);

/* Makes the springs' part of the matrix of an implicit step of h seconds, h c u u' + h^2 K = alpha
 * I + w w'. Each spring has four doubles w0 w1 w2 alpha (value: n; kg). Its end 1 is a row of
 * x_other, which is x where both ends are here. */
void phys_springs_matrix(const struct phys_springs *springs, double h, const phys_vec *x,
                         const phys_vec *x_other, phys_vec *value);

/* The same, and the right side of that step: b += push f - h^2 K v, with push h (s), or 0 where the
 * forces are in b. */
void phys_springs_system(const struct phys_springs *springs, double h, double push,
                         const phys_vec *x, const phys_vec *v, const phys_vec *x_other,
                         const phys_vec *v_other, phys_vec *b, phys_vec *value);

/* Widens range[0] .. range[1] to the l / L of those springs whose `chosen` byte (n) is not zero. */
void phys_springs_range(const struct phys_springs *springs, const unsigned char *chosen,
                        const phys_vec *x, const phys_vec *x_other, double range[2]);

/* Sum of k (l - L)^2 / 2, J, in the order of the springs. End 1 is looked up in x_other, which is x
 * where both ends are here. */
double phys_energy_springs(const struct phys_springs *springs, const phys_vec *x,
                           const phys_vec *x_other);

#endif
