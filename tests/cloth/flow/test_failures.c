/* Every way to fail, each with a sentence that says where: inputs that cannot be run, runs that go
 * wrong, and what is known of them afterwards. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void says(const struct record *record, int code, const char *part)
{
    ck_assert_msg(record->code == code && record->error.code == code, "code %d, '%s'", record->code,
                  record->error.text);
    unit_says(record->error.text, part);
}

/* The sentence is the user's: nothing of tasks stands before it. */
static void begins(const struct record *record, const char *text)
{
    ck_assert_msg(strncmp(record->error.text, text, strlen(text)) == 0, "'%s' is not before '%s'",
                  text, record->error.text);
}

UNIT_TEST(divergence_names_step_block_and_frame)
{
    TRIAL(setup_sheet(&setup, 10));
    setup.model.integrator = MODEL_EXPLICIT_EULER;
    setup.model.h = 0.1;
    setup.model.end = 100;
    setup.model.fps = 10;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_RUN, "diverged");
    says(&record, CLOTH_E_RUN, "block ");
    ck_assert_uint_lt(record.report.steps, 1000);
    ck_assert_uint_gt(record.report.steps, 1);
    char step[64], frame[64];
    snprintf(step, sizeof step, "step %u:", (unsigned)record.report.steps + 1);
    snprintf(frame, sizeof frame, "the last frame is %u", (unsigned)record.frames - 1);
    begins(&record, step);
    says(&record, CLOTH_E_RUN, frame);
    ck_assert_uint_eq(record.report.last_frame, record.frames - 1);
}

/* Slow enough in each step, too far after the second. */
UNIT_TEST(a_run_that_leaves_the_world)
{
    for (int explicit = 0; explicit < 2; explicit ++) {
        UNIT_OWNED(record_free) struct record record = {0};
        SETUP(setup_sheet(&setup, 4));
        setup.model.integrator = explicit ? MODEL_EXPLICIT_EULER : MODEL_IMPLICIT_EULER;
        setup.model.gravity[1] = 0;
        setup.model.h = 1;
        setup.model.end = 10;
        setup.model.fps = 1;
        setup.cloth.velocity[2] = 9e5;
        record_run(&record, &setup.model);
        begins(&record, "step 2: the position of vertex");
        says(&record, CLOTH_E_RUN, "the last frame is 1");
    }
}

/* The square of the right-hand side is infinite: no residual may pass for small. */
UNIT_TEST(a_load_beyond_all_measure)
{
    TRIAL(setup_sheet(&setup, 4));
    setup_load(&setup, 3, 1e200, 0, 0);
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_RUN, "matrix is not positive definite");
    begins(&record, "step 1: conjugate gradients broke down");
}

UNIT_TEST(a_solve_that_does_not_converge)
{
    TRIAL(setup_sheet(&setup, 10));
    setup.model.max_iterations = 2;
    setup.model.tolerance = 0.01;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_RUN, "step 1: conjugate gradients");
    says(&record, CLOTH_E_RUN, "after 2 iterations");
    says(&record, CLOTH_E_RUN, "the last frame is 0");
}

UNIT_TEST(a_frame_that_cannot_be_written)
{
    int rank, ranks;
    UNIT_OWNED(record_free) struct record record = {.break_frame = 4};
    SETUP(setup_sheet(&setup, 6));
    setup.model.end = 1;
    record_run(&record, &setup.model);
    begins(&record, "the disk is full: ");
    record_mpi(&rank, &ranks);
    if (rank == 0) /* it knows all of it */
        says(&record, CLOTH_E_IO, "x, that is where; the last");
    says(&record, CLOTH_E_IO, "the last frame is 3");
    ck_assert_uint_eq(record.frames, 4);
    ck_assert_uint_lt(record.report.steps, 100);
}

UNIT_TEST(pins_and_loads_outside)
{
    TRIAL(setup_sheet(&setup, 3));
    setup_pin(&setup, 1, (const uint32_t[]){9});
    setup.pin.pick.place = (char[]){"a.yaml:12:5"};
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_INPUT, "a.yaml:12:5: a pin of cloth 'test' names vertex 9");
    says(&record, CLOTH_E_INPUT, "0 to 8");
    record_free(&record);
    setup.pin = (struct model_pin){.pick = {.kind = MODEL_PICK_BOX,
                                            .box = {{2, 0, 0}, {3, 1, 1}},
                                            .place = (char[]){"a.yaml:13:5"}}};
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_INPUT, "a.yaml:13:5: the box of a pin of cloth 'test' holds no vertex");
    record_free(&record);
    setup.cloth.n_pins = 0;
    setup_load(&setup, 9, 0, 1, 0);
    setup.load.pick.place = (char[]){"a.yaml:14:5"};
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_INPUT, "a.yaml:14:5: a load of cloth 'test' names vertex 9");
    record_free(&record);
    setup.cloth.n_loads = 0;
    struct model_start start = {.pick = {.n_vertices = 1, .vertices = (uint32_t[]){9}},
                                .transform = mesh_identity};
    setup.cloth.starts = &start;
    setup.cloth.n_starts = 1;
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_INPUT, "a start of cloth 'test' names vertex 9; its mesh has");
}

UNIT_TEST(pins_by_place)
{
    struct record record = {0};
    SETUP(setup_sheet(&setup, 3));
    setup.cloth.n_pins = 2;
    struct model_pin pins[2] = {
        {.pick = {.kind = MODEL_PICK_NEAREST, .point = {-0.4, 2, 0.4}}},
        {.pick = {.kind = MODEL_PICK_BOX, .box = {{0.1, -1, -1}, {1, 1, 0}}}}};
    setup.cloth.pins = pins;
    record_fine(&record, &setup.model);
    for (size_t v = 0; v < 9; v++) /* row-major, from (-0.5, -0.5) */
        ck_assert_int_eq(record_at(&record, 10, v, 1) == 0, v == 6 || v == 2 || v == 5);
    record_free(&record);
    pins[0].pick.radius = 0.1; /* nothing but the nearest one, far outside */
    pins[1].pick = (struct model_pick){.kind = MODEL_PICK_NEAREST,
                                       .point = {0.5, 0, -0.5},
                                       .radius = 0.5}; /* and two neighbours */
    record_fine(&record, &setup.model);
    for (size_t v = 0; v < 9; v++)
        ck_assert_int_eq(record_at(&record, 10, v, 1) == 0, v == 6 || v == 2 || v == 5 || v == 1);
    record_free(&record);
    setup.cloth.pins = &setup.pin;
}

/* It lifts the cloth there in one step. */
UNIT_TEST(a_plane_beyond_the_world)
{
    TRIAL(setup_sheet(&setup, 3));
    setup.plane = PLANE(0, 1e200, 0, 0, 1, 0);
    setup.model.n_obstacles = 1;
    record_run(&record, &setup.model);
    begins(&record, "step 1: the position of vertex");
}

/* Scenes never ask for it. */
UNIT_TEST(bending_that_does_not_suit)
{
    TRIAL(setup_sheet(&setup, 3));
    setup.material.bending = MODEL_QUADRATIC;
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_INPUT, "a matrix of springs cannot hold hinges; ");
}

/* A mesh that no file has. */
UNIT_TEST(a_vertex_that_is_nowhere)
{
    TRIAL(setup_sheet(&setup, 3));
    setup.cloth.mesh.position[3 * 7 + 1] = NAN;
    record_run(&record, &setup.model);
    says(&record, CLOTH_E_INPUT, "vertex 8 of cloth 'test' starts at (0, ");
}

UNIT_TEST(more_ranks_than_blocks)
{
    struct cloth_error error = {0};
    struct flow *flow = NULL;
    SETUP(setup_sheet(&setup, 8));
    setup.model.grain = 30; /* 64 vertices, 3 blocks */
    ck_assert_int_eq(flow_prepare(&flow, &setup.model, 3, &error), 0);
    flow_free(flow);
    ck_assert_int_eq(flow_prepare(&flow, &setup.model, 4, &error), CLOTH_E_INPUT);
    ck_assert_ptr_null(flow);
    ck_assert_msg(strstr(error.text, "4 ranks") && strstr(error.text, "blocks (3)"), "%s",
                  error.text);
}
