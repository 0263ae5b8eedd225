/* The filter of solves that a program gives: along what it holds nothing moves. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <string.h>

/* A program's filter: holds vertex 0 at a point, vertex 20 in the plane across (0.6, 0.8, 0), and
 * vertex 40 on a line, by two normals. */
static int mark;
static void constrain_three(void *context, const struct flow_rows *rows)
{
    const phys_vec askew = {0.6, 0.8, 0, 0}, along = {0, 0, 1, 0};
    ck_assert(context == &mark && rows->h > 0 && rows->time >= rows->h);
    for (size_t i = 0; i < rows->n; i++) {
        if (rows->vertex[i] == 0)
            rows->filter[i] = (phys_vec){0};
        if (rows->vertex[i] == 20 || rows->vertex[i] == 40)
            solve_constrain(&askew, rows->filter + i);
        if (rows->vertex[i] == 40)
            solve_constrain(&along, rows->filter + i);
    }
}

/* With every preconditioner: what the program holds stays, the rest falls. */
UNIT_LOOP(a_program_filters, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    UNIT_OWNED(setup_free) struct setup setup;
    UNIT_OWNED(record_free)
    struct record record = {.threads = 2, .filter = {&mark, constrain_three}};
    setup_sheet(&setup, 8);
    setup.model.own_filter = true;
    setup.model.tolerance = 1e-10;
    setup.model.preconditioner = (enum model_preconditioner)_i;
    record_fine(&record, &setup.model);
    for (size_t v = 0; v < 64; v++) {
        double moved[3];
        for (size_t c = 0; c < 3; c++)
            moved[c] = record_at(&record, 10, v, c) - record_at(&record, 0, v, c);
        if (v == 0)
            ck_assert(moved[0] == 0 && moved[1] == 0 && moved[2] == 0);
        else
            ck_assert_double_lt(moved[1], -1e-5);
        if (v == 20 || v == 40) {
            ck_assert_double_eq_tol(0.6 * moved[0] + 0.8 * moved[1], 0, 1e-12);
            ck_assert_double_gt(moved[0], 1e-5);
        }
        if (v == 40)
            ck_assert_double_eq(moved[2], 0);
    }
}

UNIT_TEST(a_filter_is_given_on_every_rank)
{
    TRIAL(setup_sheet(&setup, 8));
    setup.model.own_filter = true;
    record_run(&record, &setup.model);
    ck_assert_int_eq(record.code, CLOTH_E_RUN);
    ck_assert_ptr_nonnull(strstr(record.error.text, "call flow_filter_by on every rank"));
}
