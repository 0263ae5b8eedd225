/* The coarse part of a preconditioner: its matrix is P' A P, its correction a projection on what P
 * spans, patterns have all the fill, and columns that add nothing are left out. */
#include "tests/cloth/solve/two_level.h"
#include "tests/support/unit.h"

#include <stdlib.h>
#include <string.h>

static struct system sys;
static struct two_level level;

/* Column i of P of a block, over all rows. */
static void column_of(uint32_t b, int i, phys_vec *y)
{
    const struct system_block *block = sys.block + b;
    double x[SOLVE_COARSE] = {0};
    x[i] = 1;
    memset(y, 0, sys.n * sizeof *y);
    solve_prolong(block->matrix.n, level.basis + block->first, x, y + block->first);
}

static void make_sheet(uint32_t nx, uint32_t ny, uint32_t n_blocks, int hold)
{
    system_sheet(&sys, nx, ny, 20);
    system_turn(&sys, 2);
    for (uint32_t a = 0; a < sys.n && hold; a++)
        sys.free[a] = rand() % hold != 0;
    if (sys.filtered)
        system_filter(&sys, false);
    system_cut(&sys, n_blocks);
    two_level_make(&level, &sys);
}

static void check_coupling(uint32_t b, uint32_t other, const double *matrix)
{
    phys_vec column[SYSTEM_ROWS], product[SYSTEM_ROWS], row[SYSTEM_ROWS];
    for (int j = 0; j < SOLVE_COARSE; j++) {
        column_of(other, j, column);
        system_multiply(&sys, column, product);
        for (int i = 0; i < SOLVE_COARSE; i++) {
            column_of(b, i, row);
            ck_assert_double_eq_tol(matrix[SOLVE_COARSE * i + j], system_dot(&sys, row, product),
                                    1e-10);
        }
    }
}

UNIT_LOOP(matrix_is_of_the_filtered_system, 0, 6)
{
    srand(1);
    sys.format = (enum solve_format)(_i % 3);
    sys.filtered = _i > 2;
    for (int hold = 0; hold < 9; hold += 4) {
        make_sheet(8, 8, 5, hold);
        for (uint32_t b = 0; b < sys.n_blocks; b++) {
            check_coupling(b, b, level.coupling[b][0]);
            uint32_t later = 1;
            for (uint32_t s = level.first[b]; s < level.first[b + 1]; s++)
                if (level.neighbour[s] > b)
                    check_coupling(b, level.neighbour[s], level.coupling[b][later++]);
        }
        two_level_free(&level);
    }
}

/* P C^-1 P' A of anything that P spans is that: rigid motion and motion that is affine in u and v.
 */
UNIT_LOOP(what_it_spans_is_solved_at_once, 0, 6)
{
    srand(2);
    sys.format = (enum solve_format)(_i % 3);
    sys.filtered = _i > 2;
    for (uint32_t n_blocks = 1; n_blocks <= SYSTEM_BLOCKS; n_blocks++) {
        make_sheet(8, 8, n_blocks, n_blocks % 2 ? 6 : 0);
        phys_vec x[SYSTEM_ROWS] = {{0}}, y[SYSTEM_ROWS], back[SYSTEM_ROWS] = {{0}};
        for (uint32_t b = 0; b < n_blocks; b++) {
            const struct system_block *block = sys.block + b;
            double c[SOLVE_COARSE];
            for (int i = 0; i < SOLVE_COARSE; i++)
                c[i] = system_draw();
            solve_prolong(block->matrix.n, level.basis + block->first, c, x + block->first);
        }
        system_multiply(&sys, x, y);
        two_level_add(&level, y, back);
        for (uint32_t a = 0; a < sys.n; a++)
            for (int i = 0; i < 3; i++)
                ck_assert_double_eq_tol(back[a][i], x[a][i], 1e-4); /* T is in float */
        ck_assert(level.dropped == 0 || sys.filtered); /* few rows may be left of a block's */
        two_level_free(&level);
    }
}

UNIT_TEST(basis_has_every_affine_motion_of_a_flat_block)
{
    enum { ROWS = 30 };
    phys_vec position[ROWS], basis[ROWS];
    double free[ROWS], square[3] = {0}, mixed = 0;
    srand(3);
    for (int a = 0; a < ROWS; a++) { /* in a plane that lies askew */
        const double u = 3 * system_draw() + 7, v = system_draw();
        position[a] = (phys_vec){1 + 0.6 * u - 0.48 * v, 0.8 * u + 0.36 * v - 5, 0.8 * v + 2, 0};
        free[a] = a != 11;
    }
    solve_basis(ROWS, free, position, basis);
    for (int a = 0; a < ROWS; a++) {
        const bool held = a == 11;
        ck_assert(basis[a][0] == (held ? 0 : 1) && basis[a][3] == 0);
        ck_assert(!held || (basis[a][1] == 0 && basis[a][2] == 0));
        square[1] += basis[a][1] * basis[a][1];
        square[2] += basis[a][2] * basis[a][2];
        mixed += basis[a][1] * basis[a][2];
    }
    ck_assert_double_eq_tol(square[1], ROWS, 5);
    ck_assert_double_eq_tol(square[2], ROWS, 5);
    ck_assert_double_eq_tol(mixed, 0, 5);
    /* Distances in the plane are those of u and v, each by its own scale. */
    const phys_vec d = position[0] - position[1], e = position[2] - position[3];
    const phys_vec s = basis[0] - basis[1], t = basis[2] - basis[3];
    const phys_vec f = position[4] - position[5], w = basis[4] - basis[5];
    const double m = s[1] * s[1] * t[2] * t[2] - t[1] * t[1] * s[2] * s[2];
    const double p = (phys_dot(&d, &d) * t[2] * t[2] - phys_dot(&e, &e) * s[2] * s[2]) / m;
    const double q = (phys_dot(&e, &e) * s[1] * s[1] - phys_dot(&d, &d) * t[1] * t[1]) / m;
    ck_assert_double_eq_tol(p * w[1] * w[1] + q * w[2] * w[2], phys_dot(&f, &f), 1e-8);
}

/* A block that is held gives nine; a line of vertices has no v, a point neither u nor v. */
UNIT_TEST(columns_that_add_nothing)
{
    srand(4);
    system_sheet(&sys, 8, 8, 20);
    for (uint32_t a = 16; a < 32; a++)
        sys.free[a] = 0;
    for (uint32_t a = 0; a < 8; a++) {
        sys.position[a] = (phys_vec){0.3 * a, 0.4 * a, 0, 0};
        sys.free[a + 8] = 0;
    }
    system_cut(&sys, 4);
    for (uint32_t a = 8; a < 16; a++) /* held rows of block 0, where they do not widen it */
        sys.block[0].position[a] = sys.position[a % 8];
    two_level_make(&level, &sys);
    ck_assert_uint_eq(level.dropped, 9 + 3);
    two_level_free(&level);
    system_chain(&sys, 8, 5);
    system_cut(&sys, 8);
    two_level_make(&level, &sys);
    ck_assert_uint_eq(level.dropped, 6 * 8);
    two_level_free(&level);
    for (uint32_t a = 0; a < sys.n; a++)
        sys.free[a] = 0;
    system_cut(&sys, 4);
    two_level_make(&level, &sys);
    ck_assert_uint_eq(level.dropped, 9 * 4);
    phys_vec y[SYSTEM_ROWS] = {{0}}, q[SYSTEM_ROWS] = {{0}};
    two_level_add(&level, q, y);
    for (uint32_t a = 0; a < sys.n; a++)
        ck_assert(y[a][0] == 0 && y[a][1] == 0 && y[a][2] == 0);
    two_level_free(&level);
}

/* ---- The sparse factor by itself ---- */

enum { BLOCKS = 70 };
static double coupling[BLOCKS][8][SOLVE_COUPLING];
static uint32_t first[BLOCKS + 1], neighbour[8 * BLOCKS];

/* A graph of blocks in which each meets some of those with near numbers, both ways. */
static void draw_graph(uint32_t n, int share)
{
    static bool meets[BLOCKS][BLOCKS];
    memset(meets, 0, sizeof meets);
    for (uint32_t a = 0; a < n; a++)
        for (uint32_t b = a + 1; b < n && b < a + 4; b++)
            meets[a][b] = meets[b][a] = rand() % 100 < share;
    uint32_t count = 0;
    for (uint32_t a = 0; a < n; a++) {
        for (uint32_t b = 0; b < n; b++)
            if (meets[a][b])
                neighbour[count++] = b;
        first[a + 1] = count;
    }
}

/* Random entries beside a heavy diagonal. */
static void draw_coupling(uint32_t n)
{
    for (uint32_t b = 0; b < n; b++)
        for (int k = 0; k < 8; k++)
            for (int i = 0; i < SOLVE_COARSE; i++)
                for (int j = 0; j <= i; j++) {
                    const double value = system_draw() + (k == 0 && i == j ? 60 : 0);
                    coupling[b][k][SOLVE_COARSE * i + j] = value;
                    coupling[b][k][SOLVE_COARSE * j + i] = k ? system_draw() : value;
                }
}

/* y += m x of two blocks, and the other way round. */
static void add_product(const double *m, uint32_t b, uint32_t other, const double *x, double *y)
{
    for (uint32_t i = 0; i < SOLVE_COARSE; i++)
        for (uint32_t j = 0; j < SOLVE_COARSE; j++) {
            const double value = m[SOLVE_COARSE * i + j];
            y[SOLVE_COARSE * b + i] += value * x[SOLVE_COARSE * other + j];
            if (other != b)
                y[SOLVE_COARSE * other + j] += value * x[SOLVE_COARSE * b + i];
        }
}

static void multiply(uint32_t n, const double *x, double *y)
{
    memset(y, 0, SOLVE_COARSE * n * sizeof *y);
    for (uint32_t b = 0; b < n; b++) {
        uint32_t later = 1;
        add_product(coupling[b][0], b, b, x, y);
        for (uint32_t s = first[b]; s < first[b + 1]; s++)
            if (neighbour[s] > b)
                add_product(coupling[b][later++], b, neighbour[s], x, y);
    }
}

static void check_factor(uint32_t n)
{
    static double x[SOLVE_COARSE * BLOCKS], y[SOLVE_COARSE * BLOCKS];
    static _Alignas(32) double back[SOLVE_COARSE_STRIDE * BLOCKS];
    struct solve_pattern pattern;
    UNIT_FINE(solve_pattern_make(&pattern, n, first, neighbour, &error));
    double *factor = aligned_alloc(32, solve_coarse_doubles(&pattern) * sizeof *factor);
    ck_assert(factor != NULL);
    for (uint32_t i = 0; i < SOLVE_COARSE * n; i++)
        x[i] = system_draw();
    multiply(n, x, y);
    memset(back, 0, sizeof back);
    solve_coarse_clear(&pattern, factor);
    for (uint32_t b = 0; b < n; b++) {
        solve_coarse_fill(&pattern, first, neighbour, b, coupling[b][0], factor);
        memcpy(back + solve_coarse_at(&pattern, b), y + SOLVE_COARSE * b, SOLVE_COARSE * sizeof *y);
    }
    ck_assert_uint_eq(solve_coarse_factor(&pattern, factor), 0);
    solve_coarse_solve(&pattern, factor, back);
    for (uint32_t i = 0; i < SOLVE_COARSE * n; i++)
        ck_assert_double_eq_tol(
            back[solve_coarse_at(&pattern, i / SOLVE_COARSE) + i % SOLVE_COARSE], x[i],
            1e-5); /* T is in float */
    solve_pattern_free(&pattern);
    free(factor);
}

UNIT_TEST(sparse_factor_of_every_graph)
{
    srand(5);
    static const uint32_t n[] = {1, 2, 3, 17, 64, 65, BLOCKS};
    for (size_t k = 0; k < sizeof n / sizeof *n; k++)
        for (int share = 0; share <= 100; share += 50) {
            draw_graph(n[k], share);
            draw_coupling(n[k]);
            check_factor(n[k]);
        }
}

/* The middle of a star goes last, so it has no fill. */
UNIT_TEST(least_degree_first)
{
    UNIT_OWNED(solve_pattern_free) struct solve_pattern pattern;
    uint32_t star_first[] = {0, 4, 5, 6, 7, 8}, star[] = {1, 2, 3, 4, 0, 0, 0, 0};
    UNIT_FINE(solve_pattern_make(&pattern, 5, star_first, star, &error));
    ck_assert_uint_eq(pattern.first[5], 4);
}
