/* Runs whose coarse space is solved by groups of blocks, on one level or two: they take few
 * iterations more than with the exact coarse space, and move alike, whatever is held. */
#include "tests/cloth/flow/session.h"
#include "tests/support/unit.h"

/* Blocks of few vertices, a patch each: on how many levels their groups are, and how many times the
 * iterations that takes at most. The exact space of patches of two vertices solves nearly all. */
static const struct {
    uint32_t side, grain, levels;
    double more;
} kinds[] = {{40, 6, 1, 1.6}, {60, 2, 2, 2.6}};
enum { MOST_SIDE = 60, KINDS = sizeof kinds / sizeof *kinds };

/* Stiff, pulled at, in steps that cloth is animated by. */
static void setup_stiff(struct setup *setup, int kind)
{
    setup_sheet(setup, kinds[kind].side);
    setup->material.stretch = 5000;
    setup->material.shear = 2500;
    setup->cloth.velocity[0] = 2;
    setup->model.preconditioner = MODEL_IC0_COARSE;
    setup->model.grain = kinds[kind].grain;
    setup->model.h = 0.004;
    setup->model.end = unit_quick() ? 0.004 : 0.008;
    setup->model.tolerance = 1e-8;
    setup_pin(setup, 2, (const uint32_t[]){0, kinds[kind].side - 1});
}

UNIT_LOOP(groups_are_on_so_many_levels, 0, KINDS)
{
    struct session s = {0};
    setup_stiff(&s.setup, _i);
    session_start(&s);
    ck_assert_uint_eq(s.flow->n_levels, kinds[_i].levels);
    ck_assert_uint_le(s.flow->pattern.n, 100);
    session_end(&s);
}

static void run(struct setup *setup, bool exact, struct record *record)
{
    setup->model.exact_coarse = exact;
    record_fine(record, &setup->model);
}

/* Against the exact space, and two threads against one. */
static void compare(struct setup *setup, double more)
{
    struct record exact = {0}, one = {.threads = 1}, two = {.threads = 2};
    run(setup, true, &exact);
    run(setup, false, &one);
    run(setup, false, &two);
    const double iterations = (double)exact.report.cg_iterations_total;
    ck_assert_double_le((double)one.report.cg_iterations_total, more * iterations);
    ck_assert_uint_eq(one.report.state_hash, two.report.state_hash);
    ck_assert_double_le(record_farthest(&exact, &one), 1e-6);
    record_free(&exact);
    record_free(&one);
    record_free(&two);
    setup_free(setup);
}

UNIT_LOOP(a_sheet_moves_as_by_one_factor, 0, unit_quick() ? 1 : KINDS)
{
    struct setup setup;
    setup_stiff(&setup, _i);
    compare(&setup, kinds[_i].more);
}

/* Whole groups are held, and have no column on any level. */
UNIT_LOOP(groups_may_be_held, 0, KINDS)
{
    static uint32_t held[MOST_SIDE * MOST_SIDE];
    const uint32_t n = 15 * kinds[_i].side;
    struct setup setup;
    setup_stiff(&setup, _i);
    for (uint32_t i = 0; i < n; i++)
        held[i] = i;
    setup.pin.pick.n_vertices = n;
    setup.pin.pick.vertices = held;
    compare(&setup, kinds[_i].more);
}
