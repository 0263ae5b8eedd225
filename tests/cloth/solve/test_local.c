/* Preconditioners of a block against its dense matrix: exact where there is no fill, symmetric and
 * positive definite on every system, held rows left alone, and what happens when pivots fail. */
#include "cloth/solve/local.h"
#include "tests/cloth/solve/system.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct system sys;
static _Alignas(32) double factor[8 * SYSTEM_ROWS + 12 * SYSTEM_SPRINGS];

static int make(enum solve_local kind)
{
    const struct system_block *b = sys.block;
    ck_assert_uint_le(solve_local_doubles(sys.n, sys.n_springs, kind),
                      sizeof factor / sizeof *factor);
    return solve_local_factor(&b->matrix, &b->cut, b->value, kind, factor);
}

static void apply(enum solve_local kind, const phys_vec *q, phys_vec *s)
{
    const double product = solve_local_apply(&sys.block[0].matrix, kind, factor, q, s);
    ck_assert_double_eq_tol(product, system_dot(&sys, q, s), 1e-12 * (1 + fabs(product)));
    for (uint32_t a = 0; a < sys.n; a++)
        ck_assert_double_eq(s[a][3], 0);
}

/* The accuracy of float in an incomplete factor. */
static const double FLOAT = 1e-6;

/* M^-1 A x = x to `tolerance` of the largest x. */
static void check_exact(enum solve_local kind, double tolerance)
{
    phys_vec x[SYSTEM_ROWS], y[SYSTEM_ROWS], s[SYSTEM_ROWS];
    ck_assert_int_eq(make(kind), 0);
    system_draw_rows(&sys, x);
    system_multiply(&sys, x, y);
    apply(kind, y, s);
    for (uint32_t a = 0; a < sys.n; a++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(s[a][c], x[a][c], tolerance);
}

/* A chain has no fill, with held rows anywhere. */
UNIT_LOOP(ic0_of_a_chain_is_exact, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    srand(1);
    sys.format = (enum solve_format)_i;
    for (uint32_t held = 0; held < 4; held++) {
        system_chain(&sys, 40, 30);
        for (uint32_t i = 0; i < held; i++)
            sys.free[13 * i] = 0;
        system_cut(&sys, 1);
        check_exact(SOLVE_IC0, FLOAT);
    }
}

/* So has a triangle, all of whose rows meet each other. */
UNIT_LOOP(ic0_of_a_triangle_is_exact, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    srand(2);
    sys.format = (enum solve_format)_i;
    system_sheet(&sys, 2, 2, 10);
    sys.n = 3;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < sys.n_springs; i++)
        if (sys.end[i][1] < 3) {
            sys.end[kept][0] = sys.end[i][0];
            sys.end[kept][1] = sys.end[i][1];
            sys.value[kept++] = sys.value[i];
        }
    sys.value[kept] = (phys_vec){2, -1, 0.5, 3};
    sys.end[kept][0] = 1;
    sys.end[kept++][1] = 2;
    sys.n_springs = kept;
    system_turn(&sys, 3);
    system_cut(&sys, 1);
    check_exact(SOLVE_IC0, FLOAT);
}

UNIT_LOOP(jacobi_inverts_the_diagonal, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    srand(3);
    sys.format = (enum solve_format)_i;
    system_sheet(&sys, 6, 5, 20);
    system_turn(&sys, 3);
    sys.free[7] = sys.free[29] = 0;
    system_cut(&sys, 1);
    for (uint32_t i = 0; i < 3 * sys.n; i++) /* what is not on it */
        for (uint32_t j = 0; j < 3 * sys.n; j++)
            if (i / 3 != j / 3)
                sys.dense[i][j] = 0;
    check_exact(SOLVE_JACOBI, 1e-12);
}

/* Springs into other blocks belong to the diagonal: block 0 of two is the dense matrix of its rows.
 */
UNIT_LOOP(cut_springs_are_on_the_diagonal, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    srand(4);
    sys.format = (enum solve_format)_i;
    system_chain(&sys, 30, 50);
    system_cut(&sys, 2);
    sys.n = 15;
    check_exact(SOLVE_IC0, FLOAT);
    system_chain(&sys, 30, 50);
    system_cut(&sys, 2);
    sys.n = 15;
    for (uint32_t i = 0; i < 3 * sys.n; i++)
        for (uint32_t j = 0; j < 3 * sys.n; j++)
            if (i / 3 != j / 3)
                sys.dense[i][j] = 0;
    check_exact(SOLVE_JACOBI, 1e-12);
}

static void check_symmetric(enum solve_local kind)
{
    phys_vec x[SYSTEM_ROWS], y[SYSTEM_ROWS], mx[SYSTEM_ROWS], my[SYSTEM_ROWS];
    for (int k = 0; k < 20; k++) {
        system_draw_rows(&sys, x);
        system_draw_rows(&sys, y);
        apply(kind, x, mx);
        apply(kind, y, my);
        const double left = system_dot(&sys, x, my), right = system_dot(&sys, y, mx);
        const double size = system_dot(&sys, x, mx) + system_dot(&sys, y, my);
        ck_assert_double_eq_tol(left, right, 1e-13 * size);
        ck_assert_double_gt(system_dot(&sys, x, mx), 0);
        for (uint32_t a = 0; a < sys.n; a++)
            ck_assert(sys.free[a] > 0 || (mx[a][0] == 0 && mx[a][1] == 0 && mx[a][2] == 0));
    }
}

UNIT_LOOP(symmetric_and_positive, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    srand(5);
    sys.format = (enum solve_format)_i;
    for (int k = 0; k < 12; k++) {
        system_sheet(&sys, 8, 8, pow(10, k - 3));
        system_turn(&sys, 0.02 * pow(10, k - 3));
        for (uint32_t a = 0; a < sys.n; a++)
            sys.free[a] = rand() % 7 != 0;
        system_cut(&sys, 1);
        make(SOLVE_JACOBI);
        check_symmetric(SOLVE_JACOBI);
        make(SOLVE_IC0);
        check_symmetric(SOLVE_IC0);
    }
}

/* (I - S) M^-1 q is zero: a row that a slider holds leaves its line or plane for no right side that
 * lies in it. */
UNIT_LOOP(commute_with_the_filter, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    static const enum solve_local kinds[] = {SOLVE_JACOBI, SOLVE_IC0};
    phys_vec q[SYSTEM_ROWS], s[SYSTEM_ROWS];
    srand(11);
    sys.format = (enum solve_format)_i;
    sys.filtered = true;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        system_sheet(&sys, 8, 8, 100);
        system_turn(&sys, 2);
        system_filter(&sys, true);
        sys.free[5] = 0;
        system_cut(&sys, 1);
        system_draw_rows(&sys, q);
        ck_assert_int_lt(make(kinds[k]), SOLVE_SSOR);
        apply(kinds[k], q, s);
        for (uint32_t a = 0; a < sys.n; a++) {
            phys_vec along = s[a];
            solve_filter(sys.filter + a, &along);
            for (int c = 0; c < 3; c++)
                ck_assert_double_eq_tol(along[c], s[a][c], FLOAT * sqrt(system_dot(&sys, s, s)));
        }
        check_symmetric(kinds[k]);
    }
    sys.filtered = false;
}

UNIT_TEST(all_rows_held)
{
    phys_vec q[SYSTEM_ROWS] = {{0}}, s[SYSTEM_ROWS];
    srand(6);
    system_sheet(&sys, 5, 5, 10);
    for (uint32_t a = 0; a < sys.n; a++)
        sys.free[a] = 0;
    system_cut(&sys, 1);
    ck_assert_int_eq(make(SOLVE_IC0), 0);
    apply(SOLVE_IC0, q, s);
    for (uint32_t a = 0; a < sys.n; a++)
        ck_assert(s[a][0] == 0 && s[a][1] == 0 && s[a][2] == 0);
}

/* Springs that only resist along themselves, hardly any mass: pivots of IC(0) fail. Its fallback is
 * still symmetric and positive. */
UNIT_TEST(pivots_that_fail)
{
    int tried[SOLVE_SSOR + 1] = {0};
    srand(7);
    for (int k = 0; k < 200; k++) {
        system_sheet(&sys, 7, 7, 1);
        for (uint32_t i = 0; i < sys.n_springs; i++)
            sys.value[i] = (phys_vec){system_draw(), system_draw(), system_draw(), 0};
        for (uint32_t a = 0; a < sys.n; a++)
            sys.diagonal[a] = k % 2 ? 1e-3 : 10;
        system_cut(&sys, 1);
        tried[make(SOLVE_IC0)]++;
        check_symmetric(SOLVE_IC0);
    }
    ck_assert_int_gt(tried[0], 0);
    ck_assert_int_gt(tried[1] + tried[2] + tried[3] + tried[4], 0);
}

/* The largest eigenvalue of M^-1 A, by powers. */
static double largest(void)
{
    phys_vec x[SYSTEM_ROWS], y[SYSTEM_ROWS], s[SYSTEM_ROWS];
    double found = 0;
    system_draw_rows(&sys, x);
    for (int k = 0; k < 60; k++) {
        system_multiply(&sys, x, y);
        apply(SOLVE_IC0, y, s);
        found = sqrt(system_dot(&sys, s, s) / system_dot(&sys, x, x));
        for (uint32_t a = 0; a < sys.n; a++)
            x[a] = s[a] / sqrt(system_dot(&sys, s, s));
    }
    return found;
}

/* Adds w c c' of three rows, c of sum zero, to the entries between them: some push, some pull. */
static void bend(uint32_t a, uint32_t b, uint32_t d, double w)
{
    const uint32_t row[3] = {a, b, d};
    const double first = system_draw(), second = system_draw();
    const double c[3] = {first, second, -first - second};
    for (int k = 0; k < 3; k++) /* pairs 01, 02, 12 */
        for (uint32_t i = 0; i < sys.n_springs; i++)
            if (sys.end[i][0] == row[k / 2] && sys.end[i][1] == row[k ? 2 : 1])
                sys.value[i][3] -= w * c[k / 2] * c[k ? 2 : 1];
}

/* Bending with hardly any mass, which is definite. Where pivots only just pass, the factor alone
 * would take some motion for hundreds of times softer than it is. */
UNIT_TEST(no_motion_is_too_soft)
{
    enum { SIDE = 7, SYSTEMS = 300 };
    int tried[SOLVE_SSOR + 1] = {0};
    double most = 0;
    srand(12);
    sys.format = SOLVE_HALF;
    for (int k = 0; k < SYSTEMS; k++) {
        system_sheet(&sys, SIDE, SIDE, 1);
        memset(sys.value, 0, sizeof sys.value);
        for (uint32_t a = 0; a < sys.n; a++) {
            sys.diagonal[a] = pow(10, -4 * (double)k / SYSTEMS);
            if (a % SIDE + 1 < SIDE && a + SIDE < sys.n) {
                bend(a, a + 1, a + SIDE + 1, 1);
                bend(a, a + SIDE, a + SIDE + 1, 1);
            }
        }
        system_cut(&sys, 1);
        tried[make(SOLVE_IC0)]++;
        most = fmax(most, largest());
    }
    ck_assert_int_gt(tried[0], 0);
    ck_assert_int_gt(tried[1] + tried[2] + tried[3], 0);
    ck_assert_double_lt(most, 10);
}

/* y += A_ab x, the 3 x 3 block of rows a and columns b of the dense matrix. */
static void add_block(uint32_t a, uint32_t b, const phys_vec *x, phys_vec *y)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            (*y)[i] += sys.dense[3 * a + (uint32_t)i][3 * b + (uint32_t)j] * (*x)[j];
}

/* x = A_aa^-1 y, by Cramer's rule. */
static void divide_by_block(uint32_t a, const phys_vec *y, phys_vec *x)
{
    double m[3][3], part[3][3];
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t j = 0; j < 3; j++)
            m[i][j] = sys.dense[3 * a + i][3 * a + j];
    for (int k = -1; k < 3; k++) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                part[i][j] = j == k ? (*y)[i] : m[i][j];
        double det = 0;
        for (int i = 0; i < 3; i++)
            det += part[0][i] * (part[1][(i + 1) % 3] * part[2][(i + 2) % 3] -
                                 part[1][(i + 2) % 3] * part[2][(i + 1) % 3]);
        if (k < 0)
            *x = (phys_vec){1 / det, 1 / det, 1 / det, 0};
        else
            (*x)[k] *= det;
    }
}

/* q = M s with M = (E + L) E^-1 (E + U), the matrix of SSOR: E is the dense matrix's block
 * diagonal, L and U are what lies below and above it. */
static void over_relaxed(const phys_vec *s, phys_vec *q)
{
    phys_vec y[SYSTEM_ROWS];
    for (uint32_t a = 0; a < sys.n; a++) {
        phys_vec sum = {0}, part;
        for (uint32_t b = a + 1; b < sys.n; b++)
            add_block(a, b, s + b, &sum);
        divide_by_block(a, &sum, &part);
        y[a] = s[a] + part;
    }
    for (uint32_t a = 0; a < sys.n; a++) {
        q[a] = (phys_vec){0};
        for (uint32_t b = 0; b <= a; b++)
            add_block(a, b, y + b, q + a);
    }
}

/* Springs of less than no stiffness: each row's own block is small beside the others, and all
 * pivots of IC(0) fail. */
UNIT_LOOP(ssor_is_the_last_resort, SOLVE_SPRINGS, SOLVE_HALF + 1)
{
    phys_vec x[SYSTEM_ROWS], s[SYSTEM_ROWS], q[SYSTEM_ROWS];
    srand(10);
    sys.format = (enum solve_format)_i;
    system_sheet(&sys, 6, 6, 1);
    for (uint32_t a = 0; a < sys.n; a++)
        sys.diagonal[a] = 0.3 + 0.02 * a;
    for (uint32_t i = 0; i < sys.n_springs; i++) {
        sys.value[i] =
            (phys_vec){0.1 * system_draw(), 0.1 * system_draw(), 0.1 * system_draw(), -1};
        sys.diagonal[sys.end[i][0]] += 1;
        sys.diagonal[sys.end[i][1]] += 1;
    }
    sys.free[9] = 0;
    system_cut(&sys, 1);
    ck_assert_int_eq(make(SOLVE_IC0), SOLVE_SSOR);
    check_symmetric(SOLVE_IC0);
    system_draw_rows(&sys, x);
    apply(SOLVE_IC0, x, s);
    over_relaxed(s, q);
    double max = 0; /* (I + T)^-1 of such a matrix is large, and T in float */
    for (uint32_t a = 0; a < sys.n; a++)
        for (int c = 0; c < 3; c++)
            max = fmax(max, fabs(s[a][c]));
    for (uint32_t a = 0; a < sys.n; a++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(q[a][c], x[a][c], FLOAT * max);
}

/* It ends for what is no number, too. */
UNIT_TEST(not_a_number)
{
    srand(8);
    system_sheet(&sys, 4, 4, 1);
    sys.value[3][0] = NAN;
    system_cut(&sys, 1);
    ck_assert_int_eq(make(SOLVE_IC0), SOLVE_SSOR);
}

/* Stiff beside soft: what rounding leaves of a row's own block may be singular. */
UNIT_TEST(stiff_beside_soft)
{
    srand(9);
    system_sheet(&sys, 6, 6, 1e12);
    for (uint32_t i = 0; i < sys.n_springs; i += 2)
        sys.value[i] *= 1e-6;
    for (uint32_t i = 0; i < sys.n_springs; i++)
        sys.value[i][3] = 0;
    for (uint32_t a = 0; a < sys.n; a++)
        sys.diagonal[a] = 1e-3;
    system_cut(&sys, 1);
    make(SOLVE_JACOBI);
    check_symmetric(SOLVE_JACOBI);
    make(SOLVE_IC0);
    check_symmetric(SOLVE_IC0);
}
