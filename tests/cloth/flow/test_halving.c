/* Steps that are given up and made again with half the length: that the run goes on from the state
 * before them, grows back, says how often, shows frames at the right times; and what it says where
 * no step is short enough. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A weight that falls until its edge is taut. */
static void setup_jerk(struct setup *setup)
{
    setup_weight(setup);
    setup->cloth.velocity[1] = -3;
    setup->model.h = 0.064;
    setup->model.end = 0.64;
    setup->model.fps = 1 / 0.064;
    setup->model.halving = true;
}

/* All is well: the same bits as without, also in frames, some of which show the begin of the step
 * that was accepted last. */
UNIT_LOOP(steps_that_are_fine, 0, MODEL_INTEGRATORS)
{
    UNIT_OWNED(record_free) struct record plain = {0}, halving = {0};
    SETUP(setup_sheet(&setup, 8));
    setup_pin(&setup, 1, (const uint32_t[]){0});
    setup.model.integrator = (enum model_integrator)_i;
    setup.model.fps = 300;
    record_fine(&plain, &setup.model);
    setup.model.halving = true;
    setup.model.stretch_growth = 0.1;
    setup.model.stretch_limit = 2;
    record_fine(&halving, &setup.model);
    ck_assert_uint_eq(halving.report.steps_halved, 0);
    ck_assert_uint_eq(halving.report.steps, 10);
    ck_assert(halving.report.state_hash == plain.report.state_hash);
    ck_assert_uint_eq(halving.frames, plain.frames);
    ck_assert_uint_eq(halving.frames, 4);
    ck_assert_mem_eq(halving.time, plain.time, plain.frames * sizeof(double));
    ck_assert_mem_eq(halving.position, plain.position,
                     3 * plain.vertices * plain.frames * sizeof(double));
}

/* All steps are of the same length h / 2^k in the end, and the result is bit for bit that of a run
 * with this h: a step that was given up has left nothing. */
UNIT_TEST(a_halved_run_is_one_with_a_smaller_h)
{
    for (int i = 0; i <= MODEL_INTEGRATORS; i++) { /* the last: Newton steps */
        UNIT_OWNED(record_free) struct record halved = {0}, small = {0};
        SETUP(setup_sheet(&setup, 8));
        setup.cloth.velocity[0] = 0.5;
        setup_pin(&setup, 1, (const uint32_t[]){0});
        const bool newton = i == MODEL_INTEGRATORS;
        setup.model.integrator = newton ? MODEL_BDF2 : (enum model_integrator)i;
        setup.model.newton_steps = newton ? 5 : 1;
        setup.model.newton_tolerance = 1e-6;
        setup.model.end = 0.004;
        setup.model.fps = 250;
        setup.model.halving = true;
        setup.model.stretch_growth = 1e-3; /* 0.5 m/s on edges of 1/7 m: less than 0.3 ms */
        record_fine(&halved, &setup.model);
        ck_assert_uint_gt(halved.report.steps_halved, 0);
        ck_assert_double_le(halved.report.shortest_step, 0.0005);
        ck_assert_double_eq(halved.report.simulated_seconds, 0.004);
        ck_assert_uint_eq(halved.shown, 4);
        setup.model.h = halved.report.shortest_step;
        setup.model.halving = false;
        setup.model.stretch_growth = 0;
        record_fine(&small, &setup.model);
        ck_assert_uint_eq(halved.report.steps, small.report.steps);
        ck_assert(halved.report.state_hash == small.report.state_hash);
        for (size_t c = 0; c < 3; c++)
            ck_assert_double_eq_tol(record_at(&halved, 1, 9, c), record_at(&small, 1, 9, c), 1e-5);
    }
}

/* In frame 1. */
static double distance(const struct record *a, const struct record *b)
{
    return fabs(record_at(a, 1, 1, 1) - record_at(b, 1, 1, 1));
}

/* Steps are short while the edge is jerked, and long again afterwards; until then the
 * run is nearer to one of short steps than one of long steps is. */
UNIT_TEST(an_edge_that_is_jerked)
{
    UNIT_OWNED(record_free) struct record plain = {0}, halved = {0}, small = {0};
    SETUP(setup_jerk(&setup));
    setup.model.halving = false;
    record_fine(&plain, &setup.model);
    setup.model.halving = true;
    setup.model.stretch_growth = 0.02;
    record_fine(&halved, &setup.model);
    ck_assert_uint_gt(halved.report.steps_halved, 2);
    ck_assert_uint_gt(halved.report.steps, 20);
    ck_assert_uint_lt(halved.report.steps, 320);
    setup.model.halving = false;
    setup.model.h /= 1024;
    record_fine(&small, &setup.model);
    ck_assert_uint_eq(plain.frames, small.frames);
    ck_assert_uint_eq(halved.frames, small.frames);
    ck_assert_double_lt(3 * distance(&halved, &small), distance(&plain, &small));
}

/* Frame k is shown after the step whose end is nearest to k / fps, whatever the steps are. */
UNIT_TEST(frames_between_shorter_steps)
{
    TRIAL(setup_jerk(&setup));
    setup.model.stretch_growth = 0.02;
    setup.model.fps = 23;
    record_fine(&record, &setup.model);
    double farthest = 0;
    for (size_t k = 0; k < record.frames; k++) {
        const double tick = record.time[k] / setup.model.h * 1024;
        ck_assert_double_eq_tol(tick, round(tick), 1e-6);
        ck_assert_double_ge(record.time[k], k ? record.time[k - 1] : 0);
        farthest = fmax(farthest, fabs(record.time[k] - (double)k / 23));
    }
    ck_assert_uint_eq(record.frames, 16); /* the last is nearer to the end than to what follows */
    ck_assert_double_le(farthest, setup.model.h / 2);
    /* The first jerk is at once: frame 1 lies among steps of less than h / 4. */
    ck_assert_double_le(fabs(record.time[1] - 1.0 / 23), setup.model.h / 8);
    ck_assert_double_gt(fabs(record.time[1] - setup.model.h), setup.model.h / 8);
}

/* The solve needs fewer iterations in a shorter step. */
UNIT_TEST(a_solve_that_converges_in_a_shorter_step)
{
    TRIAL(setup_sheet(&setup, 10));
    setup.model.h = 0.02;
    setup.model.end = 0.1;
    setup.model.fps = 50;
    setup.model.max_iterations = 6;
    setup.model.halving = true;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    record_fine(&record, &setup.model);
    ck_assert_uint_gt(record.report.steps_halved, 0);
    ck_assert_uint_gt(record.report.steps, 5);
    ck_assert_uint_le(record.report.cg_iterations_max, 6);
    ck_assert_uint_eq(record.report.halved_by[FLOW_CAUSE_SOLVE], record.report.steps_halved);
    ck_assert_uint_eq(record.frames, 6);
}

/* One cause alone. */
static void halved_by(const struct record *record, enum flow_cause cause)
{
    for (int i = 0; i < FLOW_CAUSES; i++)
        ck_assert_uint_eq(record->report.halved_by[i],
                          i == (int)cause ? record->report.steps_halved : 0);
}

static void fails(struct record *record, const struct model *model, const char *begin,
                  const char *part)
{
    record_run(record, model);
    ck_assert_int_eq(record->code, CLOTH_E_RUN);
    ck_assert_msg(strncmp(record->error.text, begin, strlen(begin)) == 0, "'%s' is not before '%s'",
                  begin, record->error.text);
    unit_says(record->error.text, part);
    unit_says(record->error.text, "halved down to h/1024");
    ck_assert_uint_eq(record->report.steps_halved, 10);
}

/* At h / 1024 it stops, and says why. */
UNIT_TEST(no_step_is_short_enough)
{
    TRIAL(setup_sheet(&setup, 4));
    setup.model.halving = true;
    setup_load(&setup, 3, 1e200, 0, 0);
    fails(&record, &setup.model, "step 1: conjugate gradients broke down", "not positive definite");
    halved_by(&record, FLOW_CAUSE_SOLVE);
    record_free(&record);
    setup_free(&setup);

    setup_weight(&setup);
    setup.model.halving = true;
    setup.model.stretch_limit = 1;
    fails(&record, &setup.model, "step 1: in 9.76563e-07 s the largest stretch of an edge grows",
          "up to 1 is allowed at most (time.stretch_limit)");
    ck_assert_uint_eq(record.report.steps, 0);
    halved_by(&record, FLOW_CAUSE_STRETCH);
    record_free(&record);
    setup_free(&setup);

    setup_sheet(&setup, 4);
    setup.model.integrator = MODEL_EXPLICIT_EULER;
    setup.model.halving = true;
    setup_load(&setup, 3, 1e200, 0, 0);
    fails(&record, &setup.model, "step 1: the velocity of vertex 4, counted from 1,",
          "the run diverged");
    halved_by(&record, FLOW_CAUSE_BOUNDS);
}

/* Explicit Euler is unstable at this h; it goes on with shorter steps, however small. */
UNIT_TEST(an_explicit_run_that_is_unstable)
{
    TRIAL(setup_sheet(&setup, 6));
    setup.model.integrator = MODEL_EXPLICIT_EULER;
    setup.model.h = 0.05;
    setup.model.end = 0.5;
    setup.model.fps = 20;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    setup.model.halving = true;
    setup.model.stretch_growth = 0.1;
    record_fine(&record, &setup.model);
    ck_assert_uint_gt(record.report.steps_halved, 0);
    ck_assert_double_lt(record.report.max_stretch, 3);
}

/* Two weights fly apart until their spring holds them, in steps of several lengths, while others
 * fall freely. BDF2 has the right velocity after any of them, which the step before would spoil if
 * it were taken for one of the same length. */
UNIT_TEST(bdf2_begins_anew_after_another_length)
{
    static const double vertices[] = {0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1};
    static const uint32_t edges[] = {0, 1, 2, 3};
    const double h = 0.01;
    double start[24] = {0};
    UNIT_OWNED(record_free) struct record r = {0};
    SETUP(setup_weight(&setup));
    setup_mesh(&setup, 4, vertices, 2, edges, 0, NULL);
    for (int i = 0; i < 12; i++)
        start[i / 3 * 6 + i % 3] = vertices[i];
    start[12 + 3] = -10;
    start[18 + 3] = 10;
    setup.cloth.start = start;
    setup.cloth.n_pins = 0;
    setup.material.damping_stiffness = 0.02;
    setup.model.integrator = MODEL_BDF2;
    setup.model.tolerance = 1e-13;
    setup.model.halving = true;
    setup.model.stretch_growth = 0.1;
    setup.model.h = h;
    setup.model.end = 100 * h;
    setup.model.fps = 1 / h;
    record_fine(&r, &setup.model);
    ck_assert_uint_gt(r.report.steps_halved, 0);
    ck_assert_uint_gt(r.report.steps, 100);
    ck_assert_double_lt(r.report.shortest_step, h);
    const double v = (record_at(&r, 100, 0, 1) - record_at(&r, 99, 0, 1)) / h;
    printf("# BDF2 in steps of %g to %g s: velocity of what falls off by %.2g m/s\n",
           r.report.shortest_step, h, v + 9.81 * 99.5 * h);
    ck_assert_double_eq_tol(v, -9.81 * 99.5 * h, 1e-9);
}

/* A weight that falls into its spring and comes back up: the spring is longest on the way. */
UNIT_TEST(the_largest_stretch_of_a_run)
{
    for (int judged = 0; judged < 2; judged++) {
        UNIT_OWNED(record_free) struct record record = {0};
        SETUP(setup_weight(&setup));
        setup.material.damping_stiffness = 0;
        setup.model.integrator = MODEL_VERLET;
        setup.model.stretch_limit = judged ? 1.1 : 0;
        setup.model.end = 0.314; /* 2 pi sqrt(m / k) */
        record_fine(&record, &setup.model);
        ck_assert_double_eq_tol(record.report.max_stretch, 1, 1e-5);
        if (judged)
            ck_assert_double_eq_tol(record.report.stretch_highest, 1 + 2 * 0.981 / 40, 1e-5);
        else
            ck_assert_double_nan(record.report.stretch_highest);
    }
}
