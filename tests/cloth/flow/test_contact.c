/* Contact in the solve: what lies on planes stays on them, slides along them as if they were not
 * there, and is let go when forces pull it off; what falls onto them lands without being stretched.
 */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

static void runs(struct record *record, const struct model *model)
{
    record_run(record, model);
    ck_assert_msg(record->code == 0, "%s", record->error.text);
}

/* A sheet on the plane y = 0, with contact in the solve. */
static void setup_floor(struct setup *setup, uint32_t n)
{
    setup_sheet(setup, n);
    setup->plane = PLANE(0, 0, 0, 0, 1, 0);
    setup->model.n_obstacles = 1;
    setup->model.contact = MODEL_CONTACT_FILTER;
}

/* Turns the start, the plane and gravity about the z axis, by cos and sin. */
static void tilt(struct setup *setup, double cosine, double sine)
{
    double *vectors[] = {setup->plane.value + 3, setup->plane.value, setup->model.gravity};
    for (size_t i = 0; i < 3; i++) {
        const double x = vectors[i][0], y = vectors[i][1];
        vectors[i][0] = cosine * x - sine * y;
        vectors[i][1] = sine * x + cosine * y;
    }
    for (size_t v = 0; v < setup->cloth.mesh.n_vertices; v++) {
        double *p = setup->cloth.mesh.position + 3 * v, x = p[0], y = p[1];
        p[0] = cosine * x - sine * y;
        p[1] = sine * x + cosine * y;
    }
}

/* Implicit Euler under a constant force along the plane: a h^2 n (n + 1) / 2 after n steps. With
 * every preconditioner, planes along the axes and askew, every vertex in contact. */
START_TEST(slides_as_a_whole)
{
    for (int kind = 0; kind < 10; kind++) {
        struct setup setup;
        struct record record = {0};
        const double cosine = kind % 2 ? 0.8 : 1, sine = kind % 2 ? 0.6 : 0;
        setup_floor(&setup, 7);
        setup.model.gravity[0] = 3;
        setup.model.gravity[2] = -2;
        setup.model.preconditioner = (enum model_preconditioner)(kind / 2);
        setup.model.tolerance = 1e-10;
        tilt(&setup, cosine, sine);
        runs(&record, &setup.model);
        for (size_t v = 0; v < 49; v++) {
            const double along = 3 * 1e-6 * 55;
            ck_assert_double_eq_tol(record_at(&record, 10, v, 0) - record_at(&record, 0, v, 0),
                                    cosine * along, 1e-12);
            ck_assert_double_eq_tol(record_at(&record, 10, v, 1) - record_at(&record, 0, v, 1),
                                    sine * along, 1e-12);
            ck_assert_double_eq_tol(record_at(&record, 10, v, 2) - record_at(&record, 0, v, 2),
                                    -2 * 1e-6 * 55, 1e-12);
        }
        record_free(&record);
        setup_free(&setup);
    }
}
END_TEST

/* Two walls and a floor: it can move along their line only, then nowhere. */
START_TEST(planes_that_meet)
{
    for (uint32_t walls = 1; walls < 3; walls++) {
        static const struct contact_shape planes[] = {{.value = {0, 0, 0, 0, 1, 0}},
                                                      {.value = {0, 0, 0, 0, 0.6, 0.8}},
                                                      {.value = {0, 0, 0, -0.8, 0.6, 0}}};
        struct setup setup;
        struct record record = {0};
        setup_floor(&setup, 3);
        mesh_free(&setup.cloth.mesh);
        struct cloth_error error = {0};
        /* A short edge in the corner, along x. */
        static const double vertices[] = {0, 0, 0, -0.01, 0, 0};
        static const uint32_t edge[] = {0, 1};
        ck_assert_int_eq(mesh_inline(&setup.cloth.mesh, 2, vertices, 1, edge, 0, NULL, &error), 0);
        setup.cloth.mass_per_vertex = 0.1;
        setup.material.ea = 20;
        setup.model.grain = 1;
        setup.model.obstacles = (struct contact_shape *)(uintptr_t)planes;
        setup.model.n_obstacles = 1 + walls;
        setup.model.gravity[0] = 1;
        setup.model.gravity[2] = -4;
        runs(&record, &setup.model);
        const double moved = record_at(&record, 10, 0, 0) - record_at(&record, 0, 0, 0);
        ck_assert_double_eq_tol(moved, walls == 1 ? 1e-6 * 55 : 0, 1e-9);
        for (size_t c = 1; c < 3; c++)
            ck_assert_double_eq_tol(record_at(&record, 10, 0, c), 0, 1e-12);
        record_free(&record);
        setup_free(&setup);
    }
}
END_TEST

/* A load lifts one corner: it is let go, and takes its neighbours along. */
START_TEST(is_let_go)
{
    struct setup setup;
    struct record record = {0};
    setup_floor(&setup, 7);
    setup.model.end = 0.1;
    setup.model.fps = 100;
    setup_load(&setup, 0, 0, 1, 0);
    runs(&record, &setup.model);
    ck_assert_double_gt(record_at(&record, 10, 0, 1), 0.01);
    ck_assert_double_gt(record_at(&record, 10, 1, 1), 0.001);
    ck_assert_double_eq_tol(record_at(&record, 10, 48, 1), 0, 1e-12);
    record_free(&record);
    setup_free(&setup);
}
END_TEST

/* A tilted sheet falls in steps of 20 ms. */
static void setup_fall(struct setup *setup, uint32_t n)
{
    setup_floor(setup, n);
    setup->model.preconditioner = MODEL_IC0_COARSE;
    setup->material.stretch = setup->material.shear = 2000;
    setup->model.h = 0.02;
    setup->model.end = 0.4;
    setup->model.fps = 50;
    setup->model.obstacles = &setup->plane;
    setup->plane.value[1] = 0;
    for (size_t v = 0; v < (size_t)n * n; v++) {
        double *p = setup->cloth.mesh.position + 3 * v, x = p[0];
        p[0] = 0.8 * x;
        p[1] = 0.6 * x + 0.5;
    }
}

/* A tilted sheet falls: nothing is ever below the floor, and long steps stretch it less than where
 * vertices are put onto the floor after the step. */
START_TEST(lands)
{
    double max[2];
    for (int filter = 0; filter < 2; filter++) {
        struct setup setup;
        struct record record = {0};
        setup_fall(&setup, 12);
        setup.model.contact = filter ? MODEL_CONTACT_FILTER : MODEL_CONTACT_PROJECT;
        runs(&record, &setup.model);
        max[filter] = 0;
        for (size_t k = 0; k < record.frames; k++)
            for (size_t v = 0; v < 144; v++) {
                ck_assert_double_ge(record_at(&record, k, v, 1), -1e-12);
                double square = 0;
                for (size_t c = 0; c < 3 && v % 12; c++)
                    square += pow(record_at(&record, k, v, c) - record_at(&record, k, v - 1, c), 2);
                max[filter] = fmax(max[filter], sqrt(square) * 11);
            }
        record_free(&record);
        setup_free(&setup);
    }
    ck_assert_double_lt(max[1], max[0]);
}
END_TEST

/* What crumples on the floor is thrown about less where compressed springs resist being turned: it
 * gains less energy, and its systems are easier. */
START_TEST(crumples_by_absolute_slopes)
{
    struct flow_report report[2];
    for (int absolute = 0; absolute < 2; absolute++) {
        struct setup setup;
        struct record record = {0};
        setup_fall(&setup, 24);
        setup.model.contact = MODEL_CONTACT_PROJECT;
        setup.model.full_slope = absolute ? PHYS_ABSOLUTE : PHYS_DEFINITE;
        setup.model.energy_steps = true;
        runs(&record, &setup.model);
        report[absolute] = record.report;
        record_free(&record);
        setup_free(&setup);
    }
    ck_assert_double_lt(2 * report[1].energy_gained, report[0].energy_gained);
    ck_assert_uint_lt(report[1].cg_iterations_total, report[0].cg_iterations_total);
}
END_TEST

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

/* With every preconditioner, and with contact: what the program holds stays, the rest falls. */
START_TEST(a_program_filters)
{
    for (int contact = 0; contact < 2; contact++) {
        struct setup setup;
        struct record record = {.threads = 2, .filter = {&mark, constrain_three}};
        setup_floor(&setup, 8);
        setup.plane.value[1] = contact ? -1e-4 : -1;
        setup.model.own_filter = true;
        setup.model.tolerance = 1e-10;
        setup.model.preconditioner = (enum model_preconditioner)_i;
        runs(&record, &setup.model);
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
        record_free(&record);
        setup_free(&setup);
    }
}
END_TEST

START_TEST(a_filter_is_given_on_every_rank)
{
    struct setup setup;
    struct record record = {0};
    setup_floor(&setup, 8);
    setup.model.own_filter = true;
    record_run(&record, &setup.model);
    ck_assert_int_eq(record.code, CLOTH_E_RUN);
    ck_assert_ptr_nonnull(strstr(record.error.text, "call flow_filter_by on every rank"));
    record_free(&record);
    setup_free(&setup);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("contact");
    TCase *cases = tcase_create("contact");
    tcase_add_test(cases, slides_as_a_whole);
    tcase_add_test(cases, planes_that_meet);
    tcase_add_test(cases, is_let_go);
    tcase_add_test(cases, lands);
    tcase_add_loop_test(cases, a_program_filters, MODEL_PLAIN, MODEL_IC0_COARSE + 1);
    tcase_add_test(cases, a_filter_is_given_on_every_rank);
    tcase_add_test(cases, crumples_by_absolute_slopes);
    suite_add_tcase(suite, cases);
    return unit_run(suite);
}
