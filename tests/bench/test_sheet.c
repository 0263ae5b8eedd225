/* The system that the bench "ranks" solves: its answer leaves the residual that it says, and ours
 * and the twin's are refused if it is another one. */
#include "bench/ranks/ranks.h"
#include "tests/support/unit.h"

#include <stdio.h>

enum { SIDE = 20, GRAIN = 40, COUNT = 30 };

static struct ranks_session session;

static int run(size_t i, const char *text, double *value)
{
    struct serve_request request = {.text = text};
    const int code = ranks_cg.runs[i].run(&session, &request, value);
    ck_assert_msg(!request.missing, "%s=", request.missing);
    return code;
}

/* Runs ours, the traffic of ours, and the twin. */
static int run_each(size_t i)
{
    char text[100];
    double value = 0;
    snprintf(text, sizeof text, "cg side=%d grain=%d count=%d threads=2 scheduler=steal%s", SIDE,
             GRAIN, COUNT, i == 1 ? " what=bytes" : "");
    const int code = run(i, text, &value);
    ck_assert(code || (i == 1 ? value == 0 : value > 0)); /* one rank sends nothing */
    return code;
}

UNIT_TEST(answers_are_compared)
{
    for (size_t i = 0; i < 3; i++)
        ck_assert_int_eq(run_each(i), 0);
    const phys_vec kept = session.sheet.answer[7];
    session.sheet.answer[7][1] *= 1 + 0x1p-52; /* ours: the last bit */
    ck_assert_int_ne(run_each(0), 0);
    ck_assert_int_ne(run_each(1), 0);
    ck_assert_int_eq(run_each(2), 0);
    session.sheet.answer[7][1] *= 1.1;
    ck_assert_int_ne(run_each(2), 0);
    session.sheet.answer[7] = kept;
    session.sheet.square *= 1.01;
    ck_assert_int_ne(run_each(2), 0);
    session.sheet.answered = 0;
    ck_assert_int_eq(run_each(2), 0);
}

/* b - A dv of all rows, with dv as the direction of a pass that multiplies. */
UNIT_TEST(the_residual_is_what_is_left)
{
    struct sheet *s = &session.sheet;
    double square = 0, start = 0;
    ck_assert_int_eq(sheet_ready(s, SIDE, GRAIN), 0);
    ck_assert_int_eq(sheet_solve(s, COUNT), 0);
    const struct flow_tables *tables = sheet_tables(s);
    ck_assert_uint_gt(tables->n_blocks, 8);
    for (uint32_t b = 0; b < tables->n_blocks; b++)
        sheet_start(s, b);
    for (uint32_t i = 0; i < s->source.blocks.n_places; i++)
        s->q[i] = -s->answer[i]; /* r = p = dv after the first pass */
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        const struct flow_table *t = tables->block + b;
        solve_pack(t->n_halo, t->halo, s->q + t->first, s->halo[0] + sheet_halo(s, b));
    }
    const struct solve_scalars scalars = solve_scalars_start(0, SOLVE_ON);
    for (uint32_t b = 0; b < tables->n_blocks; b++) {
        double dots[SOLVE_DOTS];
        sheet_pass(s, b, &scalars, 0, dots);
    }
    for (uint32_t k = 0; k < tables->n_blocks; k++) {
        const struct flow_table *t = tables->block + k;
        for (uint32_t i = 0; i < t->n; i++) {
            const phys_vec b = t->free[i] * s->b[t->first + i], left = b - s->q[t->first + i];
            square += phys_dot(&left, &left);
            start += phys_dot(&b, &b);
        }
    }
    ck_assert_double_eq_tol(square, s->square, 1e-9 * start);
    ck_assert_double_lt(square, 0.3 * start);
    ck_assert_double_gt(square, 1e-9 * start);
}
