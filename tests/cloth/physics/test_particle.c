/* Particles one by one, their energies and stages of explicit steps, against values worked out by
 * hand. */
#include "cloth/physics/particle.h"
#include "cloth/physics/spring.h"
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

/* ---- Energies ---- */

static const phys_vec X[3] = {{1, 2, 3, 0}, {4, 6, 3, 0}, {0, 0, 0, 0}};
static const double MASS[3] = {2, 3, 4}, GRAVITY[3] = {0, -10, 1};

UNIT_TEST(energies_of_particles)
{
    const phys_vec load[3] = {{5, -20, 2, 0}, {0, -30, 3, 0}, {0, -40, 4, 0}};
    ck_assert_double_eq(phys_energy_weight(3, MASS, GRAVITY, X), 40 - 6 + 180 - 9);
    ck_assert_double_eq(phys_energy_load(3, MASS, GRAVITY, load, X), -5);
}

UNIT_TEST(energies_of_springs)
{
    const uint32_t end[2][2] = {{0, 1}, {2, 0}};
    const double stiffness[2] = {10, 1}, damping[2] = {0}, length[2] = {3, 0.5};
    const struct phys_springs both = {2, end, stiffness, damping, length, 0},
                              one = {1, end, stiffness, damping, length, 0};
    const double second = 0.5 * (14 - sqrt(14.0) + 0.25);
    ck_assert_double_eq_tol(phys_energy_springs(&both, X, X), 0.5 * 10 * 4 + second, 1e-14);
    const phys_vec other[2] = {{0}, {1, 2, 4.5, 0}};
    ck_assert_double_eq(phys_energy_springs(&one, X, other), 0.5 * 10 * 2.25);
}

/* ---- Stages ---- */

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
