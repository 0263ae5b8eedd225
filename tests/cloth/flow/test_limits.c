/* The bound of the fastest vibration against a chain's, whose frequencies are known; what a run
 * says of a step that is too long; and that such a step is, on the chain, just too long. The scale
 * of energies that steps may gain. */
#include "cloth/flow/run/source.h"
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINKS = 40 };
static const double M = 0.01, K = 250, LENGTH = 0.1; /* kg, N/m, m of a link */

/* The fastest of a chain with one end held: 2 sqrt(k / m) sin((2 n - 1) pi / (4 n + 2)). */
static double fastest(void)
{
    return 2 * sqrt(K / M) * cos(acos(-1) / (2 * LINKS + 1));
}

/* Along x, without gravity; moved by `amplitude` m/s in its fastest vibration. */
static void chain(struct setup *s, double amplitude)
{
    setup_chain(s, LINKS, LENGTH, 0, M, K);
    s->model.gravity[1] = 0;
    s->model.grain = 10;
    s->cloth.start = calloc(6 * (LINKS + 1), sizeof *s->cloth.start);
    ck_assert_ptr_nonnull(s->cloth.start);
    for (size_t i = 0; i <= LINKS; i++) {
        s->cloth.start[6 * i] = LENGTH * (double)i;
        s->cloth.start[6 * i + 3] =
            amplitude * sin((double)i * (2 * LINKS - 1) * acos(-1) / (2 * LINKS + 1));
    }
}

static void chain_free(struct setup *s)
{
    free(s->cloth.start);
    setup_free(s);
}

static struct flow_limit limit_of(const struct setup *s)
{
    struct flow_source source;
    struct flow_limit limit;
    UNIT_FINE(flow_source_make(&source, &s->model, 1, &error));
    UNIT_FINE(flow_limit_find(&source, &limit, &error));
    flow_source_free(&source);
    return limit;
}

UNIT_TEST(bound_of_a_chain)
{
    UNIT_OWNED(chain_free) struct setup setup;
    chain(&setup, 0);
    setup.material.damping_stiffness = 0.003;
    setup.material.damping_viscous = 0.02;
    setup.material.damping_mass = 0.5;
    const struct flow_limit limit = limit_of(&setup);
    printf("# fastest vibration of a chain: %.6f rad/s, bound %.6f\n", fastest(), limit.omega);
    ck_assert_double_ge(limit.omega, fastest());
    ck_assert_double_le(limit.omega, 1.001 * fastest());
    ck_assert_double_eq_tol(limit.drag, 0.02 / M + 0.5, 1e-12);
    ck_assert_double_eq_tol(limit.along, 0.003 * limit.omega * limit.omega, 1e-6);
    ck_assert_str_eq(limit.cloth->name, "test");
}

/* Turned and at another place, and with masses that differ, it is the same kind of bound: never
 * below what the chain can do, here by its two-body vibrations. */
UNIT_TEST(bound_of_a_sheet)
{
    SETUP(setup_sheet(&setup, 12));
    const struct flow_limit limit = limit_of(&setup);
    const double inner = 0.2 / (11 * 11); /* kg; a vertex on a border has half of it */
    /* Along x: 2 springs of 50, 4 diagonals of 25 by half. */
    ck_assert_double_ge(limit.omega * limit.omega, 4 * 50 / inner);
    ck_assert_double_le(limit.omega * limit.omega, 2 * (2 * 50 + 4 * 25) * 1.3 / inner);
}

/* How far anything has moved along the chain after 4000 steps. */
static double moved(enum model_integrator integrator, double stiffness, double h)
{
    struct setup setup;
    struct record record = {0};
    double max = 0;
    chain(&setup, 1e-6);
    setup.material.damping_stiffness = stiffness;
    setup.model.integrator = integrator;
    setup.model.h = h;
    setup.model.end = 4000 * h;
    setup.model.fps = 1 / setup.model.end;
    record_run(&record, &setup.model);
    for (size_t v = 0; !record.code && v <= LINKS; v++)
        max = fmax(max, fabs(record_at(&record, 1, v, 0) - LENGTH * (double)v));
    if (record.code)
        max = INFINITY;
    record_free(&record);
    chain_free(&setup);
    return max;
}

UNIT_LOOP(limits_are_where_runs_break, 0, 4)
{
    static const struct {
        enum model_integrator integrator;
        double zeta, number;
    } rows[] = {{MODEL_SYMPLECTIC_EULER, 0, 2},
                {MODEL_SYMPLECTIC_EULER, 0.5, 1.2360679774997898}, /* 4 / (1 + sqrt 5) */
                {MODEL_VERLET, 0, 2},
                {MODEL_RK4, 0, 2.8284271247461903}};
    UNIT_OWNED(chain_free) struct setup setup;
    chain(&setup, 0);
    const double stiffness = 2 * rows[_i].zeta / limit_of(&setup).omega;
    setup.material.damping_stiffness = stiffness;
    const struct flow_limit limit = limit_of(&setup);
    const double h = flow_limit_of(&limit, rows[_i].integrator);
    ck_assert_double_eq_tol(h, rows[_i].number / limit.omega, 1e-12);
    ck_assert_double_lt(moved(rows[_i].integrator, stiffness, 0.99 * h), 1e-6);
    ck_assert_double_gt(moved(rows[_i].integrator, stiffness, 1.02 * h), 1e-3);
}

/* All vertices of a cloth are other names of a sheet's, which has their masses. */
UNIT_TEST(a_doubled_layer_has_a_scale_of_energy)
{
    static const uint32_t edge[] = {0, 1};
    uint32_t names[] = {0, 1};
    struct model_weld weld = {.pairs = {.end = {{.cloth = 0, .n = 2, .vertices = names},
                                                {.cloth = 1, .n = 2, .vertices = names}}},
                              .tolerance = 1e-6};
    struct flow_source source;
    double release[2];
    SETUP(setup_sheet(&setup, 3));
    struct model_cloth cloths[2] = {setup.cloth, setup.cloth};
    UNIT_FINE(mesh_inline(&cloths[1].mesh, 2, cloths[0].mesh.position, 1, edge, 0, NULL, &error));
    cloths[1].mass_per_vertex = 1e-15;
    setup.model.cloths = cloths;
    setup.model.welds = &weld;
    for (uint32_t i = 0; i < 2; i++) {
        setup.model.n_cloths = 1 + i;
        setup.model.n_welds = i;
        UNIT_FINE(flow_source_make(&source, &setup.model, 1, &error));
        release[i] = flow_source_release(&source);
        flow_source_free(&source);
    }
    ck_assert_double_gt(release[0], 0);
    ck_assert_double_eq_tol(release[1], release[0], 1e-9 * release[0]);
    mesh_free(&cloths[1].mesh);
}
