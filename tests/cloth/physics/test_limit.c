/* Limits of explicit steps: a mode a little below its limit dies out or stays, a little above it
 * grows, whatever its damping. Verlet and Runge-Kutta are their own bodies here. */
#include "cloth/physics/limit.h"
#include "cloth/physics/particle.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>

enum { STEPS = 100000 };

struct mode {
    double omega, a; /* s'' + a s' + omega^2 s = 0 */
};

static double acceleration(const struct mode *m, double x, double v)
{
    return -m->omega * m->omega * x - m->a * v;
}

static void euler(const struct mode *m, double h, double *x, double *v)
{
    const double a = acceleration(m, *x, *v);
    *x += h * *v;
    *v += h * a;
}

static void symplectic(const struct mode *m, double h, double *x, double *v)
{
    *v += h * acceleration(m, *x, *v);
    *x += h * *v;
}

/* All damping along springs: the drag is zero. The force of a step is that of the end of the one
 * before. */
static void verlet(const struct mode *m, double h, double *x, double *v)
{
    static double last;
    const double mass = 1, drag = 0, loose = 1;
    if (*v == 1 && *x == 0)
        last = acceleration(m, *x, *v);
    phys_vec f = {last}, now = {*v}, half = {0};
    phys_kick(1, h / 2, 1, &mass, &drag, &loose, &f, &now, &half);
    phys_kick(1, h / 2, 0, &mass, &drag, &loose, &f, &half, &now);
    *x += h * half[0];
    last = f[0] = acceleration(m, *x, now[0]);
    phys_kick(1, h / 2, 0, &mass, &drag, &loose, &f, &half, &now);
    *v = now[0];
}

static void runge(const struct mode *m, double h, double *x, double *v)
{
    phys_vec at = {*x}, speed = {*v}, x0, v0, sum_x, sum_v;
    const struct phys_runge state = {&x0, &v0, &sum_x, &sum_v};
    for (int stage = 0; stage < PHYS_RUNGE_STAGES; stage++) {
        const phys_vec a = {acceleration(m, at[0], speed[0])};
        phys_runge_stage(1, h, stage, &a, &state, &at, &speed);
    }
    *x = at[0];
    *v = speed[0];
}

static const struct {
    const char *name;
    void (*step)(const struct mode *m, double h, double *x, double *v);
    double (*limit)(double omega, double a);
    double undamped; /* limit times omega */
} SCHEMES[] = {{"explicit Euler", euler, phys_limit_euler, 0},
               {"symplectic Euler", symplectic, phys_limit_symplectic, 2},
               {"Verlet", verlet, phys_limit_verlet, 2},
               {"RK4", runge, phys_limit_rk4, 2.8284271247461903}};

/* How large the mode is after many steps, begun at 1. */
static double grown(int scheme, const struct mode *m, double h)
{
    double x = 0, v = 1;
    for (int i = 0; i < STEPS && fabs(x) < 1e50; i++)
        SCHEMES[scheme].step(m, h, &x, &v);
    return sqrt(m->omega * m->omega * x * x + v * v);
}

UNIT_LOOP(limits, 0, sizeof SCHEMES / sizeof *SCHEMES)
{
    static const double zeta[] = {0.1, 0.4, 1, 1.5, 4};
    for (size_t i = 0; i < sizeof zeta / sizeof *zeta; i++) {
        const struct mode m = {30, 2 * zeta[i] * 30};
        const double h = SCHEMES[_i].limit(m.omega, m.a);
        printf("# %s: zeta %g, limit %.4f / omega\n", SCHEMES[_i].name, zeta[i], h * m.omega);
        ck_assert_double_lt(grown(_i, &m, 0.99 * h), 10);
        ck_assert_double_gt(grown(_i, &m, 1.01 * h), 1e6);
    }
    const double alone = 30 * SCHEMES[_i].limit(30, 0);
    ck_assert_double_eq_tol(alone, SCHEMES[_i].undamped, 1e-12);
}

/* Without damping explicit Euler makes every mode sqrt(1 + h^2 omega^2) times as large. */
UNIT_TEST(undamped_growth)
{
    const struct mode m = {30, 0};
    double x = 0, v = 1;
    for (int i = 0; i < 50; i++)
        euler(&m, 0.001, &x, &v);
    ck_assert_double_eq_tol(sqrt(900 * x * x + v * v), pow(sqrt(1 + 0.03 * 0.03), 50), 1e-12);
}

static void largest(double expected, const double m[6])
{
    const double seen = phys_largest(m);
    ck_assert_double_ge(seen, expected * (1 - 1e-14));
    ck_assert_double_le(seen, expected * 1.01);
}

UNIT_TEST(largest_eigenvalue)
{
    largest(3, (const double[]){3, 1, 2, 0, 0, 0});
    largest(7e9, (const double[]){7e9, 7e9, 7e9, 0, 0, 0});
    largest(9, (const double[]){1, 4, 4, 2, 4, 2});           /* (1, 2, 2) with itself */
    largest(3 + sqrt(2), (const double[]){3, 3, 3, 1, 1, 0}); /* a tridiagonal one */
    ck_assert_double_eq(phys_largest((const double[6]){0}), 0);
}
