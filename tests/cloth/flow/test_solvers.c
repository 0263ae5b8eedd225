/* Runs with every preconditioner and stop: the same motion as without, few iterations, errors kept;
 * also of a chain and of springs in compression. Systems that leave a preconditioner nothing to
 * hold on to are in test_singular.c. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

static const enum model_preconditioner kinds[] = {MODEL_JACOBI, MODEL_IC0, MODEL_COARSE,
                                                  MODEL_IC0_COARSE};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* Stiff enough to be worth a preconditioner, and pulled at. */
static void setup_stiff(struct setup *setup, uint32_t n)
{
    setup_sheet(setup, n);
    setup->material.stretch = 5000;
    setup->material.shear = 2500;
    setup->cloth.velocity[0] = 2;
    setup_pin(setup, 2, (const uint32_t[]){0, n - 1});
}

/* Runs the model without a preconditioner and with each: the same within 1e-6 m. Returns the
 * iterations of plain conjugate gradients. */
static uint64_t compare(struct setup *setup, uint64_t iterations[KINDS])
{
    struct record plain = {0};
    setup->model.tolerance = 1e-10;
    setup->model.preconditioner = MODEL_PLAIN;
    record_fine(&plain, &setup->model);
    const uint64_t alone = plain.report.cg_iterations_total;
    for (int i = 0; i < KINDS; i++) {
        UNIT_OWNED(record_free) struct record record = {.threads = 1 + (unsigned)i % 2};
        setup->model.preconditioner = kinds[i];
        record_fine(&record, &setup->model);
        ck_assert_double_le(record_farthest(&plain, &record), 1e-6);
        iterations[i] = record.report.cg_iterations_total;
    }
    record_free(&plain);
    setup_free(setup);
    return alone;
}

static void check(struct setup *setup)
{
    uint64_t iterations[KINDS];
    compare(setup, iterations);
}

UNIT_TEST(a_sheet_moves_alike)
{
    struct setup setup;
    uint64_t iterations[KINDS];
    setup_stiff(&setup, 20);
    setup.model.grain = 30;
    const uint64_t alone = compare(&setup, iterations);
    ck_assert_uint_lt(iterations[0], alone);
    ck_assert_uint_lt(iterations[1], iterations[0]);
    ck_assert_uint_lt(iterations[3], iterations[2]);
    ck_assert_uint_lt(3 * iterations[3], alone);
}

/* Whatever patches blocks are cut into, also where these have fewer rows than motions, or none. */
UNIT_LOOP(patches_move_alike, 0, 2)
{
    UNIT_OWNED(record_free) struct record none = {0};
    uint64_t before = UINT64_MAX;
    SETUP(setup_stiff(&setup, 20));
    setup.model.tolerance = 1e-10;
    setup.model.grain = _i ? 3 : 90;
    setup.model.preconditioner = MODEL_PLAIN;
    record_fine(&none, &setup.model);
    setup.model.preconditioner = MODEL_IC0_COARSE;
    for (uint32_t patches = 1; patches <= 4; patches++) {
        UNIT_OWNED(record_free) struct record record = {.threads = 1 + patches % 2};
        setup.model.patches = patches;
        record_fine(&record, &setup.model);
        ck_assert_double_le(record_farthest(&none, &record), 1e-6);
        if (!_i)
            ck_assert_uint_lt(record.report.cg_iterations_total, before);
        before = record.report.cg_iterations_total;
    }
}

/* In half storage, too, with every preconditioner, of a sheet whose bend springs join vertices that
 * have others between them, and some twice. */
UNIT_TEST(formats_move_alike)
{
    UNIT_OWNED(record_free) struct record springs = {0};
    SETUP(setup_stiff(&setup, 14));
    setup.material.bend = 50;
    setup.model.grain = 30;
    setup.model.tolerance = 1e-10;
    record_fine(&springs, &setup.model);
    setup.model.format = SOLVE_HALF;
    for (int i = 0; i < KINDS; i++) {
        UNIT_OWNED(record_free) struct record record = {.threads = 1 + (unsigned)i % 2};
        setup.model.preconditioner = kinds[i];
        record_fine(&record, &setup.model);
        ck_assert_double_le(record_farthest(&springs, &record), 1e-6);
        ck_assert_double_le(record.report.momentum_lost, 1e-9);
    }
}

static uint64_t iterations_of(struct setup *setup, enum model_guess guess, double h,
                              struct record *record)
{
    *record = (struct record){.threads = 2};
    setup->model.guess = guess;
    setup->model.h = h;
    setup->model.end = 10 * h;
    record_fine(record, &setup->model);
    return record->report.cg_iterations_total;
}

/* A solve that begins where the last one ended moves alike in fewer iterations, held and driven
 * rows included; where steps are long it begins from nothing. */
UNIT_LOOP(starts_move_alike, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    struct record zero, previous, automatic;
    SETUP(setup_stiff(&setup, 14));
    setup.model.preconditioner = (enum model_preconditioner)_i;
    setup.model.tolerance = 1e-8;
    const uint64_t many = iterations_of(&setup, MODEL_GUESS_ZERO, 0.001, &zero);
    const uint64_t few = iterations_of(&setup, MODEL_GUESS_PREVIOUS, 0.001, &previous);
    ck_assert_uint_lt(few, many);
    ck_assert_double_le(record_farthest(&zero, &previous), 1e-6);
    ck_assert_uint_eq(iterations_of(&setup, MODEL_GUESS_AUTO, 0.001, &automatic), few);
    ck_assert_uint_eq(automatic.report.state_hash, previous.report.state_hash);
    record_free(&zero);
    record_free(&previous);
    record_free(&automatic);
    iterations_of(&setup, MODEL_GUESS_ZERO, 0.01, &zero);
    iterations_of(&setup, MODEL_GUESS_AUTO, 0.01, &automatic);
    ck_assert_uint_eq(automatic.report.state_hash, zero.report.state_hash);
    record_free(&zero);
    record_free(&automatic);
}

/* By hand: flat and at rest all have b = h m g, so the residual is h g all over before the first
 * iteration and moves all by h h g, while neighbours along rows and columns are 0.25 m apart; a
 * vertex that is held has no part in it. */
UNIT_TEST(normalised_by_hand)
{
    const double first = 0.001 * 0.001 * 9.81 / 0.25;
    for (int i = 0; i < 4; i++) {
        UNIT_OWNED(record_free) struct record record = {0};
        SETUP(setup_sheet(&setup, 5));
        setup.model.end = setup.model.h;
        setup.model.stop = MODEL_STOP_NORMALISED;
        setup.model.tolerance = first * (i % 2 ? 1 + 1e-12 : 1 - 1e-12);
        setup_pin(&setup, i < 2 ? 1 : 3, (const uint32_t[]){0, 7, 12});
        record_fine(&record, &setup.model);
        if (i % 2)
            ck_assert_uint_eq(record.report.cg_iterations_total, 0);
        else
            ck_assert_uint_gt(record.report.cg_iterations_total, 0);
    }
}

/* A stiff sheet in units of mass, time and length that are so many times smaller. */
static void run_in_units(double mass, double time, double length, double tolerance,
                         struct record *record)
{
    struct cloth_error error = {0};
    SETUP(setup_stiff(&setup, 12));
    mesh_free(&setup.cloth.mesh);
    ck_assert_int_eq(mesh_grid(&setup.cloth.mesh, length, length, 12, 12, MESH_SAME, &error), 0);
    const double force = mass * length / (time * time);
    setup.material.density *= mass / (length * length);
    setup.material.stretch *= force / length;
    setup.material.shear *= force / length;
    setup.material.bend *= force / length;
    setup.material.damping_stiffness *= time;
    setup.material.damping_viscous = 1e-3 * mass / time;
    setup.model.gravity[1] *= length / (time * time);
    setup.cloth.velocity[0] *= length / time;
    setup.model.h *= time;
    setup.model.end *= time;
    setup.model.fps /= time;
    setup.model.stop = MODEL_STOP_NORMALISED;
    setup.model.tolerance = tolerance;
    setup.model.preconditioner = MODEL_IC0_COARSE;
    record_fine(record, &setup.model);
}

/* By powers of two, of masses by powers of four, since matrices hold roots, every number is the
 * same but for its exponent. */
UNIT_TEST(normalised_in_any_units)
{
    static const double units[][3] = {{16, 1, 1}, {1, 4, 1}, {1, 1, 2}, {0.25, 8, 0.5}};
    UNIT_OWNED(record_free) struct record record = {0}, closer = {0};
    run_in_units(1, 1, 1, 1e-6, &record);
    run_in_units(1, 1, 1, 1e-7, &closer);
    ck_assert_uint_gt(closer.report.cg_iterations_total, record.report.cg_iterations_total);
    for (int i = 0; i < 4; i++) {
        UNIT_OWNED(record_free) struct record other = {0};
        run_in_units(units[i][0], units[i][1], units[i][2], 1e-6, &other);
        ck_assert_uint_eq(other.report.cg_iterations_total, record.report.cg_iterations_total);
        for (size_t k = 0; k < 3 * record.frames * record.vertices; k++)
            ck_assert_double_eq(other.position[k], units[i][2] * record.position[k]);
    }
}

UNIT_TEST(a_chain)
{
    struct setup setup;
    setup_weight(&setup);
    check(&setup);
}

/* A sheet that is thrown into itself: springs in compression everywhere, stiff ones. */
UNIT_TEST(compressed_springs)
{
    struct setup setup;
    setup_sheet(&setup, 12);
    setup.material.stretch = 1e5;
    setup.model.h = 0.01;
    setup.model.end = 0.05;
    setup_pin(&setup, 2, (const uint32_t[]){0, 11});
    setup_load(&setup, 140, 0, -1, -20);
    check(&setup);
}

/* The largest error of the run is told and kept. */
UNIT_TEST(stop_in_the_mass_norm)
{
    struct setup setup;
    for (int i = -1; i < KINDS; i++) {
        UNIT_OWNED(record_free) struct record loose = {0}, tight = {0};
        setup_stiff(&setup, 20);
        setup.model.preconditioner = i < 0 ? MODEL_PLAIN : kinds[i];
        setup.model.stop = MODEL_STOP_MASS_NORM;
        setup.model.tolerance = 0.01;
        record_run(&loose, &setup.model);
        setup.model.tolerance = 1e-9;
        record_run(&tight, &setup.model);
        ck_assert_msg(loose.code == 0, "%s", loose.error.text);
        ck_assert_msg(tight.code == 0, "%s", tight.error.text);
        ck_assert_double_le(loose.report.mass_norm_error, 0.01);
        ck_assert_double_gt(loose.report.mass_norm_error, 1e-9);
        ck_assert_double_le(tight.report.mass_norm_error, 1e-9);
        ck_assert_uint_lt(loose.report.cg_iterations_total, tight.report.cg_iterations_total);
        setup_free(&setup);
    }
}

UNIT_TEST(too_few_iterations)
{
    TRIAL(setup_stiff(&setup, 20));
    setup.model.preconditioner = MODEL_IC0_COARSE;
    setup.model.stop = MODEL_STOP_MASS_NORM;
    setup.model.tolerance = 1e-9;
    setup.model.max_iterations = 3;
    record_run(&record, &setup.model);
    ck_assert_int_eq(record.code, CLOTH_E_RUN);
    unit_says(record.error.text, "step 1: conjugate gradients stopped at");
}
