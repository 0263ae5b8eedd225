/* The frequencies of a hanging chain: those of its links, which a few lines here find, and near
 * them those of a rope, j sqrt(g / L) / 2 with j the zeros of the Bessel function J0. The chain is
 * let swing in one of its modes; the frequency is that of its lowest vertex. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINKS = 20 };
static const double M = 0.01, K = 5000, G = 9.81, LENGTH = 0.05;

/* The load of link i (1 .. LINKS), N, and how long it hangs. */
static double tension(size_t i)
{
    return (double)(LINKS + 1 - i) * M * G;
}
static double hangs(size_t i)
{
    return LENGTH + tension(i) / K;
}

/* y = A x of M x'' = - A x sideways, vertices 1 .. LINKS; vertex 0 is held. */
static void apply(const double *x, double *y)
{
    for (size_t i = 1; i <= LINKS; i++) {
        y[i] = tension(i) / hangs(i) * (x[i] - x[i - 1]);
        if (i < LINKS)
            y[i] += tension(i + 1) / hangs(i + 1) * (x[i] - x[i + 1]);
    }
}

/* Solves A y = x: what goes through a link is the sum below it. */
static void solve(const double *x, double *y)
{
    double below[LINKS + 2] = {0};
    for (size_t i = LINKS; i >= 1; i--)
        below[i] = below[i + 1] + x[i];
    y[0] = 0;
    for (size_t i = 1; i <= LINKS; i++)
        y[i] = y[i - 1] + below[i] * hangs(i) / tension(i);
}

static double dot(const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 1; i <= LINKS; i++)
        sum += a[i] * b[i];
    return sum;
}

/* The slowest mode but for those before it, by inverse iteration; scaled to 1 at the lowest vertex.
 * Returns its frequency, rad/s. */
static double mode(size_t n, double modes[][LINKS + 1])
{
    double *x = modes[n], y[LINKS + 1] = {0};
    for (size_t i = 0; i <= LINKS; i++)
        x[i] = i == 0 ? 0 : 1 + (double)(i * i * (n + 1) % 7);
    for (int turn = 0; turn < 200; turn++) {
        for (size_t k = 0; k < n; k++) {
            const double part = dot(x, modes[k]) / dot(modes[k], modes[k]);
            for (size_t i = 0; i <= LINKS; i++)
                x[i] -= part * modes[k][i];
        }
        solve(x, y);
        for (size_t i = 0; i <= LINKS; i++)
            x[i] = y[i] / y[LINKS];
    }
    apply(x, y);
    return sqrt(dot(x, y) / dot(x, x) / M);
}

static void hang(struct setup *s, const double *swing)
{
    setup_chain(s, LINKS, 0, -LENGTH, M, K);
    double *start = calloc(6 * (LINKS + 1), sizeof *start);
    ck_assert_ptr_nonnull(start);
    for (size_t i = 1; i <= LINKS; i++) {
        start[6 * i] = 1e-4 * swing[i];
        start[6 * i + 1] = start[6 * i - 5] - hangs(i);
    }
    s->cloth.start = start;
    s->model.grain = 100;
    s->model.tolerance = 1e-12;
}

/* From three frames a quarter of a swing and more apart: x1 = cos(w t) x0 + ..., by crossings of
 * zero. */
static double frequency_seen(const struct record *r)
{
    double first = 0, last = 0;
    int crossings = 0;
    for (size_t f = 1; f < r->frames; f++) {
        const double a = record_at(r, f - 1, LINKS, 0), b = record_at(r, f, LINKS, 0);
        if ((a > 0) == (b > 0))
            continue;
        const double t = r->time[f - 1] + (r->time[f] - r->time[f - 1]) * a / (a - b);
        first = crossings++ == 0 ? t : first;
        last = t;
    }
    ck_assert_int_gt(crossings, 2);
    return acos(-1) * (crossings - 1) / (last - first);
}

UNIT_LOOP(frequencies, 0, 4)
{
    static const struct {
        enum model_integrator integrator;
        double h, end;
        size_t mode;
        double allowed;
    } rows[] = {{MODEL_VERLET, 0.0004, 3, 0, 1e-5},
                {MODEL_VERLET, 0.0004, 1.5, 1, 1e-4},
                {MODEL_BDF2, 0.002, 3, 0, 1e-4},
                {MODEL_BDF2, 0.002, 1.5, 1, 1e-3}};
    static const double zero[] = {2.404825557695773, 5.520078110286311}; /* of J0 */
    double modes[2][LINKS + 1], omega[2];
    UNIT_OWNED(setup_free) struct setup setup;
    struct record r = {0};
    for (size_t n = 0; n < 2; n++)
        omega[n] = mode(n, modes);
    const size_t n = rows[_i].mode;
    hang(&setup, modes[n]);
    setup.model.integrator = rows[_i].integrator;
    setup.model.h = rows[_i].h;
    setup.model.end = rows[_i].end;
    setup.model.fps = 250;
    record_fine(&r, &setup.model);
    const double rope = zero[n] / 2 * sqrt(G / (LINKS * LENGTH)), now = frequency_seen(&r);
    printf(
        "# hanging chain, mode %zu, %s, h = %g s: %.6f rad/s, %.6f of its links, %.6f of a rope\n",
        n + 1, model_schemes[rows[_i].integrator].name, rows[_i].h, now, omega[n], rope);
    ck_assert_double_eq_tol(now, omega[n], rows[_i].allowed * omega[n]);
    ck_assert_double_eq_tol(now, rope, 0.06 * rope);
    record_free(&r);
    free(setup.cloth.start);
}
