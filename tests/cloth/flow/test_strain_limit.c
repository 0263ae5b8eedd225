/* Limits of strain in runs, against closed forms: how far a chain hangs, the fastest vibration, and
 * that a step that goes far over a limit is made again. */
#include "cloth/flow/run/source.h"
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINKS = 10 };
static const double M = 0.002, K = 40, LIMIT = 400, AT = 0.01, LENGTH = 0.1;

/* Hangs down from vertex 0; in blocks of 3. */
static void chain(struct setup *s)
{
    setup_chain(s, LINKS, 0, -LENGTH, M, K);
    s->material.damping_stiffness = 0.002;
    s->material.limit_strain = AT;
    s->material.limit_stiffness = LIMIT;
    s->model.format = SOLVE_HALF;
    s->model.grain = 3;
}

/* The length of a link under a tension: by its spring alone up to the limit, by both beyond. */
static double elongation(double tension)
{
    const double alone = tension / K, free = AT * LENGTH;
    return alone <= free ? alone : (tension + LIMIT * free) / (K + LIMIT);
}

/* _i: linear steps, Newton steps, Newton steps of BDF2. */
UNIT_LOOP(a_chain_hangs_as_far_as_both_springs_let_it, 0, 3)
{
    double worst = 0;
    int beyond = 0;
    TRIAL(chain(&setup));
    setup.material.damping_mass = 40;
    setup.model.h = 0.01;
    setup.model.end = 4;
    setup.model.fps = 0.25;
    setup.model.newton_steps = _i > 0 ? 5 : 0;
    setup.model.newton_tolerance = 1e-6;
    setup.model.integrator = _i == 2 ? MODEL_BDF2 : MODEL_IMPLICIT_EULER;
    record_run(&record, &setup.model);
    ck_assert_msg(!record.code, "%s", record.error.text);
    for (uint32_t i = 0; i < LINKS; i++) {
        const double length = record_at(&record, 1, i, 1) - record_at(&record, 1, i + 1, 1);
        const double expected = elongation(9.81 * M * (LINKS - i));
        worst = fmax(worst, fabs(length - LENGTH - expected));
        beyond += expected > AT * LENGTH;
    }
    printf("# %d of %d links beyond their limit, lengths off by %.1e m\n", beyond, LINKS, worst);
    ck_assert_int_gt(beyond, 2);
    ck_assert_int_lt(beyond, LINKS - 1);
    ck_assert_double_le(worst, 1e-9);
}

/* A limit that is not reached changes no bit. */
UNIT_TEST(below_its_limit_an_edge_is_free)
{
    struct record record[2] = {{0}};
    SETUP(setup_weight(&setup));
    setup.model.format = SOLVE_HALF;
    setup.model.end = 0.05;
    for (int i = 0; i < 2; i++) {
        setup.material.limit_strain = 0.1; /* it swings to 5 % */
        setup.material.limit_stiffness = i ? 1e4 : 0;
        record_run(record + i, &setup.model);
        ck_assert_msg(!record[i].code, "%s", record[i].error.text);
    }
    ck_assert_uint_eq(record[0].report.state_hash, record[1].report.state_hash);
    for (int i = 0; i < 2; i++)
        record_free(record + i);
}

UNIT_TEST(a_free_chain_keeps_its_momentum)
{
    double before = 0, after = 0, longest = 0;
    TRIAL(chain(&setup));
    setup.cloth.n_pins = 0;
    setup.model.gravity[1] = 0;
    setup.model.end = 0.2;
    setup.model.fps = 5;
    setup.cloth.start = calloc(6 * (LINKS + 1), sizeof *setup.cloth.start);
    ck_assert_ptr_nonnull(setup.cloth.start);
    for (size_t i = 0; i <= LINKS; i++) /* uneven, up to 20 % over its length */
        setup.cloth.start[6 * i + 1] = -LENGTH * ((double)i + 0.01 * (double)(i * i));
    record_run(&record, &setup.model);
    ck_assert_msg(!record.code, "%s", record.error.text);
    for (size_t i = 0; i <= LINKS; i++) {
        before += record_at(&record, 0, i, 1);
        after += record_at(&record, 1, i, 1);
        longest = fmax(longest, fabs(record_at(&record, 0, i, 1) - record_at(&record, 1, i, 1)));
    }
    printf("# vertices moved by up to %.3f m, their centre by %.1e m; momentum lost %.1e kg m/s\n",
           longest, (after - before) / (LINKS + 1), record.report.momentum_lost);
    ck_assert_double_gt(longest, 0.01);
    ck_assert_double_le(fabs(after - before) / (LINKS + 1), 1e-14);
    ck_assert_double_le(record.report.momentum_lost, 1e-14);
    free(setup.cloth.start);
}

/* Explicit steps are told of limits as if they were reached: K + LIMIT of one link, one end of
 * which is held. */
UNIT_TEST(the_longest_step_counts_limits)
{
    struct flow_limit limit;
    SETUP(setup_weight(&setup));
    UNIT_OWNED(flow_source_free) struct flow_source source;
    setup.model.format = SOLVE_HALF;
    setup.material.limit_strain = 0.1;
    setup.material.limit_stiffness = LIMIT;
    UNIT_FINE(flow_source_make(&source, &setup.model, 1, &error));
    UNIT_FINE(flow_limit_find(&source, &limit, &error));
    ck_assert_double_eq_tol(limit.omega, sqrt((40 + LIMIT) / 0.1), 1e-9);
}

/* Thrown down at 5 m/s, the weight comes in one step of 20 ms far over a limit that the matrix of
 * this step has not: 100 times its energy. The step is made again until the matrix has it. */
UNIT_TEST(steps_far_over_a_limit_are_halved)
{
    TRIAL(setup_weight(&setup));
    setup.model.format = SOLVE_HALF;
    setup.model.h = 0.02;
    setup.model.end = 0.2;
    setup.model.fps = 5;
    setup.model.halving = true;
    setup.model.energy_growth = 0.005;
    setup.model.stretch_limit = 100; /* so that stretches are reported */
    setup.model.gravity[1] = 0;
    setup.cloth.velocity[1] = -5;
    setup.material.limit_strain = 0.05;
    setup.material.limit_stiffness = 1e5;
    record_run(&record, &setup.model);
    ck_assert_msg(!record.code, "%s", record.error.text);
    const double motion = 0.5 * 0.1 * 25, max = 0.05 + sqrt(2 * motion / 1e5);
    printf("# halved %u times for its energy, stretched to %.4f; %.4f by energy alone\n",
           (unsigned)record.report.halved_by[FLOW_CAUSE_ENERGY], record.report.stretch_highest,
           1 + max);
    ck_assert_uint_gt(record.report.halved_by[FLOW_CAUSE_ENERGY], 0);
    ck_assert_double_gt(record.report.stretch_highest, 1.05);
    ck_assert_double_le(record.report.stretch_highest, 1 + 1.01 * max);
}

static void count(void *to, const struct element *element)
{
    uint32_t *n = to;
    *n += element->corners == 2;
}

/* Those along its threads: diagonals of cells are no edges of the cloth. */
UNIT_TEST(edges_of_a_grid)
{
    for (int triangles = 0; triangles < 2; triangles++) {
        uint32_t n = 0;
        SETUP(setup_sheet(&setup, 5));
        UNIT_OWNED(element_cloths_free) struct element_cloths cloths;
        setup.model.format = SOLVE_HALF;
        setup.material.model = triangles ? MODEL_TRIANGLES : MODEL_SPRINGS;
        setup.material.limit_stiffness = 1;
        UNIT_FINE(element_cloths_make(&cloths, &setup.model, &error));
        element_each(&cloths, count, &n);
        ck_assert_uint_eq(n, 2 * 5 * 4 + (triangles ? 4 * 4 : 0));
    }
}
