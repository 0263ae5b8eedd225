/* Whole runs against what can be worked out by hand: free fall, a weight on a damped spring,
 * momentum, pins, floors. Every case looks at positions in frames, one a step, as a user would. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>

/* Falls 480 steps of 1 ms without pins; every vertex by the same way. g h^2 n (n + 1) / 2 where the
 * new velocity moves a vertex, g h^2 n (n - 1) / 2 where the old one does. */
static void fall(enum model_integrator integrator, double drop)
{
    struct setup setup;
    struct record record = {0};
    setup_sheet(&setup, 12);
    setup.model.integrator = integrator;
    setup.model.end = 0.48;
    setup.model.fps = 25;
    setup.model.tolerance = 1e-13;
    record_run(&record, &setup.model);
    ck_assert_msg(record.code == 0, "%s", record.error.text);
    ck_assert_uint_eq(record.report.steps, 480);
    ck_assert_uint_eq(record.frames, 13);
    ck_assert_int_eq(isnan(record.report.momentum_lost) != 0, integrator == MODEL_EXPLICIT_EULER);
    for (size_t v = 0; v < record.vertices; v++) {
        ck_assert_double_eq_tol(record_at(&record, 12, v, 1), -drop, 5e-11);
        for (size_t c = 0; c < 3; c += 2)
            ck_assert_double_eq_tol(record_at(&record, 12, v, c), record_at(&record, 0, v, c),
                                    5e-11);
    }
    record_free(&record);
    setup_free(&setup);
}

UNIT_TEST(free_fall_implicit)
{
    fall(MODEL_IMPLICIT_EULER, 1.1324664);
}

UNIT_TEST(free_fall_explicit)
{
    fall(MODEL_EXPLICIT_EULER, 1.1277576);
}

/* A weight on a spring, from its rest length: with s the stretch less that of balance, m the mass,
 * k, c, d = drag + mass damping, each step is linear in (s, v), and s_n = r^n (s_0 cos n a + w sin
 * n a), where r^2 is the determinant of that step and 2 r cos a its trace: implicit  D = m + h (c +
 * d) + h^2 k:  r^2 = m / D,  trace = 1 + (m - h^2 k) / D explicit                              r^2
 * = 1 - h (c + d) / m + h^2 k / m,  trace = 2 - h (c + d) / m            */
static void swing(enum model_integrator integrator, double h)
{
    struct setup setup;
    struct record record = {0};
    setup_weight(&setup);
    setup.model.integrator = integrator;
    setup.model.h = h;
    setup.model.end = 100 * h;
    setup.model.fps = 1 / h;
    setup.model.tolerance = 1e-14;
    setup.material.damping_viscous = 0.01;
    setup.material.damping_mass = 0.3;
    record_run(&record, &setup.model);
    ck_assert_msg(record.code == 0, "%s", record.error.text);
    ck_assert_uint_eq(record.frames, 101);
    const double m = 0.1, k = 40, c = 0.002 * k, d = 0.01 + 0.3 * m,
                 big = m + h * (c + d) + h * h * k;
    const int implicit = integrator == MODEL_IMPLICIT_EULER;
    const double square = implicit ? m / big : 1 - h * (c + d) / m + h * h * k / m;
    const double trace = implicit ? 1 + (m - h * h * k) / big : 2 - h * (c + d) / m;
    const double r = sqrt(square), a = acos(trace / (2 * r)), balance = m * 9.81 / k;
    const double s0 = -balance, s1 = implicit ? s0 + h * (h * m * 9.81 / big) : s0;
    const double w = (s1 / r - s0 * cos(a)) / sin(a);
    for (size_t n = 0; n <= 100; n++) {
        const double turn = (double)n * a;
        const double s = pow(r, (double)n) * (s0 * cos(turn) + w * sin(turn));
        ck_assert_double_eq_tol(-record_at(&record, n, 1, 1) - 1 - balance, s, 1e-12);
        ck_assert_double_eq(record_at(&record, n, 1, 0), 0);
        ck_assert_double_eq(record_at(&record, n, 0, 1), 0); /* the pin */
    }
    ck_assert_double_lt(pow(r, 100), 0.97); /* it is damped */
    record_free(&record);
    setup_free(&setup);
}

UNIT_TEST(damped_spring_implicit)
{
    swing(MODEL_IMPLICIT_EULER, 0.01);
}

UNIT_TEST(damped_spring_explicit)
{
    swing(MODEL_EXPLICIT_EULER, 0.001);
}

/* Momentum of a step from the positions of its frame and the one before. */
static void momentum(const struct record *r, size_t step, const double *mass, double h,
                     double sum[3])
{
    for (size_t c = 0; c < 3; c++) {
        sum[c] = 0;
        for (size_t v = 0; v < r->vertices; v++)
            sum[c] += mass[v] * (record_at(r, step, v, c) - record_at(r, step - 1, v, c)) / h;
    }
}

/* A coarse solve leaves a residual, but no momentum of a sheet that nothing holds; the report says
 * so, to roundoff. */
UNIT_TEST(momentum_changes_by_forces_alone)
{
    const double h = 0.01;
    struct setup setup;
    struct record record = {0};
    double mass[100] = {0}, before[3] = {0}, max = 0;
    setup_sheet(&setup, 10);
    setup.model.h = h;
    setup.model.end = 20 * h;
    setup.model.fps = 1 / h;
    setup.model.tolerance = 0.3;
    setup_load(&setup, 33, 0.02, -0.05, 0.03);
    record_run(&record, &setup.model);
    ck_assert_msg(record.code == 0, "%s", record.error.text);
    setup_masses(&setup, mass);
    const double force[3] = {0.02, -0.05 - 9.81 * 0.2,
                             0.03}; /* the load, and the weight of 0.2 kg */
    for (size_t step = 1; step <= 20; step++) {
        double now[3], square = 0;
        momentum(&record, step, mass, h, now);
        for (size_t c = 0; c < 3; c++) {
            const double lost = h * force[c] - (now[c] - before[c]);
            square += lost * lost;
            before[c] = now[c];
        }
        max = sqrt(square) > max ? sqrt(square) : max;
    }
    ck_assert_double_lt(max, 1e-13);
    ck_assert_double_lt(record.report.momentum_lost, 1e-13);
    ck_assert_double_gt(record.report.mass_norm_error, 1e-6);
    record_free(&record);
    setup_free(&setup);
}

UNIT_TEST(no_momentum_is_lost_by_an_exact_solve)
{
    struct setup setup;
    struct record record = {0};
    setup_sheet(&setup, 10);
    setup.model.tolerance = 1e-13;
    setup_load(&setup, 33, 0.02, -0.05, 0.03);
    record_run(&record, &setup.model);
    ck_assert_msg(record.code == 0, "%s", record.error.text);
    ck_assert_double_lt(record.report.momentum_lost, 1e-15);
    record_free(&record);
    setup_free(&setup);
}

/* A pinned cloth in many blocks moves as the same cloth in one: halos and cut springs are complete.
 */
static void compare_grains(enum model_integrator integrator)
{
    struct setup setup;
    struct record one = {0}, many = {0};
    setup_sheet(&setup, 14);
    setup.model.integrator = integrator;
    setup.material.damping_stiffness = 0.001;
    setup.model.end = 0.1;
    setup.model.fps = 10;
    setup.model.tolerance = 1e-12;
    setup_pin(&setup, 3, (const uint32_t[]){0, 13, 13 * 14 + 7});
    setup_load(&setup, 100, 0.05, 0.02, -0.03);
    setup.model.grain = 1000;
    record_run(&one, &setup.model);
    ck_assert_msg(one.code == 0, "%s", one.error.text);
    ck_assert_uint_eq(one.report.blocks, 1);
    setup.model.grain = 9;
    record_run(&many, &setup.model);
    ck_assert_msg(many.code == 0, "%s", many.error.text);
    ck_assert_uint_eq(many.report.blocks, 24);
    for (size_t v = 0; v < one.vertices; v++)
        for (size_t c = 0; c < 3; c++)
            ck_assert_double_eq_tol(record_at(&many, 1, v, c), record_at(&one, 1, v, c), 1e-11);
    ck_assert_double_eq_tol(many.report.max_stretch, one.report.max_stretch, 1e-10);
    ck_assert_double_gt(one.report.max_stretch, 1.001);
    record_free(&one);
    record_free(&many);
    setup_free(&setup);
}

/* What a coarse solve with pins loses, by one block and by many whose borders run through springs
 * to pins. */
UNIT_LOOP(blocks_lose_the_same_momentum, 0, unit_alone())
{
    struct setup setup;
    struct record one = {0}, many = {0};
    setup_sheet(&setup, 14);
    setup.model.tolerance = 0.3;
    setup_pin(&setup, 4, (const uint32_t[]){0, 13, 75, 100});
    setup.model.grain = 1000;
    record_run(&one, &setup.model);
    setup.model.grain = 2;
    record_run(&many, &setup.model);
    ck_assert_msg(one.code == 0 && many.code == 0, "%s%s", one.error.text, many.error.text);
    ck_assert_double_gt(one.report.momentum_lost, 1e-7);
    ck_assert_double_eq_tol(many.report.momentum_lost, one.report.momentum_lost, 1e-14);
    record_free(&one);
    record_free(&many);
    setup_free(&setup);
}

UNIT_LOOP(blocks_make_no_difference_implicit, 0, unit_alone())
{
    compare_grains(MODEL_IMPLICIT_EULER);
}

UNIT_LOOP(blocks_make_no_difference_explicit, 0, unit_alone())
{
    compare_grains(MODEL_EXPLICIT_EULER);
}

UNIT_TEST(a_sheet_lands_on_the_floor)
{
    struct setup setup;
    struct record record = {0};
    double lowest = 1;
    setup_sheet(&setup, 8);
    setup.model.n_obstacles = 1;
    setup.plane = PLANE(0, -0.05, 0, 0, 1, 0);
    setup.model.end = 0.2;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    record_run(&record, &setup.model);
    ck_assert_msg(record.code == 0, "%s", record.error.text);
    for (size_t v = 0; v < record.vertices; v++) {
        lowest = fmin(lowest, record_at(&record, record.frames - 1, v, 1));
        for (size_t f = 0; f < record.frames; f++)
            ck_assert_double_ge(record_at(&record, f, v, 1), -0.05 - 1e-16);
    }
    ck_assert_double_eq_tol(lowest, -0.05, 1e-16);
    for (size_t c = 0; c < 3; c++)
        ck_assert_double_eq(record_at(&record, record.frames - 1, 0, c),
                            record_at(&record, 0, 0, c));
    record_free(&record);
    setup_free(&setup);
}
