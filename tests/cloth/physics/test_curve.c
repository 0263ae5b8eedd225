/* Factors of time: sines against the C library's, key frames between and beyond their times. */
#include "cloth/physics/curve.h"
#include "tests/support/unit.h"

#include <math.h>

UNIT_TEST(sines)
{
    const double two_pi = 6.283185307179586;
    double max = 0;
    for (int i = -4000; i <= 4000; i++) {
        const double turns = i / 1000.0;
        max = fmax(max, fabs(phys_sine(turns) - sin(two_pi * turns)));
    }
    ck_assert_double_le(max, 5e-15); /* of which 4 turns rounded are the most */
    ck_assert_double_eq_tol(phys_sine(0.25), 1, 3e-16);
    ck_assert_double_eq_tol(phys_sine(-1.25), -1, 3e-16);
    ck_assert_double_eq(phys_sine(1e9), 0);
    ck_assert_double_eq_tol(phys_sine(1e6 + 1.0 / 12), 0.5, 1e-9);
}

UNIT_TEST(angles)
{
    static const double quarter[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    double c, s;
    for (int k = -9; k < 9; k++) {
        phys_turn(90.0 * k, &c, &s);
        ck_assert(c == quarter[(k + 12) % 4][0] && s == quarter[(k + 12) % 4][1]);
    }
    for (double degrees = -400; degrees < 400; degrees += 7.3) {
        phys_turn(degrees, &c, &s);
        ck_assert(fabs(c - cos(degrees * M_PI / 180)) < 2e-15 &&
                  fabs(s - sin(degrees * M_PI / 180)) < 2e-15);
    }
}

UNIT_TEST(key_frames)
{
    const struct phys_curve_key curve_key[] = {{1, 2}, {2, 4}, {4, -4}};
    ck_assert_double_eq(phys_curve_at(3, curve_key, -5), 2);
    ck_assert_double_eq(phys_curve_at(3, curve_key, 1), 2);
    ck_assert_double_eq(phys_curve_at(3, curve_key, 1.25), 2.5);
    ck_assert_double_eq(phys_curve_at(3, curve_key, 2), 4);
    ck_assert_double_eq(phys_curve_at(3, curve_key, 3), 0);
    ck_assert_double_eq(phys_curve_at(3, curve_key, 4), -4);
    ck_assert_double_eq(phys_curve_at(3, curve_key, 100), -4);
    ck_assert_double_eq(phys_curve_at(1, curve_key, 100), 2);
}
