/* A run's work besides moving cloth: frames and their times, the hash, counts of iterations, stops,
 * pins and vertices by number. */
#include "cloth/flow/state/state.h"
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>
#include <xxhash.h>

/* Frame k after the step nearest to k / fps; h and fps that do not divide each other. */
UNIT_TEST(frames_at_their_steps)
{
    TRIAL(setup_sheet(&setup, 5));
    setup.model.integrator = MODEL_EXPLICIT_EULER;
    setup.model.h = 0.003;
    setup.model.end = 0.1; /* 33.3 steps: 33 are made */
    setup.model.fps = 60;  /* 16.67 ms, 5.56 steps */
    setup.material.stretch = setup.material.shear = setup.material.bend = 0;
    record_fine(&record, &setup.model);
    ck_assert_uint_eq(record.report.steps, 33);
    ck_assert_double_eq_tol(record.report.simulated_seconds, 0.099, 1e-15);
    const double steps[] = {0, 6, 11, 17, 22, 28, 33};
    ck_assert_uint_eq(record.frames, 7);
    ck_assert_uint_eq(record.report.frames, 7);
    ck_assert_uint_eq(record.report.last_frame, 6);
    for (size_t k = 0; k < 7; k++) {
        const double n = steps[k];
        ck_assert_double_eq_tol(record.time[k], n * 0.003, 1e-15);
        ck_assert_double_eq_tol(record_at(&record, k, 7, 1),
                                -9.81 * 0.003 * 0.003 * n * (n - 1) / 2, 1e-13);
    }
    ck_assert_uint_eq(record.shown, 33);
}

/* No step at all: the hash is that of the start, which is known. Vertex 2 is held, vertex 1 not
 * used. */
UNIT_TEST(hash_of_positions_then_velocities)
{
    static const double vertices[5][3] = {{0, 0, 0.5}, {9, 8, 7}, {1, 0, 0}, {0, 0, 1}, {1, 2, 1}};
    static const uint32_t triangles[] = {0, 2, 3, 2, 4, 3};
    TRIAL(setup_sheet(&setup, 2));
    setup_mesh(&setup, 5, vertices[0], 0, NULL, 2, triangles);
    setup.model.grain = 2;
    setup.model.h = 1;
    setup.model.end = 0.4;
    setup.cloth.velocity[0] = 0.25;
    setup.cloth.velocity[2] = -3;
    setup_pin(&setup, 1, (const uint32_t[]){2});
    record_fine(&record, &setup.model);
    double state[2][5][3];
    memcpy(state[0], vertices, sizeof vertices);
    for (size_t v = 0; v < 5; v++)
        for (size_t c = 0; c < 3; c++)
            state[1][v][c] = v == 1 || v == 2 ? 0 : setup.cloth.velocity[c];
    ck_assert_uint_eq(record.report.steps, 0);
    ck_assert_uint_eq(record.report.state_hash,
                      XXH64(state, sizeof state, 0)); /* little-endian machines */
}

UNIT_LOOP(count_makes_exactly_so_many_iterations, MODEL_PLAIN, MODEL_IC0_COARSE + 1)
{
    TRIAL(setup_sheet(&setup, 10));
    setup.model.preconditioner = (enum model_preconditioner)_i;
    setup.model.stop = MODEL_STOP_COUNT;
    setup.model.max_iterations = 7;
    record_fine(&record, &setup.model);
    ck_assert_uint_eq(record.report.cg_iterations_total, 70);
    ck_assert_uint_eq(record.report.cg_iterations_max, 7);
}

/* Without forces the right-hand side is zero: no iteration is made, and where a count asks for them
 * they change nothing. */
UNIT_TEST(nothing_to_do)
{
    for (int count = 0; count < 2; count++) {
        UNIT_OWNED(record_free) struct record record = {0};
        SETUP(setup_sheet(&setup, 6));
        setup.model.gravity[1] = 0;
        if (count) {
            setup.model.stop = MODEL_STOP_COUNT;
            setup.model.max_iterations = 5;
        }
        record_fine(&record, &setup.model);
        ck_assert_uint_eq(record.report.cg_iterations_total, count ? 50 : 0);
        for (size_t v = 0; v < record.vertices; v++)
            ck_assert_double_eq(record_at(&record, 10, v, 1), 0);
    }
}

/* From rest b = h (m g + load): an absolute tolerance of 0.01 |b| is a relative one of 0.01. */
UNIT_TEST(absolute_tolerance)
{
    struct record record[2] = {{0}};
    double mass[36] = {0}, square = 0;
    SETUP(setup_sheet(&setup, 6));
    setup.model.end = setup.model.h;
    setup_masses(&setup, mass);
    setup_load(&setup, 8, 0.04, 0, 0);
    for (size_t v = 0; v < 36; v++)
        square += 9.81 * mass[v] * 9.81 * mass[v];
    square += 0.04 * 0.04;
    for (int i = 0; i < 2; i++) {
        setup.model.stop = i ? MODEL_STOP_ABSOLUTE : MODEL_STOP_RELATIVE;
        setup.model.tolerance = i ? 0.01 * setup.model.h * sqrt(square) : 0.01;
        record_fine(record + i, &setup.model);
    }
    ck_assert_uint_gt(record[0].report.cg_iterations_total, 1);
    ck_assert_uint_eq(record[1].report.cg_iterations_total, record[0].report.cg_iterations_total);
    ck_assert_uint_eq(record[1].report.state_hash, record[0].report.state_hash);
    record_free(record);
    record_free(record + 1);
}

/* Asked for after step 1, when step 2 has begun, the stop is noted at the end of step 2; step 3 has
 * begun by then. Frames are 1000 steps apart: the last one shows where the run stops. */
UNIT_TEST(stop_finishes_the_step)
{
    UNIT_OWNED(record_free) struct record record = {.stop_after = 1};
    SETUP(setup_sheet(&setup, 6));
    setup.model.fps = 1;
    setup.model.end = 1;
    record_fine(&record, &setup.model);
    ck_assert(record.report.stopped);
    ck_assert_uint_eq(record.report.steps, 3);
    ck_assert_uint_eq(record.frames, 2);
    ck_assert_uint_eq(record.report.last_frame, 1);
    ck_assert_double_eq(record.time[1], 3 * setup.model.h);
    ck_assert_double_eq(record.report.simulated_seconds, record.time[1]);
}

UNIT_TEST(unused_vertices_stay)
{
    static const double vertices[] = {0, 0, 0, 9, 8, 7, 1, 0, 0, 0, 0, 1};
    static const uint32_t triangle[] = {0, 2, 3};
    TRIAL(setup_sheet(&setup, 2));
    setup_mesh(&setup, 4, vertices, 0, NULL, 1, triangle);
    setup.model.grain = 2;
    setup.cloth.velocity[0] = 1;
    record_fine(&record, &setup.model);
    for (size_t f = 0; f < record.frames; f++)
        for (size_t c = 0; c < 3; c++)
            ck_assert_double_eq(record_at(&record, f, 1, c), vertices[3 + c]);
    ck_assert_double_eq_tol(record_at(&record, 10, 3, 0), 0.01, 1e-12);
}

/* Two cloths in one run know nothing of each other; vertices are numbered one cloth after the
 * other. */
UNIT_TEST(two_cloths)
{
    UNIT_OWNED(setup_free) struct setup setup, other;
    UNIT_OWNED(record_free) struct record record = {0};
    setup_sheet(&setup, 5);
    setup_sheet(&other, 4);
    other.cloth.velocity[0] = 2;
    struct model_cloth cloths[2] = {setup.cloth, other.cloth};
    setup.model.cloths = cloths;
    setup.model.n_cloths = 2;
    setup.model.tolerance = 1e-13;
    record_fine(&record, &setup.model);
    ck_assert_uint_eq(record.report.vertices, 41);
    ck_assert_uint_eq(record.report.triangles, 32 + 18);
    const double drop = 9.81 * 1e-6 * 55;
    for (size_t v = 0; v < 41; v++) {
        ck_assert_double_eq_tol(record_at(&record, 10, v, 0) - record_at(&record, 0, v, 0),
                                v < 25 ? 0 : 0.02, 1e-12);
        ck_assert_double_eq_tol(record_at(&record, 10, v, 1), -drop, 1e-12);
    }
}
