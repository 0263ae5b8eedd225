/* Particles one by one, against values worked out by hand. */
#include "cloth/physics/particle.h"
#include "tests/support/unit.h"

#include <math.h>

static void same(const phys_vec *a, double x, double y, double z)
{
    ck_assert_double_eq((*a)[0], x);
    ck_assert_double_eq((*a)[1], y);
    ck_assert_double_eq((*a)[2], z);
    ck_assert_double_eq((*a)[3], 0);
}

UNIT_TEST(outside_and_acceleration)
{
    const phys_vec load[2] = {{0, -8, 0, 0}, {1, 0, 0, 0}}, v[2] = {{4, 2, -6, 0}, {1, 1, 1, 0}};
    const double drag[2] = {0.5, 0.25}, mass[2] = {2, 4}, loose[2] = {1, 0};
    phys_vec f[2];
    phys_outside(2, load, drag, v, f);
    same(f, -2, -9, 3);
    same(f + 1, 0.75, -0.25, -0.25);
    phys_accelerate(2, mass, loose, f);
    same(f, -1, -4.5, 1.5);
    same(f + 1, 0, 0, 0);
}

UNIT_TEST(advance)
{
    const phys_vec d[1] = {{1, 2, 3, 0}};
    phys_vec y[1] = {{10, 20, 30, 0}};
    phys_advance(1, 0.5, d, y);
    same(y, 10.5, 21, 31.5);
}

UNIT_TEST(diverged_finds_the_first_row)
{
    phys_vec y[4] = {{1, 2, 3, 0}, {-9, 9, 9, 0}, {1, 1, 1, 0}, {NAN, 0, 0, 0}};
    ck_assert_uint_eq(phys_diverged(4, 10, y), 3);
    ck_assert_uint_eq(phys_diverged(3, 10, y), 3);
    ck_assert_uint_eq(phys_diverged(4, 9, y), 1);
    y[2][2] = -INFINITY;
    ck_assert_uint_eq(phys_diverged(4, 10, y), 2);
}
