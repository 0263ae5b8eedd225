/* Vertices that meet shapes, against values worked out by hand. */
#include "cloth/contact/meet.h"
#include "tests/support/unit.h"

#include <math.h>

static void same(const phys_vec *a, double x, double y, double z)
{
    ck_assert_double_eq((*a)[0], x);
    ck_assert_double_eq((*a)[1], y);
    ck_assert_double_eq((*a)[2], z);
    ck_assert_double_eq((*a)[3], 0);
}

/* The plane y = 1, seen from above. */
UNIT_TEST(plane_lifts_and_stops)
{
    enum { UNDER, UNDER_RISING, ABOVE, ON, HELD, N };
    const struct contact_shape plane = {.value = {5, 1, 7, 0, 1, 0}};
    const struct contact_pose still = {0};
    const double loose[N] = {1, 1, 1, 1, 0};
    phys_vec x[N] = {{0, 0.5, 0, 0}, {0, 0.5, 0, 0}, {0, 2, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}};
    phys_vec v[N] = {{3, -4, 5, 0}, {3, 4, 5, 0}, {3, -4, 5, 0}, {3, -4, 5, 0}, {3, -4, 5, 0}};
    ck_assert_uint_eq(contact_project(&plane, &still, N, loose, x, v), 3);
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

UNIT_TEST(plane_on_a_slope)
{
    const struct contact_shape plane = {.value = {0, 0, 0, 0.6, 0.8, 0}};
    const struct contact_pose still = {0};
    const double loose[1] = {1};
    phys_vec x[1] = {{-0.6, -0.8, 2, 0}}, v[1] = {{-0.6 + 0.8, -0.8 - 0.6, 1, 0}};
    ck_assert_uint_eq(contact_project(&plane, &still, 1, loose, x, v), 1);
    for (int c = 0; c < 2; c++)
        ck_assert_double_eq_tol(x[0][c], 0, 1e-15);
    ck_assert_double_eq_tol(v[0][0], 0.8, 1e-15);
    ck_assert_double_eq_tol(v[0][1], -0.6, 1e-15);
    ck_assert_double_eq(v[0][2], 1);
}

/* A vertex that is nowhere is not put anywhere. */
UNIT_TEST(nowhere)
{
    const struct contact_hit hit = {.normal = {0, 1, 0, 0}, .gap = NAN};
    phys_vec x = {1, 2, 3, 0}, v = {4, 5, 6, 0};
    ck_assert(!contact_leave(&hit, &hit.normal, &x, &v));
    same(&x, 1, 2, 3);
    same(&v, 4, 5, 6);
}
