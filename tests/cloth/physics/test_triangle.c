/* What triangles have beyond what tests/cloth/element says of every kind. */
#include "tests/cloth/physics/triangle_sheet.h"

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
