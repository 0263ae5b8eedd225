/* Warnings about the load of the machine, and whose time on the cores counts. */
#include "tests/support/unit.h"
#include "tools/compare/load.h"

#include <math.h>
#include <string.h>

UNIT_TEST(a_quarter_of_the_cores)
{
    char text[200];
    ck_assert_ptr_null(load_warn_average(0.5, 2, text, sizeof text));
    ck_assert_ptr_null(load_warn_average(15.9, 64, text, sizeof text));
    ck_assert_ptr_null(load_warn_average(NAN, 2, text, sizeof text));
    ck_assert_ptr_nonnull(load_warn_average(0.6, 2, text, sizeof text));
    unit_says(text, "the load average is 0.60 on 2 cores");
    ck_assert_ptr_null(load_warn_others(0.99, 4, text, sizeof text));
    ck_assert_ptr_null(load_warn_others(NAN, 4, text, sizeof text));
    ck_assert_ptr_nonnull(load_warn_others(1.5, 4, text, sizeof text));
    unit_says(text, "other programs took 1.50 of 4 cores");
}

/* As if it had begun 1,000 s ago, when the cores and this process had worked less. */
UNIT_TEST(own_time_is_left_out)
{
    struct load load;
    load_begin(&load);
    ck_assert_double_ge(load.cores, 1);
    load.at += 1000; /* too short a time, however slow this test is */
    ck_assert(isnan(load_others(&load)));
    load.at -= 2000;
    load.busy -= 3000;
    ck_assert_double_eq_tol(load_others(&load), 3, 0.5);
    load.own -= 2000;
    ck_assert_double_eq_tol(load_others(&load), 1, 0.5);
    load.own -= 4000;
    ck_assert_double_eq(load_others(&load), 0);
    load.busy = NAN;
    ck_assert(isnan(load_others(&load)));
}
