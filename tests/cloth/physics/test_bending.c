/* Hinges against their angles, and against a cylinder: what they have beyond what
 * tests/cloth/element says of every kind. */
#include "cloth/physics/bending.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>

/* ---- Angles ---- */

/* Two triangles of different heights and feet, folded by theta about an edge that lies askew. */
static void quadratic(double theta, double x[12])
{
    const double c = cos(theta), s = sin(theta);
    const double flat[4][3] = {{0, 0, 0}, {1.3, 0, 0}, {0.4, 0.7, 0}, {0.9, -1.1 * c, -1.1 * s}};
    for (int i = 0; i < 4; i++) { /* a turn of length 3: (1 2 2)(-2 -1 2)(2 -2 1) */
        const double *p = flat[i];
        x[3 * i] = (p[0] - 2 * p[1] + 2 * p[2]) / 3;
        x[3 * i + 1] = (2 * p[0] - p[1] - 2 * p[2]) / 3;
        x[3 * i + 2] = (2 * p[0] + 2 * p[1] + p[2]) / 3;
    }
}

UNIT_TEST(s_is_twice_the_sine_of_half_the_angle)
{
    for (double theta = -3.1; theta < 3.14; theta += 0.1) {
        double x[12];
        struct phys_bend_rest rest;
        quadratic(theta, x);
        ck_assert_int_eq(phys_bend_rest(x, &rest), 0);
        ck_assert_double_eq_tol(rest.s, 2 * sin(theta / 2), 1e-14);
        ck_assert_double_eq_tol(rest.shape, 1.3 * 1.3 / (0.5 * 1.3 * (0.7 + 1.1)), 1e-14);
        ck_assert_double_eq_tol(rest.weight[2], -1 / 0.7, 1e-14);
        ck_assert_double_eq_tol(rest.weight[3], -1 / 1.1, 1e-14);
        ck_assert_double_eq_tol(rest.weight[1], 0.4 / 1.3 / 0.7 + 0.9 / 1.3 / 1.1, 1e-14);
    }
}

UNIT_TEST(rigidity_is_that_of_the_threads_across)
{
    ck_assert_double_eq(phys_bend_rigidity(3, 5, (double[]){0, 2}), 3);
    ck_assert_double_eq(phys_bend_rigidity(3, 5, (double[]){-7, 0}), 5);
    ck_assert_double_eq(phys_bend_rigidity(3, 5, (double[]){1, -1}), 4);
    ck_assert_double_eq(phys_bend_rigidity(3, 5, (double[]){0, 0}), 4);
}

UNIT_TEST(rest_shapes_without_area_are_refused)
{
    const double line[12] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0}, point[12] = {0};
    struct phys_bend_rest rest;
    ck_assert_int_eq(phys_bend_rest(line, &rest), -1);
    ck_assert_int_eq(phys_bend_rest(point, &rest), -1);
}

/* Folded nearly shut, one way and the other, forces still open it. */
UNIT_TEST(angles_up_to_half_a_turn)
{
    uint32_t one[1][4] = {{0, 1, 2, 3}};
    double k = 1, damping = 0, rest = 0;
    const struct phys_elements hinge = {.n = 1, .corner = one, .number = {&k, &damping, &rest}};
    for (int side = -1; side < 2; side += 2) {
        double x[12];
        phys_vec row[4], f[4] = {{0}}, v[4] = {{0}};
        quadratic(side * 3.0, x);
        for (int i = 0; i < 4; i++)
            row[i] = (phys_vec){x[3 * i], x[3 * i + 1], x[3 * i + 2], 0};
        const struct phys_sight sight = {4, row, v, NULL, NULL};
        phys_hinges_force(&hinge, NULL, &sight, f);
        /* at the third corner: along its normal, k s cos(theta / 2) / height */
        const double size = sqrt(phys_dot(f + 2, f + 2));
        ck_assert_double_eq_tol(size, 2 * sin(1.5) * cos(1.5) / 0.7, 1e-12);
        const phys_vec normal = {2.0 / 3, -2.0 / 3, 1.0 / 3, 0};
        ck_assert_double_gt(side * phys_dot(f + 2, &normal), 0);
    }
}

UNIT_TEST(collapsed_hinges_stay_finite)
{
    uint32_t one[1][4] = {{0, 1, 2, 3}};
    double k = 1, damping = 1, rest = 0.5;
    const struct phys_elements hinge = {.n = 1, .corner = one, .number = {&k, &damping, &rest}};
    const phys_vec x[2][4] = {{{0}, {1, 0, 0, 0}, {0.5, 0, 0, 0}, {0.5, 0, 1, 0}}, {{0}}};
    const phys_vec v[4] = {{1, 2, 3, 0}, {0}, {0}, {0}};
    for (int i = 0; i < 2; i++) {
        const struct phys_sight sight = {4, x[i], v, NULL, NULL};
        const struct phys_step step = {1, 1};
        phys_vec f[4] = {{0}};
        struct phys_pair pair[PHYS_BEND_PAIRS];
        phys_hinges_force(&hinge, NULL, &sight, f);
        phys_hinges_matrix(&hinge, 0, 1, &step, &sight, NULL, pair);
        for (int c = 0; c < 16; c++)
            ck_assert(isfinite(f[c / 4][c % 4]));
        for (int c = 0; c < 12 * PHYS_BEND_PAIRS; c++)
            ck_assert(isfinite(pair[c / 12].cyclic[c / 4 % 3][c % 4]));
    }
}

/* ---- A cylinder ---- */

/* Energy for each area of a sheet that is bent with curvature 1 / radius in the direction `along`,
 * in units of 1 / 2 radius^-2, for rigidity 1. The lattice: vertex i a + j b, triangles (0, a, a +
 * b) and (a + b, b, 0); of its three families of edges one hinge each stands for all. */
static double cylinder(const double a[2], const double b[2], double along)
{
    const double p[4][2] = {{0, 0}, {a[0], a[1]}, {a[0] + b[0], a[1] + b[1]}, {b[0], b[1]}};
    const double q[6][2] = {{0, 0},       {a[0], a[1]},   {a[0] + b[0], a[1] + b[1]},
                            {b[0], b[1]}, {-b[0], -b[1]}, {-a[0], -a[1]}};
    /* the diagonal, edge a with the triangle below, edge b with the one to the left */
    const int hinge[3][4] = {{0, 2, 3, 1}, {0, 1, 2, 4}, {0, 3, 5, 2}};
    const double radius = 1e3, cell = fabs(p[1][0] * p[3][1] - p[1][1] * p[3][0]);
    double sum = 0;
    for (int e = 0; e < 3; e++) {
        double flat[12] = {0}, bent[12];
        struct phys_bend_rest rest, now;
        for (int i = 0; i < 4; i++) {
            const double *x = q[hinge[e][i]];
            const double s = cos(along) * x[0] + sin(along) * x[1];
            flat[3 * i] = x[0];
            flat[3 * i + 1] = x[1];
            bent[3 * i] = radius * sin(s / radius);
            bent[3 * i + 1] = -sin(along) * x[0] + cos(along) * x[1];
            bent[3 * i + 2] = 2 * radius * sin(s / radius / 2) * sin(s / radius / 2);
        }
        ck_assert_int_eq(phys_bend_rest(flat, &rest) + phys_bend_rest(bent, &now), 0);
        sum += rest.shape * now.s * now.s;
    }
    return sum * radius * radius / cell;
}

/* The mesh's direction, as docs/physics.md has it. */
UNIT_TEST(bias_of_the_mesh)
{
    const double right[2][2] = {{1, 0}, {0, 1}}, equal[2][2] = {{1, 0}, {-0.5, sqrt(0.75)}};
    for (int i = 0; i < 12; i++) {
        const double angle = i * M_PI / 12, s = sin(angle), c = cos(angle);
        ck_assert_double_eq_tol(cylinder(equal[0], equal[1], angle), 1, 1e-5);
        const double w = s * c, expected = 1 + 2 * w + 4 * w * w;
        ck_assert_double_eq_tol(cylinder(right[0], right[1], angle), expected, 1e-5);
    }
}
