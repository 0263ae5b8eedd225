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

START_TEST(outside_and_acceleration)
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
END_TEST

START_TEST(advance)
{
    const phys_vec d[1] = {{1, 2, 3, 0}};
    phys_vec y[1] = {{10, 20, 30, 0}};
    phys_advance(1, 0.5, d, y);
    same(y, 10.5, 21, 31.5);
}
END_TEST

/* The plane y = 1, seen from above. */
START_TEST(plane_lifts_and_stops)
{
    enum { UNDER, UNDER_RISING, ABOVE, ON, HELD, N };
    const double point[3] = {5, 1, 7}, normal[3] = {0, 1, 0}, loose[N] = {1, 1, 1, 1, 0};
    phys_vec x[N] = {{0, 0.5, 0, 0}, {0, 0.5, 0, 0}, {0, 2, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}};
    phys_vec v[N] = {{3, -4, 5, 0}, {3, 4, 5, 0}, {3, -4, 5, 0}, {3, -4, 5, 0}, {3, -4, 5, 0}};
    phys_plane(N, point, normal, loose, x, v);
    same(x + UNDER, 0, 1, 0);
    same(v + UNDER, 3, 0, 5);
    same(x + UNDER_RISING, 0, 1, 0);
    same(v + UNDER_RISING, 3, 4, 5);
    same(x + ABOVE, 0, 2, 0);
    same(v + ABOVE, 3, -4, 5);
    same(x + ON, 0, 1, 0);
    same(v + ON, 3, 0, 5);
    same(x + HELD, 0, 0, 0);
    same(v + HELD, 3, -4, 5);
}
END_TEST

START_TEST(plane_on_a_slope)
{
    const double point[3] = {0, 0, 0}, normal[3] = {0.6, 0.8, 0}, loose[1] = {1};
    phys_vec x[1] = {{-0.6, -0.8, 2, 0}}, v[1] = {{-0.6 + 0.8, -0.8 - 0.6, 1, 0}};
    phys_plane(1, point, normal, loose, x, v);
    for (int c = 0; c < 2; c++)
        ck_assert_double_eq_tol(x[0][c], 0, 1e-15);
    ck_assert_double_eq_tol(v[0][0], 0.8, 1e-15);
    ck_assert_double_eq_tol(v[0][1], -0.6, 1e-15);
    ck_assert_double_eq(v[0][2], 1);
}
END_TEST

START_TEST(diverged_finds_the_first_row)
{
    phys_vec y[4] = {{1, 2, 3, 0}, {-9, 9, 9, 0}, {1, 1, 1, 0}, {NAN, 0, 0, 0}};
    ck_assert_uint_eq(phys_diverged(4, 10, y), 3);
    ck_assert_uint_eq(phys_diverged(3, 10, y), 3);
    ck_assert_uint_eq(phys_diverged(4, 9, y), 1);
    y[2][2] = -INFINITY;
    ck_assert_uint_eq(phys_diverged(4, 10, y), 2);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("particle");
    TCase *cases = tcase_create("particle");
    tcase_add_test(cases, outside_and_acceleration);
    tcase_add_test(cases, advance);
    tcase_add_test(cases, plane_lifts_and_stops);
    tcase_add_test(cases, plane_on_a_slope);
    tcase_add_test(cases, diverged_finds_the_first_row);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
