#ifndef CLOTH_CONTACT_CERTIFICATE_H
#define CLOTH_CONTACT_CERTIFICATE_H

#include "cloth/contact/pair.h"

#include <stdbool.h>

/* The proof that two features never touch in a step, in which each corner moves straight and evenly
 * from x to y (m).
 *
 * For a fixed unit direction n, let f(s) be the least n.x of the first feature less the largest n.x
 * of the second, at the part s of the step. f is concave, so f(0) > 0 and f(1) > 0 prove that some
 * plane across n lies between them at every s. Any n proves it; the closest direction at the start
 * is tried, then that at the end.
 *
 * Features that touch have their four corners in a plane. The volume a.(b x c) of three differences
 * of corners is a cubic in s. If its four coefficients in Bernstein's basis have one sign, it is
 * never 0 (Tang, Manocha, Tong 2010, Fast Continuous Collision Detection using Deforming
 * Non-Penetration Filters). So near features may turn together, which no plane across one n
 * divides.
 *
 * Rounding: f(0) is made of differences against corner 0 at the start, f(1) of those at the end. So
 * motion that all corners share, and distance from the origin, cancel before anything is
 * multiplied. Let S be the sum of the absolute components of the three differences at both ends,
 * and u = 2^-53. A difference is off by u of itself and a product with n by 3 u more, so f is off
 * by less than 5 u S. The test takes off 8 u S, for coordinates and ways of any size. Three times a
 * coefficient is off by less than 11 u of its terms, which sum to S^3 / 9 at most. The test takes
 * off 2 u S^3. */

/* m: a step does not bring features nearer than this. Floats of up to 2 m change a distance by less
 * (sqrt(3) 2^-23 m), so frames do not intersect where steps do not. A larger one would end runs in
 * which pins lead cloth together: gaps may halve in each step down to it. */
#define CONTACT_MARGIN 0x1p-22

/* True if the pair provably never touches, and f(1) is enough for the next steps: at least
 * CONTACT_MARGIN and min(f(0) / 2, thickness / 10), or no less than f(0). Half the margin is enough
 * for the f(0) of a plane. thickness: m, >= 0. False for values that are not finite. */
bool contact_certify(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                     double thickness);

/* The f at both ends, m, that is enough whatever f(0) was, but for rounding. */
PHYS_INLINE double contact_enough(double thickness)
{
    return 0.1 * thickness > CONTACT_MARGIN ? 0.1 * thickness : CONTACT_MARGIN;
}

/* The same; CONTACT_PASSES_BY: the features are farther apart than reach (m, >= 0) at all times of
 * the step. Most such pairs are found at no extra cost. */
enum contact_passing { CONTACT_PASSES_BY, CONTACT_PASSES, CONTACT_MAY_TOUCH };
enum contact_passing contact_pass(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                                  double thickness, double reach);

/* The same of n pairs, each to the bits that it has alone. Most pairs are certified four at once.
 */
struct contact_moving {
    enum contact_pair pair;
    phys_vec x[4], y[4];
};
void contact_pass_all(size_t n, const struct contact_moving *moving, double thickness, double reach,
                      enum contact_passing *passing);

/* For a pair that contact_certify does not pass: lowers t[4] so that it passes with the ends
 *
 *     x + t (y - x)       by corner, rounded as it may be; exactly x where t is 0.
 *
 * A plane divides the features, and each corner stops at 0.9 of its way to it. The plane stands
 * still, or held corners push it. Then the pair passes with every smaller t of any corner, too, so
 * the least t of several pairs serves all of them. If all corners go the same way across the plane,
 * by more than twice the thickness, the plane moves with the slowest. Then only those behind are
 * cut: features that fly together lose only their approach. If another pair then cuts those in
 * front, this pair must be checked again.
 *
 * t: parts of the way, 0 to 1, as other pairs with the same y have left it. held: bit k: corner k
 * goes to y in any case (an obstacle's, a driven pin's), and its t does not change. Returns false,
 * with t unchanged, if no t passes: even with all other corners at rest, or since x itself is not
 * certain. */
bool contact_cut(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4], double thickness,
                 unsigned held, double t[4]);

#endif
