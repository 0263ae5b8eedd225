/* Stages of explicit steps, against values worked out by hand. */
#include "cloth/physics/stage.h"
#include "tests/support/unit.h"

#include <math.h>

static void same(const phys_vec *a, double x, double y, double z)
{
    ck_assert_double_eq((*a)[0], x);
    ck_assert_double_eq((*a)[1], y);
    ck_assert_double_eq((*a)[2], z);
    ck_assert_double_eq((*a)[3], 0);
}

/* By the old v, and by the new one; what is held stays. */
UNIT_TEST(euler)
{
    const phys_vec f[2] = {{6, -3, 0, 0}, {1, 1, 1, 0}};
    const double mass[2] = {2, 4}, loose[2] = {1, 0};
    for (int ahead = 0; ahead < 2; ahead++) {
        phys_vec x[2] = {{1, 2, 3, 0}, {4, 5, 6, 0}}, v[2] = {{4, 2, -6, 0}, {0, 0, 0, 0}};
        ck_assert_int_eq(phys_euler(2, 0.5, ahead, 6.5, mass, loose, f, x, v, x, v), 1);
        same(v, 5.5, 1.25, -6);
        same(x, ahead ? 3.75 : 3, ahead ? 2.625 : 3, 0);
        same(x + 1, 4, 5, 6);
        same(v + 1, 0, 0, 0);
        ck_assert_int_eq(phys_euler(2, 0, ahead, 6, mass, loose, f, x, v, x, v),
                         0); /* z of x[1], v[0] */
        x[1][2] = NAN;
        v[0][2] = 0;
        ck_assert_int_eq(phys_euler(2, 0, ahead, 6.5, mass, loose, f, x, v, x, v), 0);
        x[1][2] = 0;
        ck_assert_int_eq(phys_euler(2, 0, ahead, 6, mass, loose, f, x, v, x, v), 1);
    }
}

UNIT_TEST(kicks)
{
    const phys_vec f[2] = {{6, -3, 0, 0}, {1, 1, 1, 0}}, v[2] = {{4, 2, -6, 0}, {0, 0, 0, 0}};
    const double mass[2] = {2, 4}, drag[2] = {0.5, 0.25}, loose[2] = {1, 0};
    phys_vec w[2];
    phys_kick(2, 0.5, 0, mass, drag, loose, f, v, w); /* 0.25 (f - 0.5 v) */
    same(w, 5, 1, -5.25);
    same(w + 1, 0, 0, 0);
    phys_kick(2, 4, 1, mass, drag, loose, f, v, w); /* 1 (f - 0.5 v) */
    same(w, 8, -2, -3);
    same(w + 1, 0, 0, 0);
}

/* The half steps in turn: implicit, then explicit, is v (1 - a) / (1 + a), a = t drag / mass. */
UNIT_TEST(kicks_together)
{
    const phys_vec f[1] = {{0, 0, 0, 0}};
    const double mass[1] = {1}, drag[1] = {3}, loose[1] = {1};
    phys_vec v[1] = {{4, -8, 2, 0}};
    phys_kick(1, 1, 1, mass, drag, loose, f, v, v);
    phys_kick(1, 1, 0, mass, drag, loose, f, v, v);
    same(v, -2, 4, -1);
}

/* A step of 1 s of x' = v, v' = -x: x and v by the fourth-order series of cosine and sine. */
UNIT_TEST(runge_step)
{
    phys_vec x[2] = {{24, 0, 48, 0}, {1, 2, 3, 0}}, v[2] = {{0, 24, 0, 0}, {0, 0, 0, 0}};
    phys_vec x0[2], v0[2], sum_x[2], sum_v[2], a[2] = {{0}, {0}};
    const struct phys_runge runge = {x0, v0, sum_x, sum_v};
    for (int stage = 0; stage < PHYS_RUNGE_STAGES; stage++) {
        a[0] = -x[0]; /* the second row is held */
        phys_runge_stage(2, 1, stage, a, &runge, x, v);
    }
    same(x, 13, 20, 26); /* 24 (1 - 1/2 + 1/24), 24 (1 - 1/6) */
    same(v, -20, 13, -40);
    same(x + 1, 1, 2, 3);
    same(v + 1, 0, 0, 0);
}
