/* In how many steps in a row a row is cut, where steps are given up as well. */
#include "cloth/flow/contact/cut_run.h"
#include "tests/support/unit.h"

#include <stdbool.h>

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
