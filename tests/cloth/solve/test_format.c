/* Every format of a matrix against the dense matrix of the same entries, rounded as they are: the
 * product of blocks, its symmetry, what moves as a whole, and the sum of the residual. */
#include "cloth/solve/assemble.h"
#include "tests/cloth/solve/system.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct system sys;

static void make(int format, uint32_t n_blocks, int hold, double stiffness)
{
    srand(21);
    sys.format = (enum solve_format)format;
    system_sheet(&sys, 8, 7, stiffness);
    system_turn(&sys, 0.3 * stiffness);
    for (uint32_t a = 0; a < sys.n && hold; a++)
        sys.free[a] = rand() % hold != 0;
    system_cut(&sys, n_blocks);
}

/* q = S A p by a pass over each block that leaves r and makes p of r. */
static void multiply(const phys_vec *x, phys_vec *q)
{
    for (uint32_t b = 0; b < sys.n_blocks; b++) {
        const struct system_block *block = sys.block + b;
        phys_vec dv[SYSTEM_ROWS] = {{0}}, r[SYSTEM_ROWS], p[SYSTEM_ROWS] = {{0}};
        phys_vec ghosts[SYSTEM_SPRINGS];
        const struct solve_rows rows = solve_rows_plain(dv, r, p, q + block->first);
        double dots[SOLVE_DOTS];
        memcpy(r, x + block->first, block->matrix.n * sizeof *r);
        memset(q + block->first, 0, block->matrix.n * sizeof *q);
        for (uint32_t i = 0; i < block->n_ghosts; i++)
            ghosts[i] = x[block->ghost[i]];
        solve_pass(&block->matrix, &block->cut, block->value, ghosts, 0, 0, &rows, dots);
    }
}

UNIT_LOOP(product_is_that_of_the_dense_matrix, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    for (uint32_t n_blocks = 1; n_blocks <= 5; n_blocks += 2)
        for (int hold = 0; hold < 10; hold += 5) {
            phys_vec x[SYSTEM_ROWS], y[SYSTEM_ROWS], q[SYSTEM_ROWS];
            make(_i, n_blocks, hold, 20);
            system_draw_rows(&sys, x);
            system_multiply(&sys, x, y);
            multiply(x, q);
            for (uint32_t a = 0; a < sys.n; a++)
                for (int c = 0; c < 4; c++)
                    ck_assert_double_eq_tol(q[a][c], y[a][c], 2e-13);
        }
}

UNIT_LOOP(product_is_symmetric, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    phys_vec x[SYSTEM_ROWS], y[SYSTEM_ROWS], ax[SYSTEM_ROWS], ay[SYSTEM_ROWS];
    make(_i, 4, 5, 1e4);
    for (int k = 0; k < 20; k++) {
        system_draw_rows(&sys, x);
        system_draw_rows(&sys, y);
        multiply(x, ax);
        multiply(y, ay);
        const double size = system_dot(&sys, x, ax) + system_dot(&sys, y, ay);
        ck_assert_double_eq_tol(system_dot(&sys, x, ay), system_dot(&sys, y, ax), 1e-14 * size);
    }
}

/* The sum over A v is that over M v, to 1e-14 of the sum of all |A_ij v_j|. */
UNIT_LOOP(what_moves_as_a_whole_keeps_its_momentum, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    static const double stiffness[] = {1e-3, 1, 1e3, 1e9};
    for (int k = 0; k < 4; k++) {
        phys_vec v[SYSTEM_ROWS], q[SYSTEM_ROWS], left = {0};
        double size = 0;
        make(_i, 3, 0, stiffness[k]);
        for (uint32_t a = 0; a < sys.n; a++)
            v[a] = (phys_vec){0.3, -0.7, 0.9, 0};
        multiply(v, q);
        for (uint32_t a = 0; a < sys.n; a++)
            left += q[a] - sys.diagonal[a] * v[a];
        for (uint32_t i = 0; i < 3 * sys.n; i++)
            for (uint32_t j = 0; j < 3 * sys.n; j++)
                size += fabs(sys.dense[i][j] * v[j / 3][j % 3]);
        for (int c = 0; c < 3; c++)
            ck_assert_double_le(fabs(left[c]), 1e-14 * size);
    }
}

/* A block's entries between a free row here and a held one, each by its free row. */
static uint32_t find_held(const struct system_block *block, uint32_t (*held)[2])
{
    const struct solve_block *m = &block->matrix;
    uint32_t n = 0;
    for (uint32_t a = 0; a < m->n; a++)
        for (uint32_t i = m->row[a]; i < m->row[a + 1]; i++)
            if (m->free[a] + m->free[m->column[i]] == 1) {
                held[n][0] = m->free[a] > 0 ? a : m->column[i];
                held[n++][1] = i;
            }
    for (uint32_t i = 0; i < block->cut.n; i++)
        if (m->free[block->end[i][0]] > 0 && sys.free[block->ghost[block->end[i][1]]] <= 0) {
            held[n][0] = block->end[i][0];
            held[n++][1] = m->row[m->n] + i;
        }
    return n;
}

UNIT_LOOP(lost_is_the_sum_of_the_residual, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    phys_vec dv[SYSTEM_ROWS], b[SYSTEM_ROWS], q[SYSTEM_ROWS], sum = {0};
    double lost[3] = {0};
    make(_i, 3, 5, 20);
    system_draw_rows(&sys, dv);
    system_draw_rows(&sys, b);
    multiply(dv, q);
    for (uint32_t a = 0; a < sys.n; a++)
        sum += sys.free[a] * b[a] - q[a];
    for (uint32_t k = 0; k < sys.n_blocks; k++) {
        const struct system_block *block = sys.block + k;
        uint32_t at[2 * SYSTEM_SPRINGS][2];
        const struct solve_held held = {find_held(block, at), (const uint32_t(*)[2])at};
        solve_lost(&block->matrix, &held, block->value, b + block->first, dv + block->first, lost);
    }
    for (int c = 0; c < 3; c++) {
        ck_assert_double_gt(fabs(sum[c]), 1e-3);
        ck_assert_double_eq_tol(lost[c], sum[c], 1e-12);
    }
}

/* Pairs of elements, as who makes them was told to turn them, add what they are; those of others
 * nothing. */
UNIT_TEST(pairs_of_elements)
{
    const struct phys_pair pair[3] = {{{{1, 5, 9, 0}, {2, 6, 7, 0}, {3, 4, 8, 0}}},
                                      {{{9, 9, 9, 0}, {9, 9, 9, 0}, {9, 9, 9, 0}}},
                                      {{{1, 5, 9, 0}, {4, 8, 3, 0}, {7, 2, 6, 0}}}};
    const uint32_t at[3] = {2, SOLVE_NO_ENTRY, 1};
    const double n[3][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    struct phys_pair sums[2] = {{{{0}}}}, expected[2] = {{{{0}}}};
    solve_assemble_pairs(3, at, pair, sums);
    system_assemble(expected, true, n);
    system_assemble(expected + 1, false, n);
    for (int k = 0; k < 24; k++)
        ck_assert_double_eq(sums[k / 12].cyclic[k / 4 % 3][k % 4],
                            expected[k / 12].cyclic[k / 4 % 3][k % 4]);
}

/* Turned or not, from either side, nine numbers are the same ones. */
UNIT_TEST(assembly_from_both_sides)
{
    const double n[3][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    const double here[SOLVE_NINE] = {1, 5, 9, 2, 6, 7, 3, 4, 8};
    const double there[SOLVE_NINE] = {1, 5, 9, 4, 8, 3, 7, 2, 6};
    struct phys_pair sum = {{{0}}};
    system_assemble(&sum, false, n);
    for (int k = 0; k < SOLVE_NINE; k++)
        ck_assert_double_eq(sum.cyclic[k / 3][k % 3], here[k]);
    memset(&sum, 0, sizeof sum);
    system_assemble(&sum, true, n);
    for (int k = 0; k < SOLVE_NINE; k++)
        ck_assert_double_eq(sum.cyclic[k / 3][k % 3], there[k]);
    const phys_vec d = {1, -2, 0.5, 0};
    phys_vec y, transposed;
    double memory[SOLVE_NINE + 1] = {0};
    memcpy(memory, here, sizeof here);
    solve_entry_times(SOLVE_HALF, memory, 0, &d, &y, &transposed);
    for (int c = 0; c < 3; c++) {
        ck_assert_double_eq(y[c], n[c][0] - 2 * n[c][1] + 0.5 * n[c][2]);
        ck_assert_double_eq(transposed[c], n[0][c] - 2 * n[1][c] + 0.5 * n[2][c]);
    }
}
