/* The time grid, what steps are refused for, and in how many of them in a row a row of contact is
 * cut, without a run. */
#include "cloth/flow/contact/cut_run.h"
#include "cloth/flow/run/grid.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdbool.h>

UNIT_TEST(whole_steps)
{
    struct flow_grid grid;
    flow_grid_begin(&grid, 3);
    for (uint64_t i = 0; i < 3; i++) {
        ck_assert_uint_eq(grid.now, i * FLOW_TICKS);
        ck_assert_uint_lt(grid.now, grid.end);
        flow_grid_accept(&grid, true);
        ck_assert_uint_eq(grid.length, FLOW_TICKS);
    }
    ck_assert_uint_eq(grid.now, grid.end);
    ck_assert_uint_eq(grid.refused, 0);
    ck_assert_uint_eq(grid.least_done, FLOW_TICKS);
}

UNIT_TEST(halved_to_a_tick)
{
    struct flow_grid grid;
    flow_grid_begin(&grid, 4294967294);
    for (uint32_t length = FLOW_TICKS; length > 1; length /= 2) {
        ck_assert_uint_eq(grid.length, length);
        ck_assert(flow_grid_halve(&grid, false));
    }
    ck_assert(!flow_grid_halve(&grid, false));
    ck_assert_uint_eq(grid.length, 1);
    ck_assert_uint_eq(grid.refused, 10);
    ck_assert_uint_eq(grid.least_done, FLOW_TICKS); /* none was made */
}

/* Each step begins at a multiple of its length, whatever is refused, and the end is met. */
UNIT_TEST(steps_begin_at_multiples_of_their_length)
{
    struct flow_grid grid;
    uint32_t random = 1, longer = 0;
    flow_grid_begin(&grid, 50);
    while (grid.now < grid.end) {
        const uint32_t before = grid.length;
        ck_assert_uint_eq(grid.now % grid.length, 0);
        ck_assert_uint_le(grid.now + grid.length, grid.end);
        random = random * 1664525 + 1013904223;
        if ((random >> 24) % 3 == 0 && flow_grid_halve(&grid, false))
            continue;
        flow_grid_accept(&grid, (random >> 16) % 4 > 0);
        longer += grid.length > before;
        ck_assert_uint_le(grid.length, 2 * before);
    }
    ck_assert_uint_eq(grid.now, grid.end);
    ck_assert_uint_gt(longer, 10);
}

UNIT_TEST(grown_only_when_calm)
{
    struct flow_grid grid;
    flow_grid_begin(&grid, 2);
    flow_grid_halve(&grid, false);
    flow_grid_accept(&grid, true); /* at 512: 1024 does not begin there */
    ck_assert_uint_eq(grid.length, 512);
    flow_grid_accept(&grid, false);
    ck_assert_uint_eq(grid.length, 512);
    flow_grid_accept(&grid, true);
    flow_grid_accept(&grid, true);
    ck_assert_uint_eq(grid.length, FLOW_TICKS);
    ck_assert_uint_eq(grid.least_done, 512);
}

/* How many steps of half the length are made until the longer one is tried again. */
static int halves_until_grown(struct flow_grid *grid)
{
    int n = 0;
    ck_assert(flow_grid_halve(grid, true));
    for (const uint32_t length = grid->length; grid->length == length; n++)
        flow_grid_accept(grid, true);
    return n;
}

UNIT_TEST(a_length_that_fails_is_tried_ever_later)
{
    struct flow_grid grid;
    flow_grid_begin(&grid, 1000);
    ck_assert_int_eq(halves_until_grown(&grid), 2); /* it was not grown */
    ck_assert_int_eq(halves_until_grown(&grid), 4);
    ck_assert_int_eq(halves_until_grown(&grid), 8);
    ck_assert_int_eq(halves_until_grown(&grid), 16);
    ck_assert_int_eq(halves_until_grown(&grid), 32);
    ck_assert_int_eq(halves_until_grown(&grid), 32);
    flow_grid_accept(&grid, true); /* went well */
    ck_assert_int_eq(halves_until_grown(&grid), 2);
    ck_assert_int_eq(halves_until_grown(&grid), 32);
}

UNIT_TEST(what_is_refused)
{
    const struct flow_verdict fine = {.before = 1.2, .after = 1.25, .max = 1.4, .growth = 0.1};
    struct flow_verdict v = fine;
    ck_assert(!flow_verdict_refuses(&v));
    v.failed = true;
    ck_assert(flow_verdict_refuses(&v));
    v = fine;
    v.after = NAN;
    ck_assert(flow_verdict_refuses(&v));
    v.after = 1.31; /* grows too fast */
    ck_assert(flow_verdict_refuses(&v));
    v.growth = 0;
    ck_assert(!flow_verdict_refuses(&v));
    v.after = 1.41; /* too far */
    ck_assert(flow_verdict_refuses(&v));
    v.before = 1.5; /* on its way back */
    ck_assert(!flow_verdict_refuses(&v));
    v.max = 0;
    v.before = 1;
    ck_assert(!flow_verdict_refuses(&v));
}

UNIT_TEST(what_is_calm)
{
    struct flow_verdict v = {.before = 1.2, .after = 1.24, .growth = 0.1};
    ck_assert(flow_verdict_calm(&v));
    v.after = 1.26;
    ck_assert(!flow_verdict_calm(&v));
    v = (struct flow_verdict){.before = 1.2, .after = 1.3, .max = 1.51};
    ck_assert(flow_verdict_calm(&v));
    v.max = 1.49;
    ck_assert(!flow_verdict_calm(&v));
    v.after = 1.1;
    ck_assert(flow_verdict_calm(&v));
}

/* ---- Cuts in a row ---- */

/* Steps from 1 on. Upper case: accepted, lower case: given up; c: the row is cut in it, n: it is
 * not. Returns what the last cut said. */
static uint32_t cut_in(const char *steps)
{
    struct flow_cut_run run = {0};
    uint32_t accepted = 0, in_a_row = 0;
    for (uint32_t step = 1; *steps; step++, steps++) {
        const bool cut = *steps == 'c' || *steps == 'C';
        for (int round = 0; cut && round < 3; round++)
            in_a_row = flow_cut_again(&run, step, accepted);
        if (*steps == 'C' || *steps == 'N')
            accepted = step;
    }
    return in_a_row;
}

UNIT_TEST(steps_in_a_row_are_counted)
{
    ck_assert_uint_eq(cut_in("C"), 1);
    ck_assert_uint_eq(cut_in("NC"), 1);
    ck_assert_uint_eq(cut_in("CCC"), 3);
    ck_assert_uint_eq(cut_in("CCNC"), 1);
    ck_assert_uint_eq(cut_in("CCNCC"), 2);
}

UNIT_TEST(steps_given_up_do_not_count)
{
    ck_assert_uint_eq(cut_in("cC"), 1);
    ck_assert_uint_eq(cut_in("cccC"), 1);
    ck_assert_uint_eq(cut_in("CccC"), 2);
    ck_assert_uint_eq(cut_in("CCcncC"), 3);
    ck_assert_uint_eq(cut_in("CcN"), 2);  /* cut before it was given up */
    ck_assert_uint_eq(cut_in("CcNC"), 1); /* but not in the step that was made */
    ck_assert_uint_eq(cut_in("CNcC"), 1);
    ck_assert_uint_eq(cut_in("CnC"), 2);
    ck_assert_uint_eq(cut_in("CcCcCNcC"), 1);
}
