#ifndef CLOTH_CONTACT_CERTIFICATE_H
#define CLOTH_CONTACT_CERTIFICATE_H

#include "cloth/contact/pair.h"

#include <stdbool.h>

/* The proof that two features never touch in a step, in which each corner moves straight and evenly
 * from x to y (m).
 *
 * For a fixed direction n of length 1 let f(s) be the least n.x of the first feature less the
 * largest n.x of the second, at the part s of the step. It is concave, so f(0) > 0 and f(1) > 0
 * prove that some plane across n lies between them at every s. Which n is tried does not matter for
 * the proof: it is the closest direction at the start, else that at the end.
 *
 * Rounding: f(0) is made of differences against corner 0 at the start, f(1) of those at the end. So
 * motion that all corners share, and distance from the origin, cancel before anything is
 * multiplied. With S the sum of the absolute components of the three differences, and u = 2^-53, a
 * difference is off by u of itself and a product with n by 3 u more: f is off by less than 5 u S.
 * The test takes off 8 u S, for coordinates and ways of any size. */

/* m: a step does not bring features nearer than this. */
#define CONTACT_MARGIN 1e-9

/* Whether the pair provably never touches, and f(1) is enough for the steps that follow: at least
 * CONTACT_MARGIN and min(f(0) / 2, thickness / 10), or no less than f(0). f(0) itself, where the
 * features are, need be but half the margin. thickness: m, >= 0. What is not finite proves nothing.
 */
bool contact_certify(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                     double thickness);

/* The same; and whether the features are surely farther apart than reach (m, 0 or more) at all
 * times of the step, which this says at no more cost of most pairs that are. */
enum contact_passing { CONTACT_PASSES_BY, CONTACT_PASSES, CONTACT_MAY_TOUCH };
enum contact_passing contact_pass(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                                  double thickness, double reach);

/* For a pair that contact_certify does not pass: lowers t[4] so that it passes with the ends
 *
 *     x + t (y - x)       by corner, rounded as it may be; exactly x where t is 0.
 *
 * A plane divides the features, and each corner stops at 0.9 of its way to it. The plane stands
 * still, or held corners push it. Then the pair passes with every smaller t of any corner, too: the
 * least t of several pairs does for all of them. Where all corners go the same way across the
 * plane, by more than twice the thickness, it moves with the slowest, and only those behind are
 * cut: features that fly together lose no more than what they come nearer. If another pair then
 * cuts those in front, this one is to be looked at again.
 *
 * t: parts of the way, 0 to 1, as other pairs with the same y have left it. held: bit k: corner k
 * goes to y whatever happens (an obstacle's, a driven pin's); its t stays as it is. Returns false,
 * with t as it was, if that is not possible: not even where all other corners stay, or x itself is
 * not certain. */
bool contact_cut(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4], double thickness,
                 unsigned held, double t[4]);

#endif
