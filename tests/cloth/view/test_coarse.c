/* Coarse triangles that cast the shadows of the sky: on a flat grid they are few, have vertices of
 * the grid, do not turn over, and cover nearly all of it. */
#include "cloth/view/draw/draw.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>

enum { N = 60, TRIANGLES = 2 * (N - 1) * (N - 1) };

static uint32_t triangle[TRIANGLES][3], join[N * N];
static float vertex[N * N][6]; /* 1 m apart */

static void setup(void)
{
    uint32_t t = 0;
    for (uint32_t v = 0; v < N * N; v++) {
        vertex[v][0] = (float)(v % N);
        vertex[v][1] = (float)(v / N);
        vertex[v][2] = vertex[v][3] = vertex[v][4] = 0;
        vertex[v][5] = 1;
    }
    for (uint32_t j = 0; j + 1 < N; j++)
        for (uint32_t i = 0; i + 1 < N; i++) {
            const uint32_t v = j * N + i;
            const uint32_t two[2][3] = {{v, v + 1, v + N + 1}, {v, v + N + 1, v + N}};
            for (int k = 0; k < 2; k++, t++)
                for (int c = 0; c < 3; c++)
                    triangle[t][c] = two[k][c];
        }
}

static double area(const uint32_t *of)
{
    double x[3], y[3];
    for (int c = 0; c < 3; c++) {
        ck_assert_uint_lt(of[c], N * N);
        x[c] = of[c] % N;
        y[c] = of[c] / N;
    }
    return 0.5 * ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
}

UNIT_FIXTURE(setup, NULL)

UNIT_TEST(a_grid)
{
    uint32_t n = TRIANGLES;
    for (int round = 0; round < 2; round++) {
        const uint32_t before = n;
        double sum = 0;
        n = draw_coarsen(N * N, vertex[0], 10, 0, join, n, triangle);
        ck_assert_uint_lt(n, before / 2);
        for (uint32_t t = 0; t < n; t++) {
            ck_assert_double_ge(area(triangle[t]), 0);
            sum += area(triangle[t]);
        }
        ck_assert_double_gt(sum, (round ? 0.8 : 0.9) * (N - 1) * (N - 1));
        ck_assert_double_le(sum, (N - 1) * (N - 1));
    }
}

UNIT_TEST(long_edges_stay)
{
    const uint32_t n = draw_coarsen(N * N, vertex[0], 0.9f, 0, join, TRIANGLES, triangle);
    ck_assert_uint_eq(n, TRIANGLES);
}

UNIT_TEST(small_pieces)
{
    uint32_t two[2][3] = {{0, 1, N}, {3, 4, N + 3}}; /* become points */
    ck_assert_uint_eq(draw_coarsen(N * N, vertex[0], 2, 0, join, 2, two), 0);
}

/* In waves along x, 0.5 m high, a crest every 12 m, no vertex that is left stands for one that is
 * farther off its plane than allowed: the light of the sky is looked for just off the surface. */
UNIT_TEST(folds_stay)
{
    const double turn = 2 * acos(-1.0) / 12;
    const float flat = 0.05f;
    for (uint32_t v = 0; v < N * N; v++) {
        const double slope = 0.5 * turn * cos(turn * (v % N)), length = hypot(1, slope);
        vertex[v][2] = (float)(0.5 * sin(turn * (v % N)));
        vertex[v][3] = (float)(-slope / length);
        vertex[v][5] = (float)(1 / length);
    }
    const uint32_t n = draw_coarsen(N * N, vertex[0], 10, flat, join, TRIANGLES, triangle);
    ck_assert_uint_lt(n, TRIANGLES);
    for (uint32_t v = 0; v < N * N; v++) {
        double off = 0;
        for (int k = 0; k < 3 && join[v] != UINT32_MAX; k++)
            off += (double)((vertex[v][k] - vertex[join[v]][k]) * vertex[v][3 + k]);
        ck_assert_double_le(fabs(off), (double)flat + 1e-6);
    }
}
