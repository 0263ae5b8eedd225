/* Newton steps and BDF2 on a chain that swings far: the equations of the step are solved, by one
 * step nearly, by several to the tolerance; energy is what the scheme promises; a floor and shorter
 * steps start BDF2 again. Lines "# | " are rows of docs/accuracy.md, by
 * tests/whole/test_integrators.sh. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>

enum { LINKS = 5 };
static const double M = 0.02, K = 300, G = 9.81, LENGTH = 0.2;

/* Level, held at its first vertex, and let go. A frame a step. */
static void chain(struct setup *s, double h, size_t steps)
{
    setup_chain(s, LINKS, LENGTH, 0, M, K);
    s->model.h = h;
    s->model.end = h * (double)steps;
    s->model.fps = 1 / h;
    s->model.grain = 2;
    s->model.tolerance = 1e-12;
    s->model.newton_steps = 1;
    s->model.newton_tolerance = 1e-10;
}

/* Force on component c of vertex i in a frame, N. */
static double force(const struct record *r, size_t frame, size_t i, size_t c)
{
    double sum = c == 1 ? -M * G : 0;
    for (size_t other = i - 1; other <= i + 1 && other <= LINKS; other += 2) {
        double d[3], square = 0;
        for (size_t k = 0; k < 3; k++) {
            d[k] = record_at(r, frame, other, k) - record_at(r, frame, i, k);
            square += d[k] * d[k];
        }
        sum += K * (sqrt(square) - LENGTH) * d[c] / sqrt(square);
    }
    return sum;
}

/* x of `back` steps before a frame; at rest before the start. */
static double at(const struct record *r, size_t frame, size_t back, size_t i, size_t c)
{
    return record_at(r, frame > back ? frame - back : 0, i, c);
}

/* The largest of what is missing in the equations of any step of implicit Euler, as a part of the
 * weight: M (x2 - 2 x1 + x0) / h^2 = f(x2). */
static double missing_euler(const struct record *r, double h)
{
    double max = 0;
    for (size_t n = 1; n < r->frames; n++)
        for (size_t i = 1; i <= LINKS; i++)
            for (size_t c = 0; c < 3; c++) {
                const double a =
                    (at(r, n, 0, i, c) - 2 * at(r, n, 1, i, c) + at(r, n, 2, i, c)) / (h * h);
                max = fmax(max, fabs(M * a - force(r, n, i, c)) / (M * G));
            }
    return max;
}

UNIT_TEST(euler_solves_its_equations)
{
    const double h = 0.02;
    UNIT_OWNED(record_free) struct record one = {0}, many = {0};
    SETUP(chain(&setup, h, 50));
    record_fine(&one, &setup.model);
    setup.model.newton_steps = 20;
    record_fine(&many, &setup.model);
    printf("# chain, h = %g s: missing in the step's equations, of the weight: %.3e after one "
           "Newton step, %.3e after %.2f\n",
           h, missing_euler(&one, h), missing_euler(&many, h),
           (double)many.report.newton_steps / 50);
    ck_assert_double_gt(missing_euler(&one, h), 1e-2);
    ck_assert_double_lt(missing_euler(&many, h), 1e-10);
    ck_assert_uint_eq(one.report.newton_steps, 0);
    ck_assert_uint_eq(many.report.newton_unconverged, 0);
    ck_assert_uint_gt(many.report.newton_steps, 100);
    ck_assert_double_lt(many.report.momentum_lost, 1e-9);
}

/* BDF2 of positions, where v by them is (3 x2 - 4 x1 + x0) / 2 h: from its second step on. */
UNIT_TEST(bdf2_solves_its_equations)
{
    const double h = 0.02;
    UNIT_OWNED(record_free) struct record r = {0};
    double max = 0;
    SETUP(chain(&setup, h, 50));
    setup.model.integrator = MODEL_BDF2;
    setup.model.newton_steps = 20;
    record_fine(&r, &setup.model);
    for (size_t n = 4; n < r.frames; n++)
        for (size_t i = 1; i <= LINKS; i++)
            for (size_t c = 0; c < 3; c++) {
                double v[3];
                for (size_t k = 0; k < 3; k++)
                    v[k] = (3 * at(&r, n, k, i, c) - 4 * at(&r, n, k + 1, i, c) +
                            at(&r, n, k + 2, i, c)) /
                           (2 * h);
                const double a = (3 * v[0] - 4 * v[1] + v[2]) / (2 * h);
                max = fmax(max, fabs(M * a - force(&r, n, i, c)) / (M * G));
            }
    printf("# chain, h = %g s: missing in BDF2's equations, of the weight: %.3e\n", h, max);
    ck_assert_double_lt(max, 1e-7);
}

/* Where the last vertex is after 0.24 s. */
static void end_of(struct record *r, enum model_integrator integrator, uint32_t newton, double h,
                   double x[2])
{
    SETUP(chain(&setup, h, (size_t)(0.24 / h + 0.5)));
    setup.model.integrator = integrator;
    setup.model.energy_growth = 0.005; /* of no effect in steps so short */
    setup.model.newton_steps = newton;
    *r = (struct record){0};
    record_fine(r, &setup.model);
    for (size_t c = 0; c < 2; c++)
        x[c] = record_at(r, r->frames - 1, LINKS, c);
    record_free(r);
}

/* By Richardson: of three lengths of steps. */
UNIT_LOOP(order_of_a_swing, 0, unit_alone() ? 4 : 0)
{
    static const struct {
        const char *name;
        enum model_integrator integrator;
        uint32_t newton;
        double order;
    } rows[] = {{"implicit Euler, one Newton step", MODEL_IMPLICIT_EULER, 1, 1},
                {"implicit Euler, converged", MODEL_IMPLICIT_EULER, 20, 1},
                {"BDF2, one Newton step", MODEL_BDF2, 1, 2},
                {"BDF2, converged", MODEL_BDF2, 20, 2}};
    struct record r;
    double x[3][2], change[2] = {0};
    for (int i = 0; i < 3; i++)
        end_of(&r, rows[_i].integrator, rows[_i].newton, 0.0004 / (1 << i), x[i]);
    for (int i = 0; i < 2; i++)
        change[i] = hypot(x[i + 1][0] - x[i][0], x[i + 1][1] - x[i][1]);
    const double measured = log2(change[0] / change[1]);
    printf("# | a chain of five links falls, %s | order %.0f | %.2f |\n", rows[_i].name,
           rows[_i].order, measured);
    ck_assert_double_eq_tol(measured, rows[_i].order, 0.15);
}

/* A weight in the middle of a wire without tension, which feels nothing of the wire where the step
 * is linearised: a whole Newton step takes it to where the wire holds it with a thousand times its
 * weight. Two Newton steps get near the solution because the first is cut. */
UNIT_TEST(line_search)
{
    const double h = 0.2, half = 0.5, k = 3e5, m = 0.02;
    static const double vertices[] = {-0.5, 0, 0, 0, 0, 0, 0.5, 0, 0};
    static const uint32_t edges[] = {0, 1, 1, 2};
    UNIT_OWNED(record_free) struct record r = {0};
    SETUP(chain(&setup, h, 1));
    setup_mesh(&setup, 3, vertices, 2, edges, 0, NULL);
    setup_pin(&setup, 2, (const uint32_t[]){0, 2});
    setup.material.ea = k * half;
    setup.model.newton_steps = 2;
    record_fine(&r, &setup.model);
    double low = 0, high = 1; /* m u / h^2 = m g - 2 k (l - L) u / l */
    for (int i = 0; i < 100; i++) {
        const double u = (low + high) / 2, l = hypot(half, u);
        if (m * u / (h * h) < m * G - 2 * k * (l - half) * u / l)
            low = u;
        else
            high = u;
    }
    const double measured = -record_at(&r, 1, 1, 1);
    printf("# a wire catches a weight: %.6f m after two Newton steps, %.6f is due, %.6f without "
           "the wire\n",
           measured, low, h * h * G);
    ck_assert_double_eq_tol(measured, low, 0.5 * low);
    ck_assert_double_gt(h * h * G, 20 * low);
    ck_assert_uint_eq(r.report.newton_unconverged, 1);
}

/* Contact and BDF2: the chain falls on a floor and never through it; the step after a touch is the
 * same as of a run by implicit Euler that begins there, so it has no memory of the fall. */
UNIT_TEST(bdf2_after_contact)
{
    const double h = 0.01, floor = -0.1;
    UNIT_OWNED(record_free) struct record r = {0};
    double y = 0, v = 0, last_y = 0, last_v = 0;
    SETUP(setup_weight(&setup));
    setup.cloth.n_pins = 0;
    setup.material.ea = 0;
    setup.material.damping_stiffness = 0;
    setup.model.gravity[1] = -G;
    setup.model.integrator = MODEL_BDF2;
    setup.model.n_obstacles = 1;
    setup.plane = PLANE(0, floor, 0, 0, 1, 0);
    setup.cloth.start = (double[12]){0, 0, 0, 0, 0, 0, 0, 0.3, 0, 1, 0, 0};
    setup.model.h = h;
    setup.model.end = 100 * h;
    setup.model.fps = 1 / h;
    setup.model.tolerance = 1e-13;
    record_fine(&r, &setup.model);
    bool smooth = false; /* of the first vertex and the other one alike: one that touches counts */
    double z = 0.3, w = 0, last_z = 0, last_w = 0;
    for (size_t n = 1; n <= 100; n++) {
        const double t = smooth ? 2 * h / 3 : h;
        const double by = smooth ? (4 * y - last_y) / 3 : y, bv = smooth ? (4 * v - last_v) / 3 : v;
        const double bz = smooth ? (4 * z - last_z) / 3 : z, bw = smooth ? (4 * w - last_w) / 3 : w;
        last_y = y;
        last_v = v;
        last_z = z;
        last_w = w;
        v = bv - t * G;
        y = by + t * v;
        w = bw - t * G;
        z = bz + t * w;
        smooth = y > floor && z > floor;
        v = y <= floor && v < 0 ? 0 : v;
        w = z <= floor && w < 0 ? 0 : w;
        y = fmax(y, floor);
        z = fmax(z, floor);
        ck_assert_double_eq_tol(record_at(&r, n, 0, 1), y, 1e-12);
        ck_assert_double_eq_tol(record_at(&r, n, 1, 1), z, 1e-12);
    }
}

/* ---- Energies ---- */

/* The chain's fall from level to upright would set this free, J. */
static double fall(void)
{
    double sum = 0;
    for (int i = 1; i <= LINKS; i++)
        sum += M * G * LENGTH * i;
    return sum;
}

/* Undriven and without damping: what a run of the chain gains. */
UNIT_LOOP(energy_is_not_gained, 0, 8)
{
    static const struct {
        const char *name;
        enum model_integrator integrator;
        uint32_t newton;
        double h, max;    /* of the fall */
        uint64_t retaken; /* at least, by BDF2 where it may gain half a percent a step */
    } rows[] = {{"implicit Euler, converged", MODEL_IMPLICIT_EULER, 50, 0.001, 1e-9, 0},
                {"implicit Euler, converged", MODEL_IMPLICIT_EULER, 50, 0.02, 1e-9, 0},
                {"implicit Euler, one Newton step", MODEL_IMPLICIT_EULER, 1, 0.001, 0.01, 0},
                {"implicit Euler, one Newton step", MODEL_IMPLICIT_EULER, 1, 0.02, 0.01, 0},
                {"BDF2, one Newton step", MODEL_BDF2, 1, 0.001, 0.01, 0},
                {"BDF2, converged", MODEL_BDF2, 50, 0.001, 0.01, 0},
                {"BDF2, one Newton step", MODEL_BDF2, 1, 0.02, 0.01, 2},
                {"BDF2, converged", MODEL_BDF2, 50, 0.02, 0.01, 1}};
    UNIT_OWNED(record_free) struct record r = {0};
    SETUP(chain(&setup, rows[_i].h, (size_t)(1 / rows[_i].h + 0.5)));
    setup.model.integrator = rows[_i].integrator;
    setup.model.newton_steps = rows[_i].newton;
    setup.model.energy_steps = true;
    setup.model.energy_growth = 0.005;
    record_fine(&r, &setup.model);
    const double gained = r.report.energy_gained / fall();
    printf("# | a chain of five links falls from level, %s, h = %g s | %.0e | %.2g |\n",
           rows[_i].name, rows[_i].h, gained, (0 - r.report.energy_lowest) / fall());
    ck_assert_double_le(gained, rows[_i].max);
    ck_assert_uint_ge(r.report.steps_retaken, rows[_i].retaken);
    ck_assert_uint_le(r.report.steps_retaken, rows[_i].retaken ? 8 : 0);
    ck_assert_uint_eq(r.report.steps_halved, 0);
    ck_assert_double_lt(r.report.energy_lowest, -1e-4 * fall());
}

/* The weight on its spring without damping: how far the energy wavers in 2 s. */
static double band(enum model_integrator integrator, double h)
{
    struct setup setup;
    struct record r = {0};
    setup_weight(&setup);
    setup.material.damping_stiffness = 0;
    setup.model.integrator = integrator;
    setup.model.energy_steps = true;
    setup.model.h = h;
    setup.model.end = 2;
    setup.model.fps = 1;
    record_fine(&r, &setup.model);
    const double wide = r.report.energy_highest - r.report.energy_lowest;
    ck_assert_double_eq_tol(r.report.energy_gained, wide, 0.6 * wide);
    record_free(&r);
    setup_free(&setup);
    return wide;
}

UNIT_LOOP(energy_wavers_in_a_band, 0, 2)
{
    static const enum model_integrator all[] = {MODEL_VERLET, MODEL_SYMPLECTIC_EULER};
    const double wide = band(all[_i], 0.01), narrow = band(all[_i], 0.005);
    printf("# %s: energy wavers by %.3e J at h = 0.01 s, %.3e at half of it: order %.3f\n",
           model_schemes[all[_i]].name, wide, narrow, log2(wide / narrow));
    ck_assert_double_eq_tol(log2(wide / narrow), 2, 0.1);
}

UNIT_TEST(energies_are_reported_when_asked)
{
    UNIT_OWNED(record_free) struct record r = {0};
    SETUP(chain(&setup, 0.01, 3));
    record_fine(&r, &setup.model);
    ck_assert_double_nan(r.report.energy_lowest);
    ck_assert_double_nan(r.report.energy_highest);
    ck_assert_double_nan(r.report.energy_gained);
}
