/* Springs against what they are derived from: the force is the slope of the energy, the matrix the
 * slope of the force, and the two sides of a cut spring are exact opposites. The energy is written
 * here again, in the test's own words. */
#include "cloth/physics/particle.h"
#include "cloth/physics/spring.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = 5, SPRINGS = 7 };

static const uint32_t ends[SPRINGS][2] = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {3, 4}, {0, 4}};
static const double stiffness[SPRINGS] = {50, 20, 35, 80, 10, 60, 25};
static const double damping[SPRINGS] = {0.5, 0.2, 0.3, 0.9, 0.1, 0, 0.4};
static const double slack[SPRINGS] = {0, 0, 0, 0, 0, 0, 0};

/* A tangle of springs. Shorter: every rest length below the length, so that no term is dropped. */
static const double shorter[SPRINGS] = {0.5, 0.7, 0.4, 0.3, 0.6, 0.55, 0.8};
static const double longer[SPRINGS] = {2, 1.9, 1.8, 1.7, 2.1, 1.6, 2.2};
static const phys_vec places[N] = {
    {0, 0, 0, 0}, {1, 0.1, -0.2, 0}, {0.2, 1.1, 0.3, 0}, {1.2, 0.9, 0.4, 0}, {0.7, 0.3, 1.5, 0}};
static const phys_vec speeds[N] = {{0.3, -0.2, 0.1, 0},
                                   {-0.5, 0.4, 0.2, 0},
                                   {0.1, 0.6, -0.3, 0},
                                   {0.2, 0.2, 0.7, 0},
                                   {-0.1, -0.4, 0.5, 0}};

static struct phys_springs tangle(const double *c, const double *length)
{
    return (struct phys_springs){SPRINGS, ends, stiffness, c, length, 0};
}

/* Sum of k (l - L)^2 / 2. */
static double energy(const struct phys_springs *s, const phys_vec *x)
{
    double sum = 0;
    for (size_t i = 0; i < s->n; i++) {
        const phys_vec *a = x + s->end[i][0], *b = x + s->end[i][1];
        const double l = hypot(hypot((*b)[0] - (*a)[0], (*b)[1] - (*a)[1]), (*b)[2] - (*a)[2]);
        sum += 0.5 * s->stiffness[i] * (l - s->length[i]) * (l - s->length[i]);
    }
    return sum;
}

/* Largest error of the forces against differences of the energy over 2 e. */
static double force_error(double e)
{
    const struct phys_springs s = tangle(slack, shorter);
    double max = 0;
    phys_vec x[N], f[N] = {{0}};
    memcpy(x, places, sizeof x);
    phys_springs_force(&s, x, speeds, NULL, NULL, f);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++) {
            x[i][c] = places[i][c] + e;
            const double more = energy(&s, x);
            x[i][c] = places[i][c] - e;
            const double less = energy(&s, x);
            x[i][c] = places[i][c];
            max = fmax(max, fabs(f[i][c] + (more - less) / (2 * e)));
        }
    for (int i = 0; i < N; i++)
        ck_assert_double_eq(f[i][3], 0);
    return max;
}

UNIT_TEST(force_is_the_slope_of_the_energy)
{
    const double coarse = force_error(2e-3), fine = force_error(1e-3), least = force_error(1e-6);
    printf("# forces of springs against differences of the energy over 4e-3, 2e-3 and 2e-6 m: off "
           "by %.2e, %.2e, %.2e N: order %.2f\n",
           coarse, fine, least, log2(coarse / fine));
    ck_assert_double_eq_tol(log2(coarse / fine), 2, 0.1);
    ck_assert_double_le(least, 1e-7);
}

UNIT_TEST(damping_acts_along_the_spring_only)
{
    const uint32_t end[1][2] = {{0, 1}};
    const double k[1] = {3}, c[1] = {0.25}, length[1] = {2};
    const struct phys_springs s = {1, end, k, c, length, 0};
    const phys_vec x[2] = {{0}, {0, 2, 0, 0}}, v[2] = {{1, 3, -2, 0}, {5, 7, 9, 0}};
    phys_vec f[2] = {{0}};
    phys_springs_force(&s, x, v, NULL, NULL, f);
    ck_assert_double_eq(f[0][0], 0);
    ck_assert_double_eq(f[0][1], 0.25 * (7 - 3));
    ck_assert_double_eq(f[0][2], 0);
    for (int i = 0; i < 3; i++)
        ck_assert_double_eq(f[1][i], -f[0][i]);
}

/* t = (alpha I + w w') d. */
static void apply(const phys_vec *value, const phys_vec *d, phys_vec *t)
{
    const double along = (*value)[0] * (*d)[0] + (*value)[1] * (*d)[1] + (*value)[2] * (*d)[2];
    const phys_vec w = {(*value)[0], (*value)[1], (*value)[2], 0};
    *t = (*value)[3] * *d + along * w;
}

/* -dF/dx and -dF/dv of all springs by differences, against h c u u' + h^2 K by superposition of
 * unit moves; the full ones also under compression. */
UNIT_LOOP(matrix_is_the_slope_of_the_force, 0, 2)
{
    const double h = 0.1, e = 1e-6;
    struct phys_springs still = tangle(slack, shorter), s = tangle(damping, shorter);
    if (_i) {
        still.length = s.length = longer;
        s.full = PHYS_FULL;
    }
    phys_vec value[SPRINGS];
    phys_springs_matrix(&s, h, places, places, value);
    for (int j = 0; j < N; j++)
        for (int c = 0; c < 3; c++) {
            phys_vec x[2][N], v[2][N], f[2][N] = {{{0}}}, g[2][N] = {{{0}}}, y[N] = {{0}};
            for (int side = 0; side < 2; side++) {
                memcpy(x[side], places, sizeof x[side]);
                memcpy(v[side], speeds, sizeof v[side]);
                x[side][j][c] += side ? e : -e;
                v[side][j][c] += side ? e : -e;
                phys_springs_force(&still, x[side], speeds, NULL, NULL, f[side]);
                phys_springs_force(&s, places, v[side], NULL, NULL, g[side]);
            }
            for (int i = 0; i < SPRINGS; i++) {
                phys_vec p[N] = {{0}};
                p[j][c] = 1;
                const phys_vec d = p[ends[i][0]] - p[ends[i][1]];
                phys_vec t;
                apply(value + i, &d, &t);
                y[ends[i][0]] += t;
                y[ends[i][1]] -= t;
            }
            for (int i = 0; i < N; i++)
                for (int k = 0; k < 3; k++) {
                    const double slope = (f[1][i][k] - f[0][i][k]) / (2 * e) * h * h +
                                         (g[1][i][k] - g[0][i][k]) / (2 * e) * h;
                    ck_assert_double_eq_tol(y[i][k], -slope, 1e-7);
                }
        }
}

/* y -= h^2 K v. */
static void take_stiffness(const struct phys_springs *s, double h, const phys_vec *x,
                           const phys_vec *v, phys_vec *y)
{
    phys_vec value[SPRINGS];
    phys_springs_system(s, h, 0, x, v, NULL, NULL, y, value);
}

UNIT_LOOP(stiffness_times_velocity_is_the_slope_of_the_force, 0, 2)
{
    const double e = 1e-6;
    struct phys_springs s = tangle(slack, shorter);
    if (_i) {
        s.length = longer;
        s.full = PHYS_FULL;
    }
    phys_vec more[N], less[N], f[2][N] = {{{0}}}, y[N] = {{0}};
    for (int i = 0; i < N; i++) {
        more[i] = places[i] + e * speeds[i];
        less[i] = places[i] - e * speeds[i];
    }
    phys_springs_force(&s, more, speeds, NULL, NULL, f[0]);
    phys_springs_force(&s, less, speeds, NULL, NULL, f[1]);
    take_stiffness(&s, 2, places, speeds, y);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(y[i][c], 4 * (f[0][i][c] - f[1][i][c]) / (2 * e), 1e-6);
}

/* All of it at once: the matrix to the bit, push times the force, h^2 K v. */
UNIT_LOOP(system_is_force_stiffness_and_matrix, 0, 3)
{
    const double h = 0.3, push = 0.7;
    struct phys_springs s = tangle(damping, _i ? longer : shorter);
    phys_vec f[N] = {{0}}, y[N] = {{0}}, b[N] = {{0}}, value[SPRINGS], both[SPRINGS];
    s.full = _i == 2;
    phys_springs_force(&s, places, speeds, NULL, NULL, f);
    phys_springs_matrix(&s, h, places, places, value);
    take_stiffness(&s, h, places, speeds, y);
    phys_springs_system(&s, h, push, places, speeds, NULL, NULL, b, both);
    ck_assert_mem_eq(both, value, sizeof value);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 4; c++)
            ck_assert_double_eq_tol(b[i][c], push * f[i][c] + y[i][c], 1e-13);
}

/* A spring at 0.8 of its length: across it the true slope is negative; the matrix has zero there,
 * and k along it. */
UNIT_TEST(compression_drops_the_transverse_term)
{
    const uint32_t end[1][2] = {{0, 1}};
    const double k[1] = {100}, c[1] = {0}, length[1] = {1};
    const struct phys_springs s = {1, end, k, c, length, 0};
    const phys_vec x[2] = {{0}, {0.8, 0, 0, 0}}, v[2] = {{0}, {0, 1, 0, 0}},
                   along[2] = {{0}, {1, 0, 0, 0}};
    phys_vec value, y[2] = {{0}};
    phys_springs_matrix(&s, 0.1, x, x, &value);
    ck_assert_double_eq(value[3], 0);
    ck_assert_double_eq_tol(value[0] * value[0], 1, 1e-15);
    ck_assert_double_eq(value[1], 0);
    take_stiffness(&s, 1, x, v, y);
    ck_assert_double_eq(y[0][1], 0);
    take_stiffness(&s, 1, x, along, y);
    ck_assert_double_eq_tol(y[0][0], 100, 1e-12);
}

/* The absolute slope: across a spring at 0.8 of its length 0.25 k, at less than half of it k, as
 * for two ends at one place; a stretched one has its true slope. */
UNIT_TEST(compression_by_its_absolute_value)
{
    static const double at[] = {0.8, 0.4, 0, 1.25}, across[] = {0.25, 1, 1, 0.2};
    const uint32_t end[1][2] = {{0, 1}};
    const double k[1] = {100}, c[1] = {0}, length[1] = {1};
    const struct phys_springs s = {1, end, k, c, length, PHYS_ABSOLUTE};
    for (int i = 0; i < 4; i++) {
        const phys_vec x[2] = {{0}, {at[i], 0, 0, 0}}, v[2] = {{0}, {0, 1, 0, 0}};
        phys_vec value, y[2] = {{0}};
        phys_springs_matrix(&s, 0.1, x, x, &value);
        ck_assert_double_eq_tol(value[3], across[i], 1e-15);
        ck_assert_double_eq_tol(value[0] * value[0], at[i] > 0 ? 1 - across[i] : 0, 1e-15);
        take_stiffness(&s, 1, x, v, y);
        ck_assert_double_eq_tol(y[0][1], 100 * across[i], 1e-12);
    }
}

UNIT_TEST(ends_at_one_place_pull_nowhere)
{
    const uint32_t end[1][2] = {{0, 1}};
    const double k[1] = {100}, c[1] = {1}, length[1] = {1};
    const struct phys_springs s = {1, end, k, c, length, 0};
    const phys_vec x[2] = {{0.5, 0, 0, 0}, {0.5, 0, 0, 0}}, v[2] = {{0}, {1, 1, 1, 0}};
    phys_vec f[2] = {{0}}, value;
    phys_springs_force(&s, x, v, NULL, NULL, f);
    phys_springs_matrix(&s, 0.1, x, x, &value);
    for (int i = 0; i < 4; i++) {
        ck_assert_double_eq(f[0][i], 0);
        ck_assert_double_eq(value[i], 0);
    }
}

/* Particles 0 and 1 in one block, 2 to 4 in another: the halves give the rows of the whole, cut
 * springs bit for bit with opposite signs. */
UNIT_TEST(cut_springs_are_exact_opposites)
{
    const uint32_t one[1][2] = {{0, 1}}, other[1][2] = {{1, 0}};
    const double k[1] = {37.1}, c[1] = {0.77}, length[1] = {0.9}, more[1] = {1.7};
    for (int i = 0; i < 2; i++) {
        const double *rest = i ? more : length;
        const struct phys_springs here = {1, one, k, c, rest, 0}, there = {1, other, k, c, rest, 0};
        phys_vec f[2] = {{0}}, g[2] = {{0}}, whole[2] = {{0}};
        phys_springs_force(&here, places, speeds, NULL, NULL, whole);
        phys_springs_force(&here, places, speeds, places, speeds, f);
        phys_springs_force(&there, places, speeds, places, speeds, f);
        phys_vec value[3];
        phys_springs_system(&here, 0.3, 0.3, places, speeds, places, speeds, g, value);
        phys_springs_system(&there, 0.3, 0.3, places, speeds, places, speeds, g, value + 1);
        for (int d = 0; d < 3; d++) {
            ck_assert(f[0][d] != 0 && f[0][d] == -f[1][d] && f[0][d] == whole[0][d]);
            ck_assert(g[0][d] != 0 && g[0][d] == -g[1][d]);
        }
        phys_vec whole_g[2] = {{0}};
        phys_springs_system(&here, 0.3, 0.3, places, speeds, NULL, NULL, whole_g, value + 2);
        ck_assert_mem_eq(whole_g, g, sizeof g);
        for (int d = 0; d < 3; d++)
            ck_assert(value[0][d] == -value[1][d] && value[0][d] == value[2][d]);
        ck_assert(value[0][3] == value[1][3] && value[0][3] == value[2][3]);
    }
}

static void cross(const phys_vec *a, const phys_vec *b, phys_vec *y)
{
    *y = (phys_vec){(*a)[1] * (*b)[2] - (*a)[2] * (*b)[1], (*a)[2] * (*b)[0] - (*a)[0] * (*b)[2],
                    (*a)[0] * (*b)[1] - (*a)[1] * (*b)[0], 0};
}

UNIT_LOOP(internal_forces_keep_momentum, 0, 2)
{
    const struct phys_springs s = tangle(damping, _i ? longer : shorter);
    phys_vec f[N] = {{0}}, sum = {0}, torque = {0};
    phys_springs_force(&s, places, speeds, NULL, NULL, f);
    for (int i = 0; i < N; i++) {
        phys_vec t;
        cross(places + i, f + i, &t);
        sum += f[i];
        torque += t;
    }
    for (int c = 0; c < 3; c++) {
        ck_assert_double_eq_tol(sum[c], 0, 1e-13);
        ck_assert_double_eq_tol(torque[c], 0, 1e-13);
    }
    ck_assert_double_gt(phys_dot(f, f), 1);
}

/* Turned by a third of a turn about (1, 1, 1), which swaps the axes, moved, and spinning. */
UNIT_TEST(rigid_motion_gives_no_force)
{
    double rest[SPRINGS];
    phys_vec x[N], v[N], f[N] = {{0}};
    const phys_vec spin = {3, -8, 5, 0}, away = {30, -20, 50, 0};
    for (int i = 0; i < SPRINGS; i++) {
        const phys_vec d = places[ends[i][1]] - places[ends[i][0]];
        rest[i] = sqrt(phys_dot(&d, &d));
    }
    for (int i = 0; i < N; i++) {
        x[i] = (phys_vec){places[i][2], places[i][0], places[i][1], 0} + away;
        cross(&spin, x + i, v + i);
    }
    const struct phys_springs s = tangle(damping, rest);
    phys_springs_force(&s, x, v, NULL, NULL, f);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(f[i][c], 0, 2e-12);
}

UNIT_TEST(stretch_is_the_largest_of_the_chosen)
{
    unsigned char chosen[SPRINGS] = {1, 0, 1, 0, 0, 0, 0};
    const struct phys_springs s = tangle(damping, shorter);
    const double first = sqrt(1 + 0.01 + 0.04) / 0.5, third = sqrt(0.64 + 1 + 0.25) / 0.4;
    ck_assert_double_eq_tol(phys_springs_stretch(&s, chosen, places, places), third, 1e-14);
    chosen[2] = 0;
    ck_assert_double_eq_tol(phys_springs_stretch(&s, chosen, places, places), first, 1e-14);
    chosen[0] = 0;
    ck_assert_double_eq(phys_springs_stretch(&s, chosen, places, places), 0);
}
