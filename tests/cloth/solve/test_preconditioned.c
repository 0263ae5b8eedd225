/* Whole solves over blocks with every preconditioner, as tasks make them: the same answer, in fewer
 * iterations, to any tolerance; and what they do at the ends: exact preconditioners, nothing to do,
 * every stop. */
#include "cloth/solve/cg.h"
#include "cloth/solve/local.h"
#include "tests/cloth/solve/two_level.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum kind { NONE, JACOBI, IC0, COARSE, IC0_COARSE, KINDS };

static struct system sys;
static struct two_level level;
static _Alignas(32) double factor[SYSTEM_BLOCKS][8 * SYSTEM_ROWS + 12 * SYSTEM_SPRINGS];

struct run {
    phys_vec dv[SYSTEM_ROWS], r[SYSTEM_ROWS], p[SYSTEM_ROWS], q[SYSTEM_ROWS];
    phys_vec z[SYSTEM_ROWS], s[SYSTEM_ROWS];
    struct solve_scalars scalars;
};

static enum solve_local local_of(enum kind kind)
{
    return kind == IC0 || kind == IC0_COARSE ? SOLVE_IC0 : SOLVE_JACOBI;
}

static void prepare(enum kind kind)
{
    two_level_make(&level, &sys);
    for (uint32_t b = 0; b < sys.n_blocks && kind != NONE; b++)
        solve_local_factor(&sys.block[b].matrix, &sys.block[b].cut, sys.block[b].value,
                           local_of(kind), factor[b]);
}

/* s = M^-1 q. Returns q.s. */
static double turn(enum kind kind, const phys_vec *q, phys_vec *s)
{
    for (uint32_t b = 0; b < sys.n_blocks; b++)
        solve_local_apply(&sys.block[b].matrix, local_of(kind), factor[b], q + sys.block[b].first,
                          s + sys.block[b].first);
    if (kind >= COARSE)
        two_level_add(&level, q, s);
    return system_dot(&sys, q, s);
}

/* A block's pass reads p of others as it will be. */
static void ghosts_of(const struct run *run, enum kind kind, const struct system_block *block,
                      phys_vec *p)
{
    for (uint32_t i = 0; i < block->n_ghosts; i++) {
        const uint32_t a = block->ghost[i];
        phys_vec r = kind == NONE ? run->r[a] : run->z[a];
        p[i] = run->p[a];
        solve_advance(run->scalars.alpha, run->scalars.beta, (kind == NONE ? run->q : run->s) + a,
                      &r, p + i);
    }
}

static void pass_block(struct run *run, const struct run *before, enum kind kind, uint32_t b,
                       double dots[SOLVE_DOTS])
{
    const struct system_block *block = sys.block + b;
    const uint32_t at = block->first;
    const double alpha = before->scalars.alpha, beta = before->scalars.beta;
    struct solve_rows rows = solve_rows_plain(run->dv + at, run->r + at, run->p + at, run->q + at);
    phys_vec ghosts[SYSTEM_SPRINGS];
    double own[SOLVE_DOTS];
    ghosts_of(before, kind, block, ghosts);
    if (kind != NONE) {
        rows.z = run->z + at;
        rows.s = run->s + at;
    }
    solve_pass(&block->matrix, &block->cut, block->value, ghosts, alpha, beta, &rows, own);
    const struct solve_norms norms = solve_norms(block->matrix.n, block->diagonal, rows.dv, rows.r);
    own[SOLVE_SIZE] = norms.size;
    own[SOLVE_BOUND] = norms.bound;
    for (int i = 0; i < SOLVE_DOTS; i++)
        dots[i] += own[i];
}

static int pass(struct run *run, enum kind kind, const struct solve_stop *stop)
{
    static struct run before;
    double dots[SOLVE_DOTS] = {0};
    before = *run;
    for (uint32_t b = 0; b < sys.n_blocks; b++)
        pass_block(run, &before, kind, b, dots);
    if (kind != NONE)
        dots[SOLVE_QQ] = turn(kind, run->q, run->s);
    return solve_scalars_next(stop, dots, &before.scalars, &run->scalars);
}

/* The two passes that begin from a guess. */
static void open(struct run *run, const phys_vec *b, const phys_vec *guess,
                 const struct solve_stop *stop)
{
    double dots[SOLVE_DOTS] = {0}, own[SOLVE_DOTS];
    phys_vec ghosts[SYSTEM_SPRINGS], whole[SYSTEM_ROWS];
    memcpy(run->dv, guess, sys.n * sizeof *guess);
    solve_start_guess(sys.n, sys.free, sys.filtered ? sys.filter : NULL, b, -0.5, run->dv, run->r,
                      run->p, run->q);
    memcpy(whole, run->dv, sizeof whole);
    for (uint32_t k = 0; k < sys.n_blocks; k++) {
        const struct system_block *block = sys.block + k;
        const uint32_t at = block->first;
        const struct solve_rows rows =
            solve_rows_plain(run->dv + at, run->r + at, run->p + at, run->q + at);
        for (uint32_t i = 0; i < block->n_ghosts; i++)
            ghosts[i] = whole[block->ghost[i]];
        solve_open(&block->matrix, &block->cut, block->value, ghosts, &rows, own);
        for (int i = 0; i < SOLVE_DOTS; i++)
            dots[i] += own[i];
    }
    for (int i = 0; i < 2; i++) {
        const struct solve_scalars now = run->scalars;
        ck_assert_int_eq(solve_scalars_next(stop, dots, &now, &run->scalars), SOLVE_OK);
        if (i == 0)
            solve_finish(sys.n, run->scalars.alpha, run->q, run->p, run->dv, run->r);
    }
    solve_again(sys.n, run->r, run->p, run->q);
}

/* guess: may be NULL. */
static int solve_from(struct run *run, enum kind kind, const phys_vec *b, const phys_vec *guess,
                      const struct solve_stop *stop)
{
    memset(run, 0, sizeof *run);
    prepare(kind);
    run->scalars = solve_scalars_start(0, guess ? SOLVE_OPEN : SOLVE_ON);
    if (guess)
        open(run, b, guess, stop);
    else
        solve_start(sys.n, sys.free, b, run->dv, run->r, run->p, run->q);
    if (kind != NONE)
        turn(kind, run->q, run->s);
    int code = SOLVE_OK;
    while (run->scalars.phase == SOLVE_ON && !code)
        code = pass(run, kind, stop);
    two_level_free(&level);
    return code;
}

static int solve(struct run *run, enum kind kind, const phys_vec *b, const struct solve_stop *stop)
{
    return solve_from(run, kind, b, NULL, stop);
}

static double distance(const phys_vec *x, const phys_vec *y)
{
    double max = 0;
    for (uint32_t a = 0; a < sys.n; a++)
        for (int c = 0; c < 3; c++)
            max = fmax(max, fabs(x[a][c] - y[a][c]));
    return max;
}

static void check_all(double stiffness, uint32_t n_blocks, int hold)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-10, .max = 2000};
    phys_vec b[SYSTEM_ROWS], x[SYSTEM_ROWS];
    static struct run run;
    double iterations[KINDS];
    system_sheet(&sys, 8, 8, stiffness);
    system_turn(&sys, 0.02 * stiffness);
    for (uint32_t a = 0; a < sys.n; a++)
        sys.free[a] = !hold || a % (uint32_t)hold;
    if (sys.filtered)
        system_filter(&sys, n_blocks > 4);
    system_cut(&sys, n_blocks);
    system_draw_rows(&sys, b);
    system_solve(&sys, b, x);
    for (enum kind kind = NONE; kind < KINDS; kind++) {
        ck_assert_int_eq(solve(&run, kind, b, &stop), SOLVE_OK);
        ck_assert_double_lt(distance(run.dv, x), 1e-8);
        iterations[kind] = run.scalars.iterations;
    }
    ck_assert_double_le(iterations[IC0], iterations[JACOBI]);
    ck_assert_double_le(iterations[IC0_COARSE], iterations[COARSE]);
}

UNIT_LOOP(every_preconditioner_solves, 0, 6)
{
    srand(1);
    sys.format = (enum solve_format)(_i % 3);
    sys.filtered = _i > 2;
    for (uint32_t n_blocks = 1; n_blocks <= SYSTEM_BLOCKS; n_blocks += 3)
        for (int hold = 0; hold <= 14; hold += 7) {
            check_all(1, n_blocks, hold);
            check_all(1000, n_blocks, hold);
        }
}

/* A chain in one block: IC(0) is exact but for its T in float. */
UNIT_TEST(a_chain_at_once)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-5, .max = 1};
    phys_vec b[SYSTEM_ROWS];
    static struct run run;
    srand(2);
    system_chain(&sys, 50, 100);
    sys.free[0] = 0;
    system_cut(&sys, 1);
    system_draw_rows(&sys, b);
    ck_assert_int_eq(solve(&run, IC0, b, &stop), SOLVE_OK);
}

/* Rigid and affine motion of stiff blocks is what a block alone does not see, and the coarse space
 * has. */
UNIT_TEST(rigid_and_affine_motion)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-6, .max = 2000};
    static struct run run;
    srand(3);
    system_sheet(&sys, 8, 8, 1e6);
    system_cut(&sys, 4);
    two_level_make(&level, &sys);
    phys_vec x[SYSTEM_ROWS], b[SYSTEM_ROWS];
    for (uint32_t a = 0; a < sys.n; a++)
        x[a] = (phys_vec){0.1, -9.81, 0.2, 0} + level.basis[a][1] * (phys_vec){1, 2, -1, 0};
    two_level_free(&level);
    system_multiply(&sys, x, b);
    ck_assert_int_eq(solve(&run, IC0, b, &stop), SOLVE_OK);
    const double alone = run.scalars.iterations;
    ck_assert_int_eq(solve(&run, IC0_COARSE, b, &stop), SOLVE_OK);
    ck_assert_double_le(2 * run.scalars.iterations, alone);
    ck_assert_double_lt(distance(run.dv, x), 1e-4);
}

/* The stop by the mass norm keeps its word, and what it says of the error is no less than it. */
UNIT_TEST(error_in_the_mass_norm)
{
    srand(4);
    for (int k = 0; k < 30; k++) {
        const struct solve_stop stop = {.mass_norm = true, .tolerance = 0.01, .max = 2000};
        phys_vec b[SYSTEM_ROWS], x[SYSTEM_ROWS], e[SYSTEM_ROWS], guess[SYSTEM_ROWS];
        static struct run run;
        system_sheet(&sys, 8, 8, pow(10, k % 6));
        sys.free[0] = sys.free[7] = 0;
        system_cut(&sys, 4);
        system_draw_rows(&sys, b);
        system_solve(&sys, b, x);
        system_draw_rows(&sys, e);
        for (uint32_t a = 0; a < sys.n; a++)
            guess[a] = x[a] + 0.1 * e[a];
        ck_assert_int_eq(
            solve_from(&run, (enum kind)(k % KINDS), b, k % 4 < 2 ? guess : NULL, &stop), SOLVE_OK);
        for (uint32_t a = 0; a < sys.n; a++)
            e[a] = run.dv[a] - x[a];
        const double error = solve_norms(sys.n, sys.diagonal, e, run.r).size;
        const double size = solve_norms(sys.n, sys.diagonal, x, run.r).size;
        ck_assert_double_le(sqrt(error / size), 0.01);
        ck_assert_double_le(error, solve_scalars_error(&run.scalars, run.scalars.bound) * 1.0001 +
                                       1e-16 * size);
    }
}

/* A guess: of any length a right one needs no iteration; a wrong one is taken as far as it is
 * right, and in a filtered system it is filtered. */
UNIT_LOOP(guesses, 0, 2)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-9, .max = 2000};
    static const double factor_of[] = {1, -3, 0};
    phys_vec b[SYSTEM_ROWS], x[SYSTEM_ROWS], e[SYSTEM_ROWS], guess[SYSTEM_ROWS];
    static struct run run;
    srand(6);
    sys.filtered = _i > 0;
    system_sheet(&sys, 8, 8, 1000);
    system_filter(&sys, true);
    sys.free[7] = _i == 0;
    system_cut(&sys, 4);
    system_draw_rows(&sys, b);
    system_solve(&sys, b, x);
    for (enum kind kind = NONE; kind < KINDS; kind++)
        for (int i = 0; i < 3; i++) {
            system_draw_rows(&sys, e);
            for (uint32_t a = 0; a < sys.n; a++)
                guess[a] = factor_of[i] * x[a] + (i == 2) * e[a];
            guess[7] += (phys_vec){sys.free[7] == 0, 0, 0, 0};
            ck_assert_int_eq(solve_from(&run, kind, b, guess, &stop), SOLVE_OK);
            ck_assert_double_lt(distance(run.dv, x), 1e-6);
            ck_assert_int_eq(run.scalars.iterations == 0, i < 2);
        }
    sys.filtered = false;
}

/* So many iterations of what was solved long before leave it as it is. */
UNIT_TEST(on_and_on)
{
    const struct solve_stop stop = {.count = true, .max = 200};
    phys_vec b[SYSTEM_ROWS], x[SYSTEM_ROWS];
    static struct run run;
    srand(5);
    system_sheet(&sys, 6, 6, 100);
    sys.free[3] = 0;
    system_cut(&sys, 3);
    system_draw_rows(&sys, b);
    system_solve(&sys, b, x);
    for (enum kind kind = NONE; kind < KINDS; kind++) {
        ck_assert_int_eq(solve(&run, kind, b, &stop), SOLVE_OK);
        ck_assert_double_eq(run.scalars.iterations, 200);
        ck_assert_double_lt(distance(run.dv, x), 1e-9);
    }
}

UNIT_TEST(nothing_to_solve)
{
    const struct solve_stop stops[] = {{.relative = true, .tolerance = 1e-3, .max = 9},
                                       {.mass_norm = true, .tolerance = 0.01, .max = 9}};
    const phys_vec b[SYSTEM_ROWS] = {{0}};
    static struct run run;
    srand(6);
    system_sheet(&sys, 6, 6, 100);
    system_cut(&sys, 3);
    for (int i = 0; i < 2; i++)
        for (enum kind kind = NONE; kind < KINDS; kind++) {
            ck_assert_int_eq(solve(&run, kind, b, stops + i), SOLVE_OK);
            ck_assert_double_eq(run.scalars.iterations, 0);
        }
}
