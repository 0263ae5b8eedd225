/* Checks by differences. Everything is of the test's own words; what a model says is called only.
 */
#include "tests/cloth/physics/elements.h"

#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct phys_sight look(const struct elements_state *s)
{
    return (struct phys_sight){s->n, s->x, s->v, NULL, NULL};
}

static double draw(unsigned *seed) /* -1 .. 1 */
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1u << 23) - 1;
}

void elements_shake(struct elements_state *state, double size, unsigned seed)
{
    for (uint32_t i = 0; i < state->n; i++)
        for (int c = 0; c < 3; c++) {
            state->x[i][c] += size * draw(&seed);
            state->v[i][c] = draw(&seed);
        }
}

static double largest(const phys_vec *y, uint32_t n)
{
    double max = 0;
    for (uint32_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            max = fmax(max, fabs(y[i][c]));
    return max;
}

/* Largest error of the forces against differences of the energy over 2 e. */
static double force_error(const struct elements *model, const struct elements_state *state,
                          double e)
{
    struct elements_state s = *state;
    phys_vec f[ELEMENTS_MAX] = {{0}};
    memset(s.v, 0, sizeof s.v);
    const struct phys_sight sight = look(&s);
    model->force(model->of, &sight, f);
    for (uint32_t i = 0; i < s.n; i++)
        for (int c = 0; c < 3; c++) {
            s.x[i][c] = state->x[i][c] + e;
            const double more = model->energy(model->of, &sight);
            s.x[i][c] = state->x[i][c] - e;
            const double less = model->energy(model->of, &sight);
            s.x[i][c] = state->x[i][c];
            f[i][c] += (more - less) / (2 * e);
        }
    return largest(f, s.n);
}

void elements_check_gradient(const struct elements *model, const struct elements_state *state,
                             double max)
{
    const double error = force_error(model, state, 1e-5);
    printf("# forces against differences of the energy over 2e-5 m: off by %.2e N\n", error);
    ck_assert_double_le(error, max);
}

/* y = A p of the pairs. */
static void apply(const struct elements *model, const struct phys_pair *pair, const phys_vec *p,
                  uint32_t n, phys_vec *y)
{
    memset(y, 0, n * sizeof *y);
    for (size_t e = 0; e < model->n; e++)
        for (size_t k = 0; k < model->n_pairs; k++, pair++) {
            const uint32_t a = model->corner[e][model->pair[k][0]];
            const uint32_t b = model->corner[e][model->pair[k][1]];
            const phys_vec d = p[a] - p[b];
            for (int c = 0; c < 9; c++) {
                const int row = c % 3, column = (c % 3 + c / 3) % 3;
                y[a][row] += pair->cyclic[c / 3][row] * d[column];
                y[b][column] -= pair->cyclic[c / 3][row] * d[row];
            }
            for (int c = 0; c < 3; c++)
                ck_assert_double_eq(pair->cyclic[c][3], 0);
        }
}

enum { MAX_PAIRS = 6 * ELEMENTS_MAX };

/* Rows of h^2 K + h C against differences of the forces. */
static void check_columns(const struct elements *model, const struct elements_state *state,
                          const struct phys_pair *still, const struct phys_pair *moving, double h,
                          double max)
{
    const double e = 1e-6;
    double worst = 0;
    for (uint32_t j = 0; j < state->n; j++)
        for (int c = 0; c < 3; c++) {
            phys_vec f[4][ELEMENTS_MAX] = {{{0}}}, p[ELEMENTS_MAX] = {{0}}, y[ELEMENTS_MAX],
                     z[ELEMENTS_MAX];
            for (int side = 0; side < 2; side++) {
                struct elements_state s = *state, m = *state;
                const struct phys_sight at = look(&s), with = look(&m);
                memset(s.v, 0, sizeof s.v);
                s.x[j][c] += side ? e : -e;
                m.v[j][c] += side ? e : -e;
                model->force(model->of, &at, f[side]);
                model->force(model->of, &with, f[2 + side]);
            }
            p[j][c] = 1;
            apply(model, still, p, state->n, y);
            apply(model, moving, p, state->n, z);
            for (uint32_t i = 0; i < state->n; i++) {
                y[i] += h * h * (f[1][i] - f[0][i]) / (2 * e);
                z[i] += h * h * (f[1][i] - f[0][i]) / (2 * e) + h * (f[3][i] - f[2][i]) / (2 * e);
            }
            worst = fmax(worst, fmax(largest(y, state->n), largest(z, state->n)));
        }
    printf("# whole matrix against differences of the forces: off by %.1e N/m\n", worst);
    ck_assert_double_le(worst, max);
}

/* K v against the matrix, of which C goes by the difference of two steps:
 * (2 h)^2 K + 2 h C - 2 (h^2 K + h C) = 2 h^2 K. */
static void check_product(const struct elements *model, const struct elements_state *state,
                          int full, double max)
{
    const struct phys_sight sight = look(state);
    struct phys_pair pair[2][MAX_PAIRS];
    phys_vec y[2][ELEMENTS_MAX], product[ELEMENTS_MAX] = {{0}};
    for (int i = 0; i < 2; i++) {
        const struct phys_step step = {i ? 2 : 1, full};
        model->matrix(model->of, &step, &sight, pair[i]);
        apply(model, pair[i], state->v, state->n, y[i]);
    }
    model->stiffness(model->of, full, 0.5, &sight, product);
    double power = 0;
    for (uint32_t i = 0; i < state->n; i++) {
        const phys_vec kv = 0.5 * (y[1][i] - 2 * y[0][i]);
        power += phys_dot(&kv, state->v + i);
        product[i] += 0.5 * kv;
    }
    ck_assert_double_le(largest(product, state->n), max);
    if (!full)
        ck_assert_double_ge(power, -max);
}

void elements_check_matrix(const struct elements *model, const struct elements_state *state,
                           double max)
{
    const double h = 0.5;
    struct phys_pair pair[MAX_PAIRS], still[MAX_PAIRS], twice[MAX_PAIRS];
    const struct phys_sight sight = look(state);
    const struct phys_step one = {h, 1}, two = {2 * h, 1};
    model->matrix(model->of, &one, &sight, pair);
    model->matrix(model->of, &two, &sight, twice);
    for (size_t i = 0; i < model->n * model->n_pairs; i++)
        for (int c = 0; c < 3; c++)
            still[i].cyclic[c] = 0.5 * (twice[i].cyclic[c] - 2 * pair[i].cyclic[c]);
    check_columns(model, state, still, pair, h, max);
    check_product(model, state, 0, max);
    check_product(model, state, 1, max);
}

static void cross(const phys_vec *a, const phys_vec *b, phys_vec *y)
{
    *y = (phys_vec){(*a)[1] * (*b)[2] - (*a)[2] * (*b)[1], (*a)[2] * (*b)[0] - (*a)[0] * (*b)[2],
                    (*a)[0] * (*b)[1] - (*a)[1] * (*b)[0], 0};
}

void elements_check_momentum(const struct elements *model, const struct elements_state *state,
                             double max)
{
    phys_vec f[ELEMENTS_MAX] = {{0}}, y[ELEMENTS_MAX] = {{0}}, sum[3] = {{0}};
    const struct phys_sight sight = look(state);
    model->force(model->of, &sight, f);
    model->stiffness(model->of, 0, 1, &sight, y);
    for (uint32_t i = 0; i < state->n; i++) {
        phys_vec torque;
        cross(state->x + i, f + i, &torque);
        sum[0] += f[i];
        sum[1] += torque;
        sum[2] += y[i];
    }
    printf("# internal forces up to %.2g N: their sum %.1e N, their torque %.1e N m\n",
           largest(f, state->n), largest(sum, 1), largest(sum + 1, 1));
    ck_assert_double_gt(largest(f, state->n), 1e3 * max);
    ck_assert_double_le(largest(sum, 3), max);
}

/* A turn (a quaternion that is not of length 1) and a move. */
static void move(const phys_vec *x, phys_vec *y)
{
    const double w = 0.3, a = -0.7, b = 0.4, c = 0.5, n = w * w + a * a + b * b + c * c;
    const phys_vec q = {a, b, c, 0}, away = {3, -2, 5, 0};
    phys_vec t, u;
    cross(&q, x, &t);
    t *= 2 / n;
    cross(&q, &t, &u);
    *y = *x + w * t + u + away;
}

void elements_check_rigid(const struct elements *model, const struct elements_state *rest,
                          double max)
{
    struct elements_state s = *rest;
    const phys_vec spin = {0.3, -0.8, 0.5, 0};
    phys_vec f[ELEMENTS_MAX] = {{0}};
    for (uint32_t i = 0; i < s.n; i++) {
        move(rest->x + i, s.x + i);
        cross(&spin, s.x + i, s.v + i);
    }
    const struct phys_sight sight = look(&s);
    model->force(model->of, &sight, f);
    printf("# turned, moved and spinning as a whole: forces %.1e N\n", largest(f, s.n));
    ck_assert_double_le(largest(f, s.n), max);
}

void elements_check_split(const struct elements *model, const struct elements_state *state,
                          uint32_t split)
{
    struct elements_state s = *state;
    phys_vec f[ELEMENTS_MAX] = {{0}}, y[ELEMENTS_MAX] = {{0}};
    const struct phys_sight whole = look(&s);
    const struct phys_sight low = {split, s.x, s.v, s.x + split, s.v + split};
    phys_vec g[ELEMENTS_MAX + 1] = {{0}}, z[ELEMENTS_MAX + 1] = {{0}};
    model->force(model->of, &whole, f);
    model->stiffness(model->of, 0, 1, &whole, y);
    model->force(model->of, &low, g);
    model->stiffness(model->of, 0, 1, &low, z);
    ck_assert_mem_eq(f, g, split * sizeof *f);
    ck_assert_mem_eq(y, z, split * sizeof *y);
    for (uint32_t i = split; i < s.n; i++) /* not its rows */
        for (int c = 0; c < 4; c++)
            ck_assert(g[i][c] == 0 && z[i][c] == 0);
    const double all = model->energy(model->of, &whole), part = model->energy(model->of, &low);
    ck_assert(part > 0 && part < all);
}
