/* The bound of the fastest vibration against a chain's, whose frequencies are known; what a run
 * says of a step that is too long; and that such a step is, on the chain, just too long. The scale
 * of energies that steps may gain. */
#include "cloth/flow/run/source.h"
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINKS = 40 };
static const double M = 0.01, K = 250;

/* The fastest of a chain with one end held: 2 sqrt(k / m) sin((2 n - 1) pi / (4 n + 2)). */
static double fastest(void)
{
    return 2 * sqrt(K / M) * cos(acos(-1) / (2 * LINKS + 1));
}

/* Along x, without gravity; moved by `amplitude` m/s in its fastest vibration. */
static void chain(struct setup *s, double amplitude)
{
    double vertices[3 * (LINKS + 1)] = {0};
    uint32_t edges[2 * LINKS];
    struct cloth_error error = {0};
    setup_weight(s);
    mesh_free(&s->cloth.mesh);
    for (uint32_t i = 0; i <= LINKS; i++)
        vertices[3 * i] = 0.1 * i;
    for (uint32_t i = 0; i < LINKS; i++) {
        edges[2 * i] = i;
        edges[2 * i + 1] = i + 1;
    }
    ck_assert_int_eq(
        mesh_inline(&s->cloth.mesh, LINKS + 1, vertices, LINKS, edges, 0, NULL, &error), 0);
    s->cloth.mass_per_vertex = M;
    s->material.ea = K * 0.1; /* each link is 0.1 m long */
    s->material.damping_stiffness = 0;
    s->model.gravity[1] = 0;
    s->model.grain = 10;
    s->cloth.start = calloc(6 * (LINKS + 1), sizeof *s->cloth.start);
    ck_assert_ptr_nonnull(s->cloth.start);
    for (size_t i = 0; i <= LINKS; i++) {
        memcpy(s->cloth.start + 6 * i, vertices + 3 * i, 3 * sizeof *vertices);
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
    struct cloth_error error = {0};
    ck_assert_msg(!flow_source_make(&source, &s->model, 1, &error), "%s", error.text);
    ck_assert_int_eq(flow_limit_find(&source, &limit, &error), 0);
    flow_source_free(&source);
    return limit;
}

START_TEST(bound_of_a_chain)
{
    struct setup setup;
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
    chain_free(&setup);
}
END_TEST

/* Turned and at another place, and with masses that differ, it is the same kind of bound: never
 * below what the chain can do, here by its two-body vibrations. */
START_TEST(bound_of_a_sheet)
{
    struct setup setup;
    setup_sheet(&setup, 12);
    const struct flow_limit limit = limit_of(&setup);
    const double inner = 0.2 / (11 * 11); /* kg; a vertex on a border has half of it */
    /* Along x: 2 springs of 50, 4 diagonals of 25 by half. */
    ck_assert_double_ge(limit.omega * limit.omega, 4 * 50 / inner);
    ck_assert_double_le(limit.omega * limit.omega, 2 * (2 * 50 + 4 * 25) * 1.3 / inner);
    setup_free(&setup);
}
END_TEST

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
        max = fmax(max, fabs(record_at(&record, 1, v, 0) - 0.1 * (double)v));
    if (record.code)
        max = INFINITY;
    record_free(&record);
    chain_free(&setup);
    return max;
}

START_TEST(limits_are_where_runs_break)
{
    static const struct {
        enum model_integrator integrator;
        double zeta, number;
    } rows[] = {{MODEL_SYMPLECTIC_EULER, 0, 2},
                {MODEL_SYMPLECTIC_EULER, 0.5, 1.2360679774997898}, /* 4 / (1 + sqrt 5) */
                {MODEL_VERLET, 0, 2},
                {MODEL_RK4, 0, 2.8284271247461903}};
    struct setup setup;
    chain(&setup, 0);
    const double stiffness = 2 * rows[_i].zeta / limit_of(&setup).omega;
    setup.material.damping_stiffness = stiffness;
    const struct flow_limit limit = limit_of(&setup);
    const double h = flow_limit_of(&limit, rows[_i].integrator);
    ck_assert_double_eq_tol(h, rows[_i].number / limit.omega, 1e-12);
    ck_assert_double_lt(moved(rows[_i].integrator, stiffness, 0.99 * h), 1e-6);
    ck_assert_double_gt(moved(rows[_i].integrator, stiffness, 1.02 * h), 1e-3);
    chain_free(&setup);
}
END_TEST

/* The warning of a model, or the empty text. */
static void warning(const struct setup *s, char *text, size_t size)
{
    struct flow *flow;
    struct cloth_error error = {0};
    ck_assert_msg(!flow_prepare(&flow, &s->model, 1, &error), "%s", error.text);
    snprintf(text, size, "%s", flow_warning(flow, 0) ? flow_warning(flow, 0) : "");
    ck_assert_ptr_null(flow_warning(flow, 1));
    flow_free(flow);
}

START_TEST(warnings)
{
    struct setup setup;
    char text[600], place[] = "scene.yaml:9:12";
    chain(&setup, 0);
    setup.model.h = 0.01;
    setup.model.h_place = place;
    warning(&setup, text, sizeof text);
    ck_assert_str_eq(text, ""); /* implicit */
    setup.model.integrator = MODEL_VERLET;
    warning(&setup, text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "scene.yaml:9:12: steps of 0.01 s are beyond the limit of "
                                       "verlet, 0.00632456 s: the fastest vibration (up to "
                                       "316.228 rad/s, at vertex "));
    setup.model.h = 0.0063;
    warning(&setup, text, sizeof text);
    ck_assert_str_eq(text, "");
    setup.model.integrator = MODEL_RK4;
    setup.model.h = 0.009;
    warning(&setup, text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "limit of rk4, 0.00894427 s"));
    setup.model.integrator = MODEL_EXPLICIT_EULER;
    setup.model.h = 0.001;
    warning(&setup, text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "no step is short enough for explicit_euler"));
    ck_assert_ptr_nonnull(strstr(text, "can grow by 4.88088 %")); /* sqrt(1.1) - 1 */
    setup.material.damping_stiffness = 0.0011;                    /* 2 zeta / omega */
    warning(&setup, text, sizeof text);
    ck_assert_str_eq(text, "");
    setup.material.damping_stiffness = 0.0009;
    warning(&setup, text, sizeof text);
    ck_assert_ptr_nonnull(strstr(text, "limit of explicit_euler, 0.0009 s"));
    chain_free(&setup);
}
END_TEST

/* All vertices of a cloth are other names of a sheet's, which has their masses. */
START_TEST(a_doubled_layer_has_a_scale_of_energy)
{
    static const uint32_t edge[] = {0, 1};
    uint32_t names[] = {0, 1};
    struct model_weld weld = {.pairs = {.end = {{.cloth = 0, .n = 2, .vertices = names},
                                                {.cloth = 1, .n = 2, .vertices = names}}},
                              .tolerance = 1e-6};
    struct setup setup;
    struct flow_source source;
    struct cloth_error error = {0};
    double release[2];
    setup_sheet(&setup, 3);
    struct model_cloth cloths[2] = {setup.cloth, setup.cloth};
    ck_assert_int_eq(
        mesh_inline(&cloths[1].mesh, 2, cloths[0].mesh.position, 1, edge, 0, NULL, &error), 0);
    cloths[1].mass_per_vertex = 1e-15;
    setup.model.cloths = cloths;
    setup.model.welds = &weld;
    for (uint32_t i = 0; i < 2; i++) {
        setup.model.n_cloths = 1 + i;
        setup.model.n_welds = i;
        ck_assert_msg(!flow_source_make(&source, &setup.model, 1, &error), "%s", error.text);
        release[i] = flow_source_release(&source);
        flow_source_free(&source);
    }
    ck_assert_double_gt(release[0], 0);
    ck_assert_double_eq_tol(release[1], release[0], 1e-9 * release[0]);
    mesh_free(&cloths[1].mesh);
    setup_free(&setup);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("limits");
    TCase *cases = tcase_create("limits");
    tcase_add_test(cases, bound_of_a_chain);
    tcase_add_test(cases, bound_of_a_sheet);
    tcase_add_test(cases, warnings);
    tcase_add_test(cases, a_doubled_layer_has_a_scale_of_energy);
    tcase_add_loop_test(cases, limits_are_where_runs_break, 0, 4);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
