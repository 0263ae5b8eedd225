#ifndef CLOTH_PHYSICS_CURVE_H
#define CLOTH_PHYSICS_CURVE_H

#include <stddef.h>

/* How something varies in time: factors without unit; and sine and cosine. Pure functions of + - *
 * / alone, so that they have the same bits everywhere; nothing is allocated. */
struct phys_curve_key {
    double time, factor; /* s, ascending; 1 */
};

/* The last of n > 0 ascending times, `stride` numbers from each other, that is not after a time;
 * else the first. */
size_t phys_key_before(size_t n, const double *times, size_t stride, double time);

/* The value by n > 0 key frames: linear between two, constant before the first and after the last.
 */
double phys_curve_at(size_t n, const struct phys_curve_key *curve_key, double time);

/* sin(2 pi turns), to 2e-16. turns: less than 2^51. */
double phys_sine(double turns);

/* cos and sin of an angle in degrees, to 1e-15; exact for multiples of 90. */
void phys_turn(double degrees, double *cosine, double *sine);

#endif
