/* Momentum of whole runs, and a floor: by positions in frames, one a step, as a user sees them. How
 * things fall and swing is in test_integrators.c. */
#include "tests/cloth/flow/models.h"
#include "tests/support/unit.h"

#include <math.h>

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
    double mass[100] = {0}, before[3] = {0}, max = 0;
    TRIAL(setup_sheet(&setup, 10));
    setup.model.h = h;
    setup.model.end = 20 * h;
    setup.model.fps = 1 / h;
    setup.model.tolerance = 0.3;
    setup_load(&setup, 33, 0.02, -0.05, 0.03);
    record_fine(&record, &setup.model);
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
}

UNIT_TEST(no_momentum_is_lost_by_an_exact_solve)
{
    TRIAL(setup_sheet(&setup, 10));
    setup.model.tolerance = 1e-13;
    setup_load(&setup, 33, 0.02, -0.05, 0.03);
    record_fine(&record, &setup.model);
    ck_assert_double_lt(record.report.momentum_lost, 1e-15);
}

/* The loss of a coarse solve with pins, by one block and by many whose borders run through springs
 * to pins. */
UNIT_LOOP(blocks_lose_the_same_momentum, 0, unit_alone())
{
    UNIT_OWNED(record_free) struct record one = {0}, many = {0};
    SETUP(setup_sheet(&setup, 14));
    setup.model.tolerance = 0.3;
    setup_pin(&setup, 4, (const uint32_t[]){0, 13, 75, 100});
    setup.model.grain = 1000;
    record_run(&one, &setup.model);
    setup.model.grain = 2;
    record_run(&many, &setup.model);
    ck_assert_msg(one.code == 0 && many.code == 0, "%s%s", one.error.text, many.error.text);
    ck_assert_double_gt(one.report.momentum_lost, 1e-7);
    ck_assert_double_eq_tol(many.report.momentum_lost, one.report.momentum_lost, 1e-14);
}

UNIT_TEST(a_sheet_lands_on_the_floor)
{
    double lowest = 1;
    TRIAL(setup_sheet(&setup, 8));
    setup.model.n_obstacles = 1;
    setup.plane = PLANE(0, -0.05, 0, 0, 1, 0);
    setup.model.end = 0.2;
    setup_pin(&setup, 1, (const uint32_t[]){0});
    record_fine(&record, &setup.model);
    for (size_t v = 0; v < record.vertices; v++) {
        lowest = fmin(lowest, record_at(&record, record.frames - 1, v, 1));
        for (size_t f = 0; f < record.frames; f++)
            ck_assert_double_ge(record_at(&record, f, v, 1), -0.05 - 1e-16);
    }
    ck_assert_double_eq_tol(lowest, -0.05, 1e-16);
    for (size_t c = 0; c < 3; c++)
        ck_assert_double_eq(record_at(&record, record.frames - 1, 0, c),
                            record_at(&record, 0, 0, c));
}
