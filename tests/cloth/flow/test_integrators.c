/* Every integrator against closed forms: free fall, a weight on a damped spring (its decay and
 * frequency are those that the scheme's own formula gives, and near those of the equation of
 * motion), and the order of convergence in h. Figures are printed; the lines "# | " are rows of
 * docs/accuracy.md, by tests/whole/test_integrators.sh. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>

/* The weight of setup_weight: kg, N/m. */
static const double M = 0.1, K = 40, G = 9.81;

static const struct scheme {
    const char *name;
    enum model_integrator integrator;
    double drop;  /* in free fall, n steps of h: g h^2 n (n + drop) / 2 */
    int order;    /* of convergence */
    double h;     /* s, for the weight */
    double along; /* s, damping along the spring */
} SCHEMES[] = {
    {"explicit_euler", MODEL_EXPLICIT_EULER, -1, 1, 0.001, 0.002},
    {"symplectic_euler", MODEL_SYMPLECTIC_EULER, 1, 1, 0.01, 0.002},
    {"verlet", MODEL_VERLET, 0, 2, 0.01, 0},
    {"rk4", MODEL_RK4, 0, 4, 0.01, 0.002},
    {"implicit_euler", MODEL_IMPLICIT_EULER, 1, 1, 0.01, 0.002},
    /* Its first step falls h^2 g / 2 too far, which BDF2 makes 3/2 (1 - 3^-n) times as much. */
    {"bdf2", MODEL_BDF2, 1.5 / 480, 2, 0.01, 0.002},
};
enum { N_SCHEMES = sizeof SCHEMES / sizeof *SCHEMES };

static void run(struct record *record, struct setup *setup, const struct scheme *scheme)
{
    setup->model.integrator = scheme->integrator;
    setup->model.tolerance = 1e-13;
    record_run(record, &setup->model);
    ck_assert_msg(record->code == 0, "%s: %s", scheme->name, record->error.text);
}

UNIT_LOOP(free_fall, 0, N_SCHEMES)
{
    const struct scheme *scheme = SCHEMES + _i;
    TRIAL(setup_sheet(&setup, 8));
    setup.model.end = 0.48;
    setup.model.fps = 25;
    run(&record, &setup, scheme);
    const double n = 480, drop = G * 1e-6 * n * (n + scheme->drop) / 2;
    for (size_t v = 0; v < record.vertices; v++)
        for (size_t c = 0; c < 3; c++)
            ck_assert_double_eq_tol(record_at(&record, 12, v, c),
                                    record_at(&record, 0, v, c) - (c == 1 ? drop : 0), 5e-11);
    ck_assert_int_eq(isnan(record.report.momentum_lost) != 0, !model_is_implicit(&setup.model));
}

/* ---- A weight on a spring ---- */

/* The damping of the weight, kg/s: of its velocity, and along the spring. */
static double damping(const struct setup *setup)
{
    return setup->material.damping_viscous + setup->material.damping_mass * M +
           setup->material.damping_stiffness * K;
}

static void weigh(struct record *record, struct setup *setup, const struct scheme *scheme, double h,
                  double end)
{
    setup_weight(setup);
    setup->material.damping_viscous = 0.01;
    setup->material.damping_mass = 0.3;
    setup->material.damping_stiffness = scheme->along;
    setup->model.h = h;
    setup->model.end = end;
    setup->model.fps = 1 / h;
    run(record, setup, scheme);
}

/* How far below balance, m. */
static double below(const struct record *record, size_t frame)
{
    return -record_at(record, frame, 1, 1) - 1 - M * G / K;
}

/* Two steps of a linear scheme: s'' = trace s' - determinant s. The two numbers by the formula of
 * the scheme, e the damping. */
struct map {
    double trace, determinant;
};

static struct map map_of(enum model_integrator integrator, double h, double e)
{
    const double a = h * e / M, w = h * h * K / M;
    const double complex z = h * (-e / (2 * M) + I * sqrt(K / M - e * e / (4 * M * M)));
    const double complex r = 1 + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
    switch (integrator) {
    case MODEL_EXPLICIT_EULER:
        return (struct map){2 - a, 1 - a + w};
    case MODEL_SYMPLECTIC_EULER:
        return (struct map){2 - a - w, 1 - a};
    case MODEL_VERLET: /* leapfrog with the mean of two velocities in the drag */
        return (struct map){(2 - w) / (1 + a / 2), (1 - a / 2) / (1 + a / 2)};
    case MODEL_RK4:
        return (struct map){2 * creal(r), creal(r * conj(r))};
    case MODEL_BDF2: { /* the root of z^2 (3 / 2 - h lambda) - 2 z + 1 / 2 that is near 1 */
        const double complex root = (2 + csqrt(1 + 2 * z)) / (3 - 2 * z);
        return (struct map){2 * creal(root), creal(root * conj(root))};
    }
    case MODEL_IMPLICIT_EULER:
        break;
    }
    return (struct map){1 + (1 - w) / (1 + a + w), 1 / (1 + a + w)};
}

/* The same two numbers, of the run: least squares over its steps, but for the first, of which BDF2
 * has a second root's 3^-n. */
static struct map map_seen(const struct record *record)
{
    double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;
    for (size_t n = 40; n < record->frames; n++) {
        const double a = below(record, n - 1), b = -below(record, n - 2), c = below(record, n);
        aa += a * a;
        ab += a * b;
        bb += b * b;
        ac += a * c;
        bc += b * c;
    }
    const double d = aa * bb - ab * ab;
    return (struct map){(bb * ac - ab * bc) / d, (aa * bc - ab * ac) / d};
}

static double decay(const struct map *map, double h)
{
    return -log(map->determinant) / (2 * h);
}

static double frequency(const struct map *map, double h)
{
    return acos(map->trace / (2 * sqrt(map->determinant))) / h;
}

UNIT_LOOP(decay_and_frequency, 0, N_SCHEMES)
{
    const struct scheme *scheme = SCHEMES + _i;
    UNIT_OWNED(setup_free) struct setup setup;
    UNIT_OWNED(record_free) struct record record = {0};
    weigh(&record, &setup, scheme, scheme->h, 100 * scheme->h);
    const double h = scheme->h, e = damping(&setup);
    const struct map measured = map_seen(&record), wanted = map_of(scheme->integrator, h, e);
    const double rate = e / (2 * M), omega = sqrt(K / M - rate * rate);
    printf("# %s, h = %g s: decay %.6f 1/s (%.6f is exact), frequency %.6f rad/s (%.6f)\n",
           scheme->name, h, decay(&measured, h), rate, frequency(&measured, h), omega);
    ck_assert_double_eq_tol(measured.trace, wanted.trace, 1e-10);
    ck_assert_double_eq_tol(measured.determinant, wanted.determinant, 1e-10);
    for (size_t n = 0; n < record.frames; n++) {
        ck_assert_double_eq(record_at(&record, n, 1, 0), 0);
        ck_assert_double_eq(record_at(&record, n, 0, 1), 0); /* the pin */
    }
}

/* The error after 0.4 s, two thirds of a swing, against the equation of motion. */
static double error_at(const struct scheme *scheme, double h)
{
    struct setup setup;
    struct record record = {0};
    weigh(&record, &setup, scheme, h, 0.4);
    const double rate = damping(&setup) / (2 * M), omega = sqrt(K / M - rate * rate);
    const double turn = omega * 0.4, start = -M * G / K;
    const double exact = exp(-rate * 0.4) * start * (cos(turn) + rate / omega * sin(turn));
    const double error = fabs(below(&record, record.frames - 1) - exact);
    record_free(&record);
    setup_free(&setup);
    return error;
}

UNIT_LOOP(order, 0, unit_alone() ? N_SCHEMES : 0)
{
    struct scheme scheme = SCHEMES[_i];
    scheme.along = 0.002; /* forces that depend on the velocity count, too */
    const double h = scheme.order == 4 ? 0.01 : 0.001;
    const double coarse = error_at(&scheme, h), fine = error_at(&scheme, h / 2);
    const double measured = log2(coarse / fine);
    printf("# %s: error %.3e m at h = %g s, %.3e at half of it: order %.3f\n", scheme.name, coarse,
           h, fine, measured);
    printf("# | a weight on a damped spring, `%s` | order %d | %.2f |\n", scheme.name, scheme.order,
           measured);
    ck_assert_double_eq_tol(measured, scheme.order, 0.1);
}

/* ---- Blocks and the floor ---- */

/* A pinned, loaded and damped cloth in many blocks moves as in one. */
UNIT_LOOP(blocks_make_no_difference, 0, unit_alone() ? N_SCHEMES : 0)
{
    const struct scheme *scheme = SCHEMES + _i;
    UNIT_OWNED(record_free) struct record one = {0}, many = {0};
    SETUP(setup_sheet(&setup, 14));
    setup.material.damping_stiffness = 0.001;
    setup.material.damping_mass = 0.5;
    setup.model.end = 0.1;
    setup.model.fps = 10;
    setup_pin(&setup, 3, (const uint32_t[]){0, 13, 13 * 14 + 7});
    setup_load(&setup, 100, 0.05, 0.02, -0.03);
    setup.model.grain = 1000;
    run(&one, &setup, scheme);
    setup.model.grain = 9;
    run(&many, &setup, scheme);
    ck_assert_uint_eq(many.report.blocks, 24);
    ck_assert_double_le(record_farthest(&many, &one), 1e-11);
    ck_assert_double_eq_tol(many.report.max_stretch, one.report.max_stretch, 1e-10);
    ck_assert_double_gt(one.report.max_stretch, 1.001);
}

/* The weight of setup_weight above a floor that its spring would go through: forces from before
 * contact are not used after it. Here is the same by hand. */
UNIT_TEST(verlet_after_contact)
{
    const double h = 0.01, floor = -1.02;
    TRIAL(setup_weight(&setup));
    setup.material.damping_stiffness = 0;
    setup.material.damping_mass = 0.3;
    setup.model.n_obstacles = 1;
    setup.plane = PLANE(0, floor, 0, 0, 1, 0);
    setup.model.h = h;
    setup.model.end = 100 * h;
    setup.model.fps = 1 / h;
    setup.cloth.velocity[1] = 1;
    run(&record, &setup, SCHEMES + 2);
    double y = -1, v = 1;
    int touched = 0;
    for (size_t n = 1; n <= 100; n++) {
        const double half = v + h / 2 * (-G - K / M * (y + 1) - 0.3 * v) / (1 + 0.3 * h / 2);
        y += h * half;
        v = half + h / 2 * (-G - K / M * (y + 1) - 0.3 * half);
        if (y <= floor) {
            y = floor;
            v = fmax(v, 0);
            touched++;
        }
        ck_assert_double_eq_tol(record_at(&record, n, 1, 1), y, 1e-12);
    }
    ck_assert_int_gt(touched, 3);
}

/* ---- Energies ---- */

/* The energies of the weight, by the last three positions: v is the mean of two steps. */
UNIT_LOOP(energies, 0, N_SCHEMES)
{
    const double h = 1e-4, load = 0.3;
    TRIAL(setup_weight(&setup));
    setup_load(&setup, 1, 0, load, 0);
    setup.cloth.velocity[1] = 0.7;
    setup.model.h = h;
    setup.model.end = 0.2;
    setup.model.fps = 1 / h;
    run(&record, &setup, SCHEMES + _i);
    const size_t n = record.frames - 1;
    const double y = record_at(&record, n, 1, 1), v = (y - record_at(&record, n - 1, 1, 1)) / h;
    const struct flow_energy *start = &record.report.start, *end = &record.report.end;
    /* symplectic Euler: v half a kick on */
    ck_assert_double_eq_tol(start->kinetic, 0.5 * M * 0.7 * 0.7, 1e-4);
    ck_assert_double_eq(start->elastic, 0);
    ck_assert_double_eq_tol(start->gravity, -M * G, 1e-15);
    ck_assert_double_eq_tol(start->loads, load, 1e-15);
    ck_assert_double_eq_tol(end->kinetic, 0.5 * M * v * v, 2e-3 * start->kinetic);
    ck_assert_double_eq_tol(end->elastic, 0.5 * K * (y + 1) * (y + 1), 1e-14);
    ck_assert_double_eq_tol(end->gravity, M * G * y, 1e-14);
    ck_assert_double_eq_tol(end->loads, -load * y, 1e-14);
}
