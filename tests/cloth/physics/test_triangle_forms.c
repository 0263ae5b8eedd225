/* Triangles against closed forms of a membrane. */
#include "tests/cloth/physics/triangle_sheet.h"

#include <stdio.h>

/* Any affine map leaves inner vertices without force, however distorted the mesh. */
UNIT_TEST(patch)
{
    static const phys_vec map[][2] = {{{1.05, 0, 0, 0}, {0, 0, 0.98, 0}},
                                      {{0.7, 0.6, -0.5, 0}, {0.2, 0.9, 1.2, 0}},
                                      {{1.3, 0, 0.4, 0}, {0.3, 0, 0.8, 0}}};
    for (size_t m = 0; m < sizeof map / sizeof *map; m++) {
        struct sheet s;
        struct elements_state state;
        phys_vec f[VERTICES];
        make_sheet(&s, 0);
        place(&s, map[m], map[m] + 1, &state);
        forces(&s, &state, f);
        double inner = 0, max = 0;
        for (int i = 0; i < VERTICES; i++) {
            const double size = sqrt(phys_dot(f + i, f + i));
            max = fmax(max, size);
            if (is_inner(i))
                inner = fmax(inner, size);
        }
        printf("# patch test: inner forces %.1e of the largest, %.3g N\n", inner / max, max);
        ck_assert_double_le(inner, 1e-12 * max);
        ck_assert_double_gt(max, 1);
    }
}

/* F = R S with a rotation R out of the plane: strains are of S - I alone, stresses C times them. */
UNIT_TEST(strain_of_an_affine_map)
{
    const double suu = 1.05, suv = 0.03, svv = 0.97, c = 0.6, d = 0.8;
    const phys_vec ru = {c, d, 0, 0}, rv = {0, 0, 1, 0};
    const phys_vec fu = suu * ru + suv * rv, fv = suv * ru + svv * rv;
    const double half = 0.5 * (suu - svv), mean = 0.5 * (suu + svv) - 1;
    const double want = mean + sqrt(half * half + suv * suv);
    const double c22 = WEFT / (1 - POISSON * POISSON * WEFT / WARP), c12 = POISSON * c22;
    const double c11 = WARP / (1 - POISSON * POISSON * WEFT / WARP);
    struct sheet s;
    struct elements_state state;
    double largest[TRIANGLES], again[TRIANGLES], stress[TRIANGLES][3];
    make_sheet(&s, 0.1);
    place(&s, &fu, &fv, &state);
    const struct phys_sight sight = {.n = VERTICES, .x = state.x};
    phys_triangles_strain(&s.triangles, &sight, largest, stress);
    phys_triangles_strain(&s.triangles, &sight, again, NULL);
    ck_assert_mem_eq(largest, again, sizeof again);
    for (int t = 0; t < TRIANGLES; t++) {
        ck_assert_double_eq_tol(largest[t], want, 1e-13);
        ck_assert_double_eq_tol(stress[t][0], c11 * (suu - 1) + c12 * (svv - 1), 1e-10);
        ck_assert_double_eq_tol(stress[t][1], c12 * (suu - 1) + c22 * (svv - 1), 1e-10);
        ck_assert_double_eq_tol(stress[t][2], 2 * SHEAR * suv, 1e-10);
    }
}

/* Sum of the forces on the vertices of the right edge (u largest), or of the upper one. */
static void pull(const phys_vec *f, int upper, phys_vec *sum)
{
    *sum = (phys_vec){0};
    for (int i = 0; i < VERTICES; i++)
        if (upper ? i / NX == NY - 1 : i % NX == NX - 1)
            *sum += f[i];
}

UNIT_TEST(uniaxial_stretch)
{
    const double e = 0.08, nu21 = POISSON * WEFT / WARP, width = 0.4 * (NX - 1),
                 height = 0.3 * (NY - 1);
    for (int along = 0; along < 2; along++) {
        const phys_vec fu = {along ? 1 - nu21 * e : 1 + e, 0, 0, 0};
        const phys_vec fv = {0, along ? 1 + e : 1 - POISSON * e, 0, 0};
        struct sheet s;
        struct elements_state state;
        phys_vec f[VERTICES], right, up;
        make_sheet(&s, 0);
        place(&s, &fu, &fv, &state);
        forces(&s, &state, f);
        pull(f, 0, &right);
        pull(f, 1, &up);
        ck_assert_double_eq_tol(right[0], along ? 0 : -WARP * e * height, 1e-12);
        ck_assert_double_eq_tol(up[1], along ? -WEFT * e * width : 0, 1e-12);
        const double error =
            along ? -up[1] / (WEFT * e * width) - 1 : -right[0] / (WARP * e * height) - 1;
        printf(
            "# stretched by %g along the %s at its own width: force off by %.1e, across %.1e N\n",
            e, along ? "weft" : "warp", fabs(error), fabs(along ? right[0] : up[1]));
        ck_assert_double_eq_tol(right[1], 0, 1e-12);
        ck_assert_double_eq_tol(up[0], 0, 1e-12);
    }
}

UNIT_TEST(pure_shear)
{
    const double angle = 0.06, height = 0.3 * (NY - 1);
    const phys_vec fu = {1, angle / 2, 0, 0}, fv = {angle / 2, 1, 0, 0};
    struct sheet s;
    struct elements_state state;
    phys_vec f[VERTICES], right;
    make_sheet(&s, 0);
    place(&s, &fu, &fv, &state);
    forces(&s, &state, f);
    pull(f, 0, &right);
    printf("# pure shear by %g: force off by %.1e\n", angle,
           fabs(-right[1] / (SHEAR * angle * height) - 1));
    ck_assert_double_eq_tol(right[1], -SHEAR * angle * height, 1e-12);
    ck_assert_double_eq_tol(right[0], 0, 1e-12);
}

/* Stretched in a direction that is neither warp nor weft, the papers' forces turn the sheet. */
UNIT_TEST(uncorrected_forces_leave_their_torque)
{
    struct sheet s;
    struct elements_state state;
    phys_vec f[VERTICES];
    double torque[3] = {0}, sum[3] = {0};
    make_sheet(&s, 0);
    shaken(&s, 0.05, &state);
    s.membrane[0].uncorrected = s.membrane[1].uncorrected = 1;
    forces(&s, &state, f);
    for (int i = 0; i < VERTICES; i++)
        for (int c = 0; c < 3; c++) {
            const int a = (c + 1) % 3, b = (c + 2) % 3;
            sum[c] += state.x[i][a] * f[i][b] - state.x[i][b] * f[i][a];
        }
    const struct phys_sight sight = {VERTICES, state.x, state.v, NULL, NULL};
    phys_triangles_torque(&s.triangles, &sight, torque);
    double size = 0;
    for (int c = 0; c < 3; c++) {
        ck_assert_double_eq_tol(sum[c], torque[c], 1e-12);
        size = fmax(size, fabs(torque[c]));
    }
    ck_assert_double_gt(size, 1e-2);
    memset(torque, 0, sizeof torque);
    s.membrane[0].uncorrected = s.membrane[1].uncorrected = 0;
    phys_triangles_torque(&s.triangles, &sight, torque);
    for (int c = 0; c < 3; c++)
        ck_assert_double_eq(torque[c], 0);
}

UNIT_TEST(collapsed_triangles_stay_finite)
{
    static const phys_vec map[][2] = {{{1, 0, 0, 0}, {0.5, 0, 0, 0}}, {{0}, {0}}};
    for (int m = 0; m < 2; m++) {
        const struct phys_step step[2] = {{0.1, 0}, {0.1, 1}};
        struct sheet s;
        struct elements_state state;
        phys_vec f[VERTICES];
        struct phys_pair pair[3 * TRIANGLES];
        make_sheet(&s, 0.1);
        place(&s, map[m], map[m] + 1, &state);
        forces(&s, &state, f);
        const struct phys_sight sight = {VERTICES, state.x, state.v, NULL, NULL};
        for (int full = 0; full < 2; full++) {
            phys_triangles_matrix(&s.triangles, 0, TRIANGLES, step + full, &sight, NULL, pair);
            for (int i = 0; i < 3 * TRIANGLES; i++)
                for (int c = 0; c < 12; c++)
                    ck_assert(isfinite(pair[i].cyclic[c / 4][c % 4]));
        }
        for (int i = 0; i < 4 * VERTICES; i++)
            ck_assert(isfinite(f[i / 4][i % 4]));
    }
}

UNIT_TEST(impossible_values_are_refused)
{
    static const double bad[][5] = {{-1, 1, 1, 0, 0},   {1, -1, 1, 0, 0},       {1, 1, -1, 0, 0},
                                    {NAN, 1, 1, 0, 0},  {1, 1, INFINITY, 0, 0}, {1, 1, 1, 1, 0},
                                    {1, 4, 1, 0.5, 0},  {1, 1, 1, NAN, 0},      {0, 1, 1, 0.1, 0},
                                    {1, 1, 1, 0.2, -1}, {1, 1, 1, 0.2, NAN}};
    const double line[6] = {0, 0, 1, 1, 2, 2}, point[6] = {0};
    struct phys_membrane m;
    double gradient[4], area;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        ck_assert_int_eq(
            phys_membrane_make(bad[i][0], bad[i][1], bad[i][2], bad[i][3], bad[i][4], &m), -1);
    ck_assert_int_eq(phys_membrane_make(1, 3.9, 1, 0.5, 0, &m), 0);
    ck_assert_int_eq(phys_membrane_make(0, 0, 1, 0, 0, &m), 0);
    ck_assert_int_eq(phys_triangle_rest(line, gradient, &area), -1);
    ck_assert_int_eq(phys_triangle_rest(point, gradient, &area), -1);
}
