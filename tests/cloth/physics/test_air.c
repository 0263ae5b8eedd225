/* Gusts: means over seeds and places against Dryden's correlations; the force of air that is still.
 */
#include "cloth/physics/air.h"
#include "cloth/physics/curve.h"
#include "tests/support/unit.h"

#include <math.h>

enum { SEEDS = 20000 };
static const double SIGMA = 2, LENGTH = 0.5; /* m/s, m */

/* Means over seeds of u_i(x) u_i(x + r) / sigma^2 for r along each axis, by the axis of r less that
 * of u. */
static void correlate(double distance, double mean[3])
{
    mean[0] = mean[1] = mean[2] = 0;
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        const struct phys_turbulence turbulence = {.length = LENGTH, .seed = seed};
        const phys_vec place = {0.3, -2, 1.7};
        struct phys_gusts gusts;
        phys_vec u;
        phys_gusts_make(&turbulence, SIGMA, &gusts);
        phys_gusts_at(&gusts, &place, &u);
        for (int r = 0; r < 3; r++) {
            phys_vec there = place, v;
            there[r] += distance;
            phys_gusts_at(&gusts, &there, &v);
            for (int i = 0; i < 3; i++)
                mean[(r - i + 3) % 3] += u[i] * v[i] / (SIGMA * SIGMA) / (3.0 * SEEDS);
        }
    }
}

/* A mean of n independent products of normal numbers is off by 1 / sqrt(n); four times that. */
static const double MOST = 4 / 141.0;

UNIT_TEST(variance)
{
    double mean[3];
    correlate(0, mean);
    for (int i = 0; i < 3; i++)
        ck_assert_double_eq_tol(mean[i], 1, MOST * sqrt(2));
}

UNIT_TEST(correlation)
{
    static const double part[] = {0.1, 0.5, 1, 2, 3};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        double mean[3];
        correlate(part[i] * LENGTH, mean);
        ck_assert_double_eq_tol(mean[0], exp(-part[i]), MOST);
        ck_assert_double_eq_tol(mean[1], (1 - part[i] / 2) * exp(-part[i]), MOST);
        ck_assert_double_eq_tol(mean[2], (1 - part[i] / 2) * exp(-part[i]), MOST);
    }
}

/* Each wave is across its direction, and all have one amplitude: so the mean square over a large
 * space is that of each seed. */
UNIT_TEST(waves)
{
    const struct phys_turbulence turbulence = {.length = LENGTH, .seed = 7};
    struct phys_gusts gusts;
    double square = 0;
    phys_gusts_make(&turbulence, SIGMA, &gusts);
    for (int i = 0; i < PHYS_WAVES; i++) {
        phys_vec along = gusts.wave[i];
        ck_assert(along[3] >= 0 && along[3] < 1);
        along[3] = 0;
        ck_assert_double_le(fabs(phys_dot(&along, gusts.across + i)),
                            1e-14 * SIGMA * sqrt(phys_dot(&along, &along)));
        square += phys_dot(gusts.across + i, gusts.across + i) / 2;
    }
    ck_assert_double_eq_tol(square, 3 * SIGMA * SIGMA, 1e-12);
}

/* The force on a triangle that is still, in the gusts of a time, is that of the velocity at its
 * middle, where the field was when the wind began. */
UNIT_TEST(carried)
{
    phys_vec x[3] = {{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}}, v[3] = {{0}}, f[3] = {{0}}, u;
    uint32_t corner[1][4] = {{0, 1, 2, PHYS_NO_CORNER}};
    const struct phys_elements faces = {.n = 1, .corner = corner};
    const struct phys_sight sight = {.n = 3, .x = x, .v = v};
    const struct phys_air air = {
        .density = 1.2,
        .wind = {0, 4, 0},
        .normal = 1.3,
        .turbulence = {.intensity = 0.25, .length = LENGTH, .seed = 3, .way = {0, 1.5, 0}}};
    const phys_vec middle = {0.1 / 3, -1.5, 0.1 / 3};
    struct phys_gusts gusts;
    phys_gusts_make(&air.turbulence, 1, &gusts);
    phys_gusts_at(&gusts, &middle, &u);
    phys_air_force(&faces, &air, &sight, f);
    const double across = 4 + u[1];
    ck_assert_double_eq_tol(f[1][1], 1.2 / 2 * 0.005 * 1.3 * fabs(across) * across / 3, 1e-15);
    ck_assert_double_eq(f[1][0], 0);
}
