/* Systems at the edge of what can be solved: each ends with the right answer, or with an error that
 * names the cause. With every preconditioner. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <stdlib.h>

static const double FALL = 9.81e-6 * 55; /* of ten steps of implicit Euler */

static void pin_rows(struct setup *setup, uint32_t n)
{
    static uint32_t all[64];
    for (uint32_t i = 0; i < n; i++)
        all[i] = i;
    setup_pin(setup, 1, all);
    setup->pin.pick.vertices = all;
    setup->pin.pick.n_vertices = n;
}

/* Blocks without a free vertex, all of them, or one block of everything. */
UNIT_LOOP(held_blocks, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    const uint32_t held[] = {64, 24, 1}, grain[] = {8, 8, 1000};
    for (int i = 0; i < 3; i++) {
        UNIT_OWNED(record_free) struct record record = {0};
        SETUP(setup_sheet(&setup, 8));
        setup.model.preconditioner = (enum model_preconditioner)_i;
        setup.model.grain = grain[i];
        pin_rows(&setup, held[i]);
        record_fine(&record, &setup.model);
        for (uint32_t v = 0; v < held[i]; v++)
            ck_assert_double_eq(record_at(&record, 10, v, 1), 0);
        if (held[i] < 64)
            ck_assert_double_lt(record_at(&record, 10, 63, 1), -0.5 * FALL);
        ck_assert_double_ge(record_at(&record, 10, 63, 1), -1.01 * FALL);
    }
}

/* No vertex is held, and only mass is in the way: all falls, however many pieces it is. */
UNIT_LOOP(pieces_that_fall, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    static const double vertices[] = {0, 0, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 6, 0, 0, 5, 0, 1};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5};
    TRIAL(setup_sheet(&setup, 2));
    setup_mesh(&setup, 6, vertices, 0, NULL, 2, triangles);
    setup.model.preconditioner = (enum model_preconditioner)_i;
    setup.model.grain = 2;
    record_fine(&record, &setup.model);
    for (size_t v = 0; v < 6; v++)
        ck_assert_double_eq_tol(record_at(&record, 10, v, 1), -FALL, 1e-9);
}

/* Moduli of 1e12 beside 1e-3. */
UNIT_LOOP(stiff_beside_soft, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    TRIAL(setup_sheet(&setup, 8));
    setup.material.stretch = 1e12;
    setup.material.shear = setup.material.bend = 1e-3;
    setup.model.stop = MODEL_STOP_MASS_NORM; /* residuals mislead */
    setup.model.tolerance = 0.01;
    setup.model.preconditioner = (enum model_preconditioner)_i;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    record_fine(&record, &setup.model);
    ck_assert_double_eq_tol(record.report.max_stretch, 1, 1e-3);
    ck_assert_double_lt(record_at(&record, 10, 63, 1), -0.4 * FALL);
}

/* A matrix so stiff that rounding takes the recurrence away from the residual: the solve begins
 * again and gets what was asked for, or says that no solve can. */
UNIT_LOOP(rounding_is_noticed, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    static const double tolerance[] = {3e-6, 1e-9};
    for (int i = 0; i < 2; i++) {
        UNIT_OWNED(record_free) struct record record = {.threads = 2};
        SETUP(setup_sheet(&setup, 8));
        setup.material.stretch = 1e12;
        setup.material.shear = 2500;
        setup.material.bend = 0;
        setup.material.damping_stiffness = 0.015;
        setup.model.h = 0.01;
        setup.model.end = 0.05;
        setup.model.stop = MODEL_STOP_MASS_NORM;
        setup.model.tolerance = tolerance[i];
        setup.model.preconditioner = (enum model_preconditioner)_i;
        setup_pin(&setup, 3, (const uint32_t[]){0, 7, 60});
        record_run(&record, &setup.model);
        if (i == 0) {
            ck_assert_msg(record.code == 0, "%s", record.error.text);
            ck_assert_uint_gt(record.report.cg_restarts, 0);
            ck_assert_double_le(record.report.mass_norm_error, 2 * tolerance[0]);
        } else {
            ck_assert_int_eq(record.code, CLOTH_E_RUN);
            unit_says(record.error.text, "what rounding leaves");
        }
    }
}

/* The whole slope of springs in compression: the matrix is indefinite. That is said, or a shorter
 * step, in which the masses prevail, goes on. */
UNIT_LOOP(compressed_and_not_clamped, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    for (int halving = 0; halving < 2; halving++) {
        struct record record = {0};
        SETUP(setup_sheet(&setup, 6));
        double *start = calloc(36, 6 * sizeof *start);
        ck_assert(start != NULL);
        for (size_t v = 0; v < 36; v++)
            for (size_t c = 0; c < 3; c++)
                start[6 * v + c] = 0.3 * setup.cloth.mesh.position[3 * v + c];
        setup.cloth.start = start;
        setup.material.stretch = setup.material.shear = 5000;
        setup.material.damping_stiffness = 0;
        setup.model.full_slope = true;
        setup.model.h = 0.02;
        setup.model.end = 0.02;
        setup.model.halving = halving;
        setup.model.preconditioner = (enum model_preconditioner)_i;
        setup_load(&setup, 7, 0.1, 3, 0.2);
        setup_pin(&setup, 1, (const uint32_t[]){0});
        record_run(&record, &setup.model);
        if (halving) {
            ck_assert_msg(record.code == 0, "%s", record.error.text);
            ck_assert_uint_gt(record.report.steps_halved, 0);
        } else {
            ck_assert_int_eq(record.code, CLOTH_E_RUN);
            unit_says(record.error.text, "the matrix is not positive definite");
        }
        record_free(&record);
        setup.cloth.start = NULL;
        free(start);
    }
}
