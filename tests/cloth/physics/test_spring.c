/* Springs as elements (elements.h), whose energy is written here again, in the test's own words;
 * and what they have beyond that: compression, and two sides of a cut spring that are exact
 * opposites. */
#include "cloth/physics/particle.h"
#include "cloth/physics/spring.h"
#include "tests/cloth/physics/elements.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

enum { N = 5, SPRINGS = 7 };

static const uint32_t ends[SPRINGS][2] = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {3, 4}, {0, 4}};
static const double stiffness[SPRINGS] = {50, 20, 35, 80, 10, 60, 25};
static const double damping[SPRINGS] = {0.5, 0.2, 0.3, 0.9, 0.1, 0, 0.4};

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

static struct phys_springs tangle(const double *length)
{
    return (struct phys_springs){SPRINGS, ends, stiffness, damping, length, 0};
}

/* Sum of k (l - L)^2 / 2. */
static double tangle_energy(const void *of, const struct phys_sight *sight)
{
    const struct phys_springs *s = of;
    double sum = 0;
    for (size_t i = 0; i < s->n; i++) {
        const phys_vec *a = sight->x + s->end[i][0], *b = sight->x + s->end[i][1];
        const double l = hypot(hypot((*b)[0] - (*a)[0], (*b)[1] - (*a)[1]), (*b)[2] - (*a)[2]);
        sum += 0.5 * s->stiffness[i] * (l - s->length[i]) * (l - s->length[i]);
    }
    return sum;
}

/* y -= h^2 K v. */
static void take_stiffness(const struct phys_springs *s, double h, const phys_vec *x,
                           const phys_vec *v, phys_vec *y)
{
    phys_vec value[SPRINGS];
    phys_springs_system(s, h, 0, x, v, NULL, NULL, y, value);
}

static void tangle_force(const void *of, const struct phys_sight *sight, phys_vec *f)
{
    phys_springs_force(of, sight->x, sight->v, NULL, NULL, f);
}

static struct phys_springs slope_of(const void *of, int full)
{
    struct phys_springs s = *(const struct phys_springs *)of;
    s.full = full ? PHYS_FULL : 0;
    return s;
}

static void tangle_stiffness(const void *of, int full, double scale, const struct phys_sight *sight,
                             phys_vec *y)
{
    const struct phys_springs s = slope_of(of, full);
    take_stiffness(&s, sqrt(scale), sight->x, sight->v, y);
}

/* A spring's value w, alpha stands for w w' + alpha I. */
static void tangle_matrix(const void *of, const struct phys_step *step,
                          const struct phys_sight *sight, struct phys_pair *pair)
{
    const struct phys_springs s = slope_of(of, step->full);
    phys_vec value[SPRINGS];
    phys_springs_matrix(&s, step->h, sight->x, sight->x, value);
    for (int i = 0; i < SPRINGS; i++)
        for (int k = 0; k < 3; k++) {
            pair[i].cyclic[k] = (phys_vec){0};
            for (int row = 0; row < 3; row++)
                pair[i].cyclic[k][row] =
                    value[i][row] * value[i][(row + k) % 3] + (k ? 0 : value[i][3]);
        }
}

/* Lengths below all distances, above them, and just these. */
UNIT_LOOP(are_elements, 0, 3)
{
    static const int pair[1][2] = {{0, 1}};
    double distance[SPRINGS];
    const double *const lengths[] = {shorter, longer, distance};
    const struct phys_springs s = tangle(lengths[_i]);
    uint32_t corner[SPRINGS][4];
    struct elements_state state = {.n = N};
    const struct elements model = {&s,
                                   SPRINGS,
                                   1,
                                   (const uint32_t(*)[4])corner,
                                   pair,
                                   tangle_energy,
                                   tangle_force,
                                   tangle_stiffness,
                                   tangle_matrix};
    for (int i = 0; i < SPRINGS; i++) {
        const phys_vec d = places[ends[i][1]] - places[ends[i][0]];
        distance[i] = sqrt(phys_dot(&d, &d));
        memcpy(corner[i], ends[i], sizeof ends[i]);
    }
    memcpy(state.x, places, sizeof places);
    memcpy(state.v, speeds, sizeof speeds);
    if (_i == 2) {
        elements_check_rigid(&model, &state, 1e-12);
        return;
    }
    elements_check_gradient(&model, &state, 1e-7);
    elements_check_matrix(&model, &state, 1e-6);
    elements_check_momentum(&model, &state, 1e-12);
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

/* All of it at once: the matrix to the bit, push times the force, h^2 K v. */
UNIT_LOOP(system_is_force_stiffness_and_matrix, 0, 3)
{
    const double h = 0.3, push = 0.7;
    struct phys_springs s = tangle(_i ? longer : shorter);
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

static double largest(const struct phys_springs *springs, const unsigned char *chosen)
{
    double range[2] = {0};
    phys_springs_range(springs, chosen, places, places, range);
    return range[1];
}

UNIT_TEST(stretch_is_the_largest_of_the_chosen)
{
    unsigned char chosen[SPRINGS] = {1, 0, 1, 0, 0, 0, 0};
    const struct phys_springs s = tangle(shorter);
    const double first = sqrt(1 + 0.01 + 0.04) / 0.5, third = sqrt(0.64 + 1 + 0.25) / 0.4;
    ck_assert_double_eq_tol(largest(&s, chosen), third, 1e-14);
    chosen[2] = 0;
    ck_assert_double_eq_tol(largest(&s, chosen), first, 1e-14);
    chosen[0] = 0;
    ck_assert_double_eq(largest(&s, chosen), 0);
}
