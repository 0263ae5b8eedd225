/* The vectors of a pass row by row, the factors against those of the two-reduction form on a system
 * of diagonal matrix, and each way a solve ends. */
#include "cloth/solve/cg.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

enum { N = 24 };

UNIT_TEST(the_last_pass_at_every_size)
{
    for (size_t n = 0; n < 12; n++) {
        phys_vec p[12] = {{0}}, q[12] = {{0}}, dv[12] = {{0}}, r[12] = {{0}};
        for (size_t i = 0; i < n; i++) {
            p[i] = (phys_vec){1, 2, 3, 0};
            q[i] = (phys_vec){1, 1, 1, 0};
            r[i] = (phys_vec){(double)i, 1, 3, 0};
        }
        double sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += ((double)i - 2) * ((double)i - 2) + 1 + 1;
        ck_assert_double_eq(solve_finish(n, 2, q, p, dv, r), sum);
        for (size_t i = 0; i < n; i++)
            ck_assert(dv[i][2] == 6 && r[i][0] == (double)i - 2);
    }
}

/* The rows that a neighbour sees, through packed numbers in another order, have their bits. */
UNIT_TEST(ghosts_keep_the_bits)
{
    static const uint32_t halo[] = {1, 4, 5, 7}, at[] = {3, 0, 2};
    phys_vec p[8], q[8], r[8], ghost_r[3], ghost_p[3];
    double packed[12];
    for (int i = 0; i < 8; i++) {
        p[i] = (phys_vec){sqrt(i + 2), 1.0 / (i + 3), 0.1 * i, 0};
        q[i] = (phys_vec){1.0 / (i + 1), sqrt(i), -0.7, 0};
        r[i] = (phys_vec){0.3, -i / 7.0, sqrt(3 * i), 0};
    }
    for (int i = 0; i < 3; i++) {
        ghost_r[i] = r[halo[at[i]]];
        ghost_p[i] = p[halo[at[i]]];
    }
    solve_pack(4, halo, q, packed);
    solve_advance_ghosts(3, 0.123, 0.77, packed, at, ghost_r, ghost_p);
    for (int i = 0; i < 8; i++)
        solve_advance(0.123, 0.77, q + i, r + i, p + i);
    for (int i = 0; i < 3; i++) {
        ck_assert_int_eq(memcmp(ghost_r + i, r + halo[at[i]], sizeof *r), 0);
        ck_assert_int_eq(memcmp(ghost_p + i, p + halo[at[i]], sizeof *p), 0);
    }
}

/* A system with a diagonal matrix whose entries lie far apart. */
static double entry(int i)
{
    return 1 + i * i;
}

struct run {
    phys_vec b[N], dv[N], r[N], p[N], q[N];
    double free[N];
    struct solve_scalars scalars;
};

static void start(struct run *run, double size)
{
    memset(run, 0x55, sizeof *run);
    for (int i = 0; i < N; i++) {
        run->free[i] = i % 5 != 0;
        run->b[i] = (phys_vec){size, size * sin(i), size / (i + 1), 0};
    }
    run->scalars = solve_scalars_start(11, SOLVE_ON);
    solve_start(N, run->free, run->b, run->dv, run->r, run->p, run->q);
}

/* With masses of 1. */
static void add_norms(const struct run *run, double dots[SOLVE_DOTS])
{
    double mass[N];
    for (int i = 0; i < N; i++)
        mass[i] = 1;
    const struct solve_norms norms = solve_norms(N, mass, run->dv, run->r);
    dots[SOLVE_SIZE] = norms.size;
    dots[SOLVE_BOUND] = norms.bound;
}

/* A pass that confirms. */
static void confirm(struct run *run, double dots[SOLVE_DOTS])
{
    double mass[N];
    for (int i = 0; i < N; i++) {
        mass[i] = 1;
        run->q[i] = run->free[i] * entry(i) * run->dv[i];
    }
    solve_renew(N, run->free, mass, run->b, run->q, run->r, dots);
    add_norms(run, dots);
}

/* A pass. Returns what solve_scalars_next does. */
static int pass(struct run *run, const struct solve_stop *stop, double sign)
{
    const struct solve_scalars now = run->scalars;
    double dots[SOLVE_DOTS] = {0};
    if (now.phase == SOLVE_CHECK)
        confirm(run, dots);
    if (now.phase == SOLVE_AGAIN)
        solve_again(N, run->r, run->p, run->q);
    if (now.phase != SOLVE_ON && now.phase != SOLVE_LAST)
        return solve_scalars_next(stop, dots, &now, &run->scalars);
    dots[SOLVE_RR] = solve_finish(N, now.alpha, run->q, run->p, run->dv, run->r);
    dots[SOLVE_RZ] = dots[SOLVE_RR];
    add_norms(run, dots);
    for (int i = 0; i < N; i++) {
        run->p[i] = run->r[i] + now.beta * run->p[i];
        run->q[i] = sign * entry(i) * run->p[i];
        dots[SOLVE_PQ] += phys_dot(run->p + i, run->q + i);
        dots[SOLVE_RQ] += phys_dot(run->r + i, run->q + i);
        dots[SOLVE_QQ] += phys_dot(run->q + i, run->q + i);
    }
    return solve_scalars_next(stop, dots, &now, &run->scalars);
}

/* One pass more than iterations; where their count is known, the last one needs no product. */
static int solve(struct run *run, const struct solve_stop *stop, double size)
{
    int code = SOLVE_OK;
    unsigned passes = 0;
    double phase = SOLVE_ON;
    start(run, size);
    for (; run->scalars.phase != SOLVE_DONE && !code; passes++) {
        phase = run->scalars.phase;
        code = pass(run, stop, 1);
    }
    ck_assert_double_eq(phase, stop->count && stop->max ? SOLVE_LAST : SOLVE_ON);
    ck_assert_double_eq(run->scalars.iterations + 1, passes);
    ck_assert_double_eq(run->scalars.step, 11);
    return code;
}

/* alpha and beta from the squares of residuals that are there. */
UNIT_TEST(factors_are_those_of_two_reductions)
{
    struct run run;
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-8, .max = 100};
    start(&run, 1);
    ck_assert_int_eq(pass(&run, &stop, 1), SOLVE_OK);
    for (int k = 0; k < 12; k++) {
        const struct solve_scalars now = run.scalars;
        ck_assert_double_eq_tol(now.alpha, now.square / now.curvature, 1e-15 * now.alpha);
        ck_assert_int_eq(pass(&run, &stop, 1), SOLVE_OK);
        const double beta = run.scalars.square / now.square;
        ck_assert_double_eq_tol(now.beta, beta, 1e-12 * beta);
    }
}

UNIT_TEST(the_residual_is_true)
{
    struct run run;
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-13, .max = 1000};
    ck_assert_int_eq(solve(&run, &stop, 1), SOLVE_OK);
    ck_assert_double_le(run.scalars.square, run.scalars.wanted);
    for (int i = 0; i < N; i++) {
        const double free = i % 5 != 0;
        const double b[3] = {free, free * sin(i), free / (i + 1)};
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(entry(i) * run.dv[i][c], b[c], 1e-12);
    }
}

UNIT_TEST(every_way_to_stop)
{
    struct run run, other;
    struct solve_stop stop = {.count = true, .max = 5};
    ck_assert_int_eq(solve(&run, &stop, 1), SOLVE_OK);
    ck_assert_double_eq(run.scalars.iterations, 5);
    stop = (struct solve_stop){.tolerance = sqrt(run.scalars.square) * (1 + 1e-12), .max = 5};
    ck_assert_int_eq(solve(&other, &stop, 1), SOLVE_OK); /* absolute, just reached */
    ck_assert_double_eq(other.scalars.iterations, 5);
    ck_assert_int_eq(memcmp(run.dv, other.dv, sizeof run.dv), 0);
    stop.max = 4;
    ck_assert_int_eq(solve(&other, &stop, 1), SOLVE_NOT_CONVERGED);
    ck_assert_double_eq(other.scalars.iterations, 4);
    stop = (struct solve_stop){.count = true, .max = 0};
    ck_assert_int_eq(solve(&other, &stop, 1), SOLVE_OK);
    ck_assert_double_eq(other.dv[1][0], 0);
    stop = (struct solve_stop){.count = true, .max = 1};
    ck_assert_int_eq(solve(&other, &stop, 1), SOLVE_OK);
    ck_assert_double_ne(other.dv[1][0], 0);
}

/* Solves with a confirmation; before pass `at` the recurrence loses the residual, in which r gets
 * something by mistake, or in every check where `at` is negative. */
static int lie(struct run *run, const struct solve_stop *stop, int at)
{
    int code = SOLVE_OK;
    start(run, 1);
    for (int i = 0; run->scalars.phase != SOLVE_DONE && !code; i++) {
        if (at > 0 ? i == at : run->scalars.phase == SOLVE_CHECK)
            run->r[7][1] += 0.5;
        if (at < 0 && run->scalars.phase == SOLVE_CHECK)
            run->b[7][1] = 3 - run->b[7][1];
        code = pass(run, stop, 1);
    }
    return code;
}

static const struct solve_stop CONFIRMED[] = {
    {.relative = true, .confirm = true, .tolerance = 1e-6, .max = 100},
    {.confirm = true, .tolerance = 1e-6, .max = 100},
    {.mass_norm = true, .confirm = true, .tolerance = 1e-3, .max = 100}};

/* Two passes more, the same dv, and the true residual in r. */
UNIT_LOOP(what_is_right_is_confirmed, 0, 3)
{
    struct run run, alone;
    struct solve_stop stop = CONFIRMED[_i];
    ck_assert_int_eq(lie(&run, &stop, 1000), SOLVE_OK);
    stop.confirm = false;
    ck_assert_int_eq(solve(&alone, &stop, 1), SOLVE_OK);
    ck_assert_int_eq(memcmp(run.dv, alone.dv, sizeof run.dv), 0);
    ck_assert_double_eq(run.scalars.restarts, 0);
    ck_assert_double_eq(solve_scalars_iterations(&run.scalars), alone.scalars.iterations);
    ck_assert_double_le(run.scalars.drift, 1e-28);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            ck_assert_double_eq_tol(run.r[i][c],
                                    run.free[i] * (run.b[i][c] - entry(i) * run.dv[i][c]), 1e-15);
}

/* The solve goes on from dv and gets there. */
UNIT_LOOP(what_is_wrong_is_found, 0, 3)
{
    struct run run;
    ck_assert_int_eq(lie(&run, CONFIRMED + _i, 3), SOLVE_OK);
    ck_assert_double_eq(run.scalars.restarts, 1);
    ck_assert_double_gt(run.scalars.spent, 3);
    ck_assert_double_eq_tol(entry(7) * run.dv[7][1], sin(7), 1e-2);
    struct solve_stop stop = CONFIRMED[_i];
    stop.confirm = false; /* which would not have been */
    ck_assert_int_eq(lie(&run, &stop, 3), SOLVE_OK);
    ck_assert_double_gt(fabs(entry(7) * run.dv[7][1] - sin(7)), 0.4);
    stop.confirm = true;
    stop.max = (uint32_t)run.scalars.iterations;
    ck_assert_int_eq(lie(&run, &stop, 3), SOLVE_NOT_CONVERGED);
}

/* A residual that no restart makes smaller. */
UNIT_LOOP(what_stays_wrong_is_said, 0, 3)
{
    struct run run;
    ck_assert_int_eq(lie(&run, CONFIRMED + _i, -1), SOLVE_STALLED);
    ck_assert_double_eq(run.scalars.outcome, SOLVE_STALLED);
    ck_assert_double_eq(run.scalars.phase, SOLVE_DONE);
    ck_assert_double_eq(run.scalars.restarts, 1);
}

/* The true residual may be twice as large as what was asked for, and no more: its square is 4 times
 * as large. */
UNIT_LOOP(how_much_more_the_true_residual_may_be, 0, 3)
{
    static const struct solve_stop stops[] = {
        {.confirm = true, .tolerance = 1e-3},
        {.relative = true, .confirm = true, .tolerance = 0.1},
        {.normalised = true, .confirm = true, .tolerance = 0.01}};
    const struct solve_stop *stop = stops + _i;
    const double first = 25, unit = 3;
    const double asked = stop->relative     ? 0.1 * 0.1 * first
                         : stop->normalised ? 0.01 * 0.01 * unit
                                            : 1e-3 * 1e-3;
    struct solve_scalars before = solve_scalars_start(0, SOLVE_CHECK), after;
    before.wanted = asked;
    before.unit = unit;
    const double part[] = {0.1, 1, 3.99, 4.01, 40, 4000};
    for (int i = 0; i < 6; i++) {
        const double square = part[i] * asked;
        const double dots[SOLVE_DOTS] = {[SOLVE_RR] = square, [SOLVE_BOUND] = square};
        ck_assert_int_eq(solve_scalars_next(stop, dots, &before, &after), SOLVE_OK);
        ck_assert_double_eq(after.phase, part[i] < 4 ? SOLVE_DONE : SOLVE_AGAIN);
        ck_assert_double_eq(after.restarts, part[i] < 4 ? 0 : 1);
    }
}

/* The right side is zero, or so little that its square is. */
UNIT_TEST(nothing_to_solve)
{
    static const double sizes[] = {0, 1e-150, 1e-170};
    for (int i = 0; i < 3; i++) {
        struct run run;
        struct solve_stop stop = {.relative = true, .max = 9};
        ck_assert_int_eq(solve(&run, &stop, sizes[i]), SOLVE_OK);
        ck_assert_double_eq(run.scalars.iterations, 0);
        stop.count = true;
        ck_assert_int_eq(solve(&run, &stop, sizes[i]), SOLVE_OK);
        ck_assert_double_eq(run.scalars.iterations, 9);
        ck_assert_double_eq(run.dv[1][0], 0);
    }
}

/* A matrix that is negative, and one beyond all numbers. */
UNIT_TEST(breakdowns)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-3, .max = 9};
    struct run run;
    start(&run, 1);
    ck_assert_int_eq(pass(&run, &stop, -1), SOLVE_BREAKDOWN);
    ck_assert_double_lt(run.scalars.curvature, 0);
    start(&run, 1e200);
    int code = SOLVE_OK;
    for (int i = 0; i < 3 && !code; i++)
        code = pass(&run, &stop, 1);
    ck_assert_int_eq(code, SOLVE_BREAKDOWN);
}

/* The rounding of a guess that was right is no breakdown, against what there was to solve; more
 * than that is one. */
UNIT_TEST(little_left_of_a_guess)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-20, .max = 9};
    const double left[] = {1e-30, 1e-20};
    for (int i = 0; i < 2; i++) {
        struct solve_scalars now[4] = {solve_scalars_start(0, SOLVE_OPEN)};
        double dots[SOLVE_DOTS] = {[SOLVE_RR] = 1, [SOLVE_RQ] = 1, [SOLVE_PQ] = 1};
        ck_assert_int_eq(solve_scalars_next(&stop, dots, now, now + 1), SOLVE_OK);
        ck_assert_int_eq(solve_scalars_next(&stop, dots, now + 1, now + 2), SOLVE_OK);
        dots[SOLVE_RR] = left[i];
        dots[SOLVE_RZ] = -1e-43;
        dots[SOLVE_PQ] = 1e-43;
        ck_assert_int_eq(solve_scalars_next(&stop, dots, now + 2, now + 3),
                         i == 0 ? SOLVE_OK : SOLVE_BREAKDOWN);
    }
}

/* A number that is infinite, or a step that is none, would stay so for all iterations. */
UNIT_TEST(nothing_moves)
{
    const struct solve_stop stop = {.relative = true, .tolerance = 1e-3, .max = 9};
    const double product[] = {1, INFINITY, 1e-200}, curvature[] = {INFINITY, 1, 1e200};
    for (int i = 0; i < 3; i++) {
        const struct solve_scalars before = solve_scalars_start(0, SOLVE_ON);
        struct solve_scalars after;
        const double dots[SOLVE_DOTS] = {
            [SOLVE_RR] = 1, [SOLVE_RZ] = product[i], [SOLVE_PQ] = curvature[i]};
        ck_assert_int_eq(solve_scalars_next(&stop, dots, &before, &after), SOLVE_BREAKDOWN);
    }
}
