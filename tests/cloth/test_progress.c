/* The line of progress says all that there is, and is cut where the terminal ends. */
#include "cloth/app/run/progress.h"

#include "tests/support/unit.h"

#include <stdint.h>
#include <string.h>

static const struct progress_counts ALL = {13, 45, 120, 3, 0.0021};
static char line[400];

static size_t write_line(size_t columns, const char *phase, const struct progress_counts *counts)
{
    return progress_line(line, sizeof line, columns, phase, 120, 480, 75.4, counts);
}

UNIT_TEST(says_all)
{
    write_line(SIZE_MAX, "sew", &ALL);
    ck_assert_str_eq(line,
                     "sew: step 120 of 480, 75 s left, 13 frames, 45 iterations, 120 contacts, "
                     "3 seams open by 0.0021 m");
}

UNIT_TEST(leaves_out_what_is_not_there)
{
    write_line(SIZE_MAX, NULL, &(struct progress_counts){.cg_iterations = 7});
    ck_assert_str_eq(line, "step 120 of 480, 75 s left, 7 iterations");
    write_line(SIZE_MAX, NULL, &(struct progress_counts){.frames = 1, .contacts = 1});
    ck_assert_str_eq(line, "step 120 of 480, 75 s left, 1 frame, 0 iterations, 1 contact");
}

UNIT_TEST(has_units_of_time)
{
    const struct progress_counts none = {0};
    progress_line(line, sizeof line, SIZE_MAX, NULL, 1, 2, 119.4, &none);
    unit_says(line, ", 119 s left");
    progress_line(line, sizeof line, SIZE_MAX, NULL, 1, 2, 7199, &none);
    unit_says(line, ", 120 min left");
    progress_line(line, sizeof line, SIZE_MAX, NULL, 1, 2, 9000, &none);
    unit_says(line, ", 2.5 h left");
}

UNIT_TEST(fits_the_terminal)
{
    ck_assert_uint_eq(write_line(79, "sew", &ALL), 79);
    ck_assert_uint_eq(strlen(line), 79);
    unit_says(line, "75 s left");
    ck_assert_uint_eq(write_line(1, NULL, &ALL), 1);
    ck_assert_str_eq(line, "s");
}

/* A column has a character, of one byte or of several. */
UNIT_TEST(cuts_between_characters)
{
    write_line(6, "d\xc3\xa9j\xc3\xa0", &ALL);
    ck_assert_str_eq(line, "d\xc3\xa9j\xc3\xa0: ");
    write_line(2, "d\xc3\xa9j\xc3\xa0", &ALL);
    ck_assert_str_eq(line, "d\xc3\xa9");
    write_line(1, "\xf0\x9f\x98\x80", &ALL);
    ck_assert_str_eq(line, "\xf0\x9f\x98\x80");
}

UNIT_TEST(shortens_long_phases)
{
    char phase[1000];
    memset(phase, 'p', sizeof phase - 1);
    phase[sizeof phase - 1] = '\0';
    write_line(SIZE_MAX, phase, &ALL);
    ck_assert_int_eq(strncmp(line + 39, "p: step 120 of 480", 18), 0);
}
