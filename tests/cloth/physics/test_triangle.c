/* Triangles against closed forms of a membrane, and what they have beyond what tests/cloth/element
 * says of every kind. */
#include "cloth/physics/triangle.h"
#include "tests/cloth/physics/elements.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- A sheet ---- */

static const double WARP = 1000, WEFT = 300, SHEAR = 50, POISSON = 0.4;

/* A rectangle of 4 x 4 vertices in the u-v plane, inner ones displaced, and its triangles. */
enum { NX = 4, NY = 4, VERTICES = NX * NY, TRIANGLES = 2 * (NX - 1) * (NY - 1) };

struct sheet {
    double uv[VERTICES][2];
    uint32_t corner[TRIANGLES][4];
    phys_vec gradient[TRIANGLES];
    double area[TRIANGLES];
    struct phys_membrane membrane[2];
    struct phys_elements triangles;
};

static int is_inner(int i)
{
    return i % NX > 0 && i % NX < NX - 1 && i / NX > 0 && i / NX < NY - 1;
}

static void make_sheet(struct sheet *s, double damping)
{
    static const double shift[][2] = {{0.11, -0.07}, {-0.09, 0.13}, {0.05, 0.08}, {-0.12, -0.03}};
    int inner = 0;
    for (int i = 0; i < VERTICES; i++) {
        s->uv[i][0] = 0.4 * (i % NX);
        s->uv[i][1] = 0.3 * (i / NX);
        for (int c = 0; is_inner(i) && c < 2; c++)
            s->uv[i][c] += shift[inner][c];
        inner += is_inner(i);
    }
    uint32_t t = 0;
    for (uint32_t j = 0; j + 1 < NY; j++)
        for (uint32_t i = 0; i + 1 < NX; i++) {
            const uint32_t a = j * NX + i, b = a + 1, c = a + NX, d = c + 1;
            memcpy(s->corner[t], ((uint32_t[]){a, b, d, t % 2}), sizeof s->corner[t]);
            t++;
            memcpy(s->corner[t], ((uint32_t[]){d, c, a, 0}), sizeof s->corner[t]);
            t++;
        }
    ck_assert_int_eq(phys_membrane_make(WARP, WEFT, SHEAR, POISSON, damping, s->membrane), 0);
    s->membrane[1] = s->membrane[0];
    for (t = 0; t < TRIANGLES; t++) {
        double uv[6], gradient[4];
        for (int k = 0; k < 3; k++)
            memcpy(uv + 2 * k, s->uv[s->corner[t][k]], 2 * sizeof *uv);
        ck_assert_int_eq(phys_triangle_rest(uv, gradient, s->area + t), 0);
        s->gradient[t] = (phys_vec){gradient[0], gradient[1], gradient[2], gradient[3]};
    }
    s->triangles = (struct phys_elements){.n = TRIANGLES,
                                          .corner = s->corner,
                                          .vector = s->gradient,
                                          .number = {[PHYS_TRIANGLE_AREA] = s->area},
                                          .material = s->membrane};
}

/* The sheet under the map (u, v) -> fu u + fv v. */
static void place(const struct sheet *s, const phys_vec *fu, const phys_vec *fv,
                  struct elements_state *state)
{
    *state = (struct elements_state){.n = VERTICES};
    for (int i = 0; i < VERTICES; i++)
        state->x[i] = s->uv[i][0] * *fu + s->uv[i][1] * *fv;
}

static void forces(const struct sheet *s, const struct elements_state *state, phys_vec *f)
{
    const struct phys_sight sight = {VERTICES, state->x, state->v, NULL, NULL};
    memset(f, 0, VERTICES * sizeof *f);
    phys_triangles_force(&s->triangles, NULL, &sight, f);
}

static void stiffness(const void *of, int full, double scale, const struct phys_sight *sight,
                      phys_vec *y)
{
    const struct phys_step step = {sqrt(scale), full};
    struct phys_pair pair[3 * TRIANGLES];
    phys_triangles_system(of, 0, TRIANGLES, &step, 0, sight, NULL, y, pair);
}
static void matrix(const void *of, const struct phys_step *step, const struct phys_sight *sight,
                   struct phys_pair *pair)
{
    const struct phys_elements *t = of;
    phys_triangles_matrix(t, 0, 5, step, sight, NULL,
                          pair); /* in two parts, neither a multiple of 4 */
    phys_triangles_matrix(t, 5, t->n, step, sight, NULL, pair + 15);
}

/* Bent, stretched and shaken. */
static void shaken(const struct sheet *s, double size, struct elements_state *state)
{
    const phys_vec fu = {0.9, 0.3, 0.2, 0}, fv = {-0.2, 1.1, 0.3, 0};
    place(s, &fu, &fv, state);
    elements_shake(state, size, 7);
}

/* ---- Systems ---- */

/* All of it at once, in two parts: the matrix to the bit, push times the force, h^2 K v; pairs
 * turned where that is wanted. */
UNIT_LOOP(system_is_force_stiffness_and_matrix, 0, 2)
{
    const struct phys_step step = {0.3, _i};
    const double push = 0.7;
    uint32_t at[3 * TRIANGLES];
    struct sheet s;
    struct elements_state state;
    struct phys_pair pair[3 * TRIANGLES], both[3 * TRIANGLES];
    phys_vec f[VERTICES] = {{0}}, y[VERTICES] = {{0}}, b[VERTICES] = {{0}};
    make_sheet(&s, 0.1);
    shaken(&s, 0.05, &state);
    s.membrane[1].uncorrected = 1;
    const struct phys_sight sight = {VERTICES, state.x, state.v, NULL, NULL};
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++)
        at[i] = 2 * i + (i % 7 < 3);
    matrix(&s.triangles, &step, &sight, pair);
    forces(&s, &state, f);
    stiffness(&s.triangles, _i, 0.3 * 0.3, &sight, y);
    phys_triangles_system(&s.triangles, 0, 6, &step, push, &sight, at, b, both);
    phys_triangles_system(&s.triangles, 6, TRIANGLES, &step, push, &sight, at + 18, b, both + 18);
    for (int i = 0; i < 3 * TRIANGLES; i++)
        for (int c = 0; c < 9; c++) {
            const int row = c % 3, k = c / 3, column = (row + k) % 3;
            const double n =
                at[i] & 1 ? pair[i].cyclic[(3 - k) % 3][column] : pair[i].cyclic[k][row];
            ck_assert_double_eq_tol(both[i].cyclic[k][row], n, at[i] & 1 ? 1e-12 : 1e-300);
        }
    for (int i = 0; i < VERTICES; i++)
        for (int c = 0; c < 4; c++)
            ck_assert_double_eq_tol(b[i][c], push * f[i][c] + y[i][c], 1e-11);
}

/* At rest the reduced matrix leaves nothing out. */
UNIT_TEST(reduced_is_full_at_rest)
{
    const phys_vec fu = {1, 0, 0, 0}, fv = {0, 0, 1, 0};
    const struct phys_step reduced = {0.1, 0}, full = {0.1, 1};
    struct sheet s;
    struct elements_state state;
    struct phys_pair a[3 * TRIANGLES], b[3 * TRIANGLES];
    make_sheet(&s, 0.2);
    place(&s, &fu, &fv, &state);
    const struct phys_sight sight = {VERTICES, state.x, state.v, NULL, NULL};
    phys_triangles_matrix(&s.triangles, 0, TRIANGLES, &reduced, &sight, NULL, a);
    phys_triangles_matrix(&s.triangles, 0, TRIANGLES, &full, &sight, NULL, b);
    for (int i = 0; i < 3 * TRIANGLES; i++)
        for (int c = 0; c < 3; c++)
            for (int r = 0; r < 3; r++)
                ck_assert_double_eq_tol(a[i].cyclic[c][r], b[i].cyclic[c][r], 1e-12);
}

/* n.K n of moves along the normal of a sheet that is stretched flat. */
static double across(const struct sheet *s, const phys_vec *fu, const phys_vec *fv, int full,
                     unsigned seed)
{
    struct elements_state state;
    phys_vec y[VERTICES] = {{0}};
    double sum = 0;
    place(s, fu, fv, &state);
    elements_shake(&state, 0, seed);
    for (int i = 0; i < VERTICES; i++)
        state.v[i] = (phys_vec){0, 0, state.v[i][2], 0};
    const struct phys_sight sight = {VERTICES, state.x, state.v, NULL, NULL};
    stiffness(&s->triangles, full, 1, &sight, y);
    for (int i = 0; i < VERTICES; i++)
        sum -= y[i][2] * state.v[i][2];
    return sum;
}

/* Tension resists moves across the sheet as it does; compression, which gives way to them, does
 * nothing; one of each, in part. */
UNIT_TEST(moves_across_the_sheet)
{
    const phys_vec longer[2] = {{1.1, 0.02, 0, 0}, {0.02, 1.2, 0, 0}};
    const phys_vec shorter[2] = {{0.9, 0.02, 0, 0}, {0.02, 0.8, 0, 0}};
    const phys_vec mixed[2] = {{1.2, 0.02, 0, 0}, {0.02, 0.7, 0, 0}};
    struct sheet s;
    make_sheet(&s, 0);
    for (unsigned seed = 1; seed < 9; seed++) {
        const double whole = across(&s, longer, longer + 1, 1, seed);
        ck_assert_double_gt(whole, 1);
        ck_assert_double_eq_tol(across(&s, longer, longer + 1, 0, seed), whole, 1e-12 * whole);
        ck_assert_double_lt(across(&s, shorter, shorter + 1, 1, seed), -1);
        ck_assert_double_eq(across(&s, shorter, shorter + 1, 0, seed), 0);
        const double part = across(&s, mixed, mixed + 1, 0, seed);
        ck_assert_double_gt(part, 0);
        ck_assert_double_gt(part, 1 + across(&s, mixed, mixed + 1, 1, seed));
    }
}

/* ---- Closed forms ---- */

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

/* Threads that stiffen (the warp), and soften (the weft), follow their curves to the last bits, at
 * their own width; the energy is the area below. */
static const double knots[2][3][2] = {{{0.01, 10}, {0.05, 90}, {0.1, 400}},
                                      {{0.02, 6}, {0.06, 15}, {0.09, 18}}};

static double on_curve(int along, double e, double *energy)
{
    double strain = 0, stress = 0, slope = 0;
    *energy = 0;
    for (int i = 0; i < 3; i++) {
        const double *to = knots[along][i];
        slope = (to[1] - stress) / (to[0] - strain);
        if (e <= to[0] || i == 2)
            break;
        *energy += 0.5 * (to[1] + stress) * (to[0] - strain);
        strain = to[0];
        stress = to[1];
    }
    *energy += (stress + 0.5 * slope * (e - strain)) * (e - strain);
    return stress + slope * (e - strain);
}

static void make_curved(struct sheet *s, double nu)
{
    struct phys_stiffening stiffening = {0};
    double modulus[2];
    make_sheet(s, 0);
    for (int d = 0; d < 2; d++)
        ck_assert_uint_eq(phys_stiffening_make(3, knots[d], d, &stiffening, modulus + d), 3);
    phys_membrane_make(modulus[0], modulus[1], SHEAR, nu, 0, s->membrane);
    ck_assert_int_eq(phys_membrane_stiffen(s->membrane, &stiffening), 0);
    s->membrane[1] = s->membrane[0];
}

UNIT_TEST(uniaxial_stretch_by_a_curve)
{
    static const double strain[] = {0.005, 0.03, 0.07, 0.2};
    const double nu = 0.2, nu21 = nu * 300 / 1000, side[2] = {0.3 * (NY - 1), 0.4 * (NX - 1)};
    for (int along = 0; along < 2; along++)
        for (size_t i = 0; i < sizeof strain / sizeof *strain; i++) {
            const double e = strain[i];
            struct sheet s;
            struct elements_state state;
            phys_vec f[VERTICES], force;
            double area;
            make_curved(&s, nu);
            const double stress = on_curve(along, e, &area);
            const double across = -(along ? nu21 : nu) * e;
            const phys_vec fu = {1 + (along ? across : e), 0, 0, 0};
            const phys_vec fv = {0, 1 + (along ? e : across), 0, 0};
            place(&s, &fu, &fv, &state);
            forces(&s, &state, f);
            pull(f, along, &force);
            ck_assert_double_eq_tol(force[along], -stress * side[along], 1e-10);
            const struct phys_sight sight = {VERTICES, state.x, state.v, NULL, NULL};
            ck_assert_double_eq_tol(phys_triangles_energy(&s.triangles, &sight),
                                    area * side[0] * side[1], 1e-10);
        }
}

/* Curves that go back or down, and a Poisson ratio that soft threads cannot bear. */
UNIT_TEST(curves_that_are_none)
{
    const double back[2][2] = {{0.02, 5}, {0.02, 6}}, down[2][2] = {{0.01, 5}, {0.02, 5}};
    const struct phys_stiffening soft = {{{0.1}, {0.1}}, {{-990}, {-297}}};
    struct phys_stiffening stiffening;
    struct phys_membrane membrane;
    double modulus;
    ck_assert_uint_eq(phys_stiffening_make(2, back, 0, &stiffening, &modulus), 1);
    ck_assert_uint_eq(phys_stiffening_make(2, down, 0, &stiffening, &modulus), 1);
    phys_membrane_make(WARP, WEFT, SHEAR, POISSON, 0, &membrane);
    ck_assert_int_eq(phys_membrane_stiffen(&membrane, &soft), -1);
    phys_membrane_make(WARP, WEFT, SHEAR, 0, 0, &membrane);
    ck_assert_int_eq(phys_membrane_stiffen(&membrane, &soft), 0);
    ck_assert(membrane.curved);
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
