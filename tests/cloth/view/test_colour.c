/* Words, colours and marks of scales, against what they are to be. */
#include "cloth/view/colour.h"
#include "tests/support/unit.h"

#include <math.h>
#include <string.h>

static struct view_colouring colouring;

static void takes(const char *text, enum view_colour by, bool has_scale, double min, double max)
{
    const char *wrong = view_colouring_parse(text, &colouring);
    ck_assert_msg(!wrong, "%s %s", text, wrong);
    ck_assert_int_eq(colouring.by, by);
    ck_assert_int_eq(colouring.has_scale, has_scale);
    ck_assert_double_eq(colouring.scale.min, min);
    ck_assert_double_eq(colouring.scale.max, max);
}

static void refuses(const char *text, const char *reason)
{
    const char *wrong = view_colouring_parse(text, &colouring);
    ck_assert_msg(wrong && strstr(wrong, reason), "%s: %s", text, wrong ? wrong : "taken");
}

UNIT_TEST(words_and_scales_are_read)
{
    takes("cloth", VIEW_COLOUR_CLOTH, false, 0, 0);
    takes("block", VIEW_COLOUR_BLOCK, false, 0, 0);
    takes("rank", VIEW_COLOUR_RANK, false, 0, 0);
    takes("contact", VIEW_COLOUR_CONTACT, false, 0, 0);
    takes("contact,0.25", VIEW_COLOUR_CONTACT, true, 0, 0.25);
    takes("strain,0.01:0.05", VIEW_COLOUR_STRAIN, true, 0.01, 0.05);
    takes("stress,-10:1e3", VIEW_COLOUR_STRESS, true, -10, 1000);
}

UNIT_TEST(others_are_refused_with_what_is_allowed)
{
    static const char *const words[] = {"", "red", "strains", "strai", "Rank", " rank", ",1"};
    static const char *const scales[] = {"strain,",   "strain,x",    "strain,1x",    "strain,1:",
                                         "strain,:1", "strain,1:2x", "strain,1:2:3", "strain,,1"};
    static const char *const orders[] = {"strain,0",   "strain,-1",    "contact,2:1",  "stress,1:1",
                                         "strain,nan", "strain,0:inf", "strain,-inf:0"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        refuses(words[i], "block, rank, strain, stress, contact or cloth");
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++)
        refuses(scales[i], "WORD,MAX or WORD,MIN:MAX");
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++)
        refuses(orders[i], "MAX is above its MIN");
    refuses("rank,3", "with strain (m/m), stress (N/m) and contact (N) only");
    refuses("cloth,3", "only");
}

UNIT_TEST(every_colour_has_a_word_and_a_title)
{
    for (enum view_colour by = 0; by < VIEW_COLOURS; by++) {
        takes(view_colour_word[by], by, false, 0, 0);
        ck_assert_int_eq(view_colour_has_scale(by), strchr(view_colour_title[by], ',') != NULL);
    }
}

static double linear(double c)
{
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* CIE L*, 0 .. 100. */
static double lightness(const float c[3])
{
    const double y = 0.2126 * linear((double)c[0]) + 0.7152 * linear((double)c[1]) +
                     0.0722 * linear((double)c[2]);
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

UNIT_TEST(the_map_begins_and_ends_as_viridis)
{
    static const int first[] = {0x44, 0x01, 0x54}, last[] = {0xfd, 0xe7, 0x25};
    float c[3];
    for (int side = -1; side <= 0; side++) {
        view_map_at(side, c);
        for (int k = 0; k < 3; k++)
            ck_assert_int_eq((int)lround(255 * (double)c[k]), first[k]);
        view_map_at(1 - side, c);
        for (int k = 0; k < 3; k++)
            ck_assert_int_eq((int)lround(255 * (double)c[k]), last[k]);
    }
}

UNIT_TEST(its_lightness_grows_evenly)
{
    float c[3];
    view_map_at(0, c);
    const double first = lightness(c);
    view_map_at(1, c);
    const double step = (lightness(c) - first) / 200;
    ck_assert_double_gt(200 * step, 70);
    double before = first;
    for (int i = 1; i <= 200; i++) {
        view_map_at(i / 200.0, c);
        const double now = lightness(c);
        ck_assert_msg(now - before > 0.5 * step && now - before < 1.6 * step, "at %d: %g to %g", i,
                      before, now);
        before = now;
    }
}

UNIT_TEST(a_scale_ends_where_it_says)
{
    const struct view_scale scale = {-2, 6};
    ck_assert_double_eq(view_scale_part(&scale, -2), 0);
    ck_assert_double_eq(view_scale_part(&scale, 0), 0.25);
    ck_assert_double_eq(view_scale_part(&scale, 6), 1);
    ck_assert_double_eq(view_scale_part(&scale, -9), 0);
    ck_assert_double_eq(view_scale_part(&scale, 1e9), 1);
}

UNIT_TEST(a_scale_goes_up_to_the_next_round_number)
{
    static const double round[][2] = {{0.9, 1},     {1, 1},       {1.01, 2}, {2, 2},
                                      {3, 5},       {5.1, 10},    {99, 100}, {0.0123, 0.02},
                                      {2e-9, 2e-9}, {4.9e7, 5e7}, {0, 1},    {-3, 1}};
    for (size_t i = 0; i < sizeof round / sizeof *round; i++) {
        const struct view_scale scale = view_scale_up_to(round[i][0]);
        ck_assert_double_eq(scale.min, 0);
        ck_assert_double_eq_tol(scale.max, round[i][1], 1e-12 * round[i][1]);
    }
    ck_assert_double_eq(view_scale_up_to((double)NAN).max, 1);
}

static void has_ticks(double min, double max, size_t n, const char *first, const char *last)
{
    struct view_ticks ticks;
    const struct view_scale scale = {min, max};
    view_scale_ticks(&scale, &ticks);
    ck_assert_uint_eq(ticks.n, n);
    ck_assert_str_eq(ticks.text[0], first);
    ck_assert_str_eq(ticks.text[n - 1], last);
}

UNIT_TEST(marks_are_round_numbers)
{
    has_ticks(0, 1, 6, "0.0", "1.0");
    has_ticks(0, 0.05, 6, "0.00", "0.05");
    has_ticks(0, 0.02, 5, "0.000", "0.020");
    has_ticks(-10, 50, 7, "-10", "50");
    has_ticks(0, 5000, 6, "0", "5000");
    has_ticks(0, 2e7, 5, "0", "2e+07");
    has_ticks(0, 1e-5, 6, "0", "1e-05");
    has_ticks(0.103, 0.117, 3, "0.105", "0.115");
}

UNIT_TEST(any_scale_has_some_marks_within)
{
    for (double max = 1e-12; max < 1e12; max *= 1.37)
        for (double min = -3; min < 1; min += 0.21) {
            struct view_ticks ticks;
            const struct view_scale scale = {min * max, max};
            view_scale_ticks(&scale, &ticks);
            ck_assert_msg(ticks.n >= 2 && ticks.n <= VIEW_TICKS, "%g to %g: %zu", scale.min, max,
                          ticks.n);
            for (size_t i = 0; i < ticks.n; i++) {
                ck_assert_double_ge(ticks.value[i], scale.min - 1e-5 * max);
                ck_assert_double_le(ticks.value[i], max + 1e-5 * max);
                ck_assert(i == 0 || ticks.value[i] > ticks.value[i - 1]);
            }
        }
}

enum { SIDE = 40 };
static uint32_t triangle[6 * (SIDE - 1) * (SIDE - 1)];
static int32_t part[SIDE * SIDE];

/* Squares of `size` x `size` vertices in a grid. How many there are. */
static uint32_t make_squares(int size)
{
    uint32_t *t = triangle, n = 0;
    const int row = (SIDE + size - 1) / size;
    for (uint32_t v = 0; v < SIDE * SIDE; v++) {
        part[v] = (int32_t)(v / SIDE) / size * row + (int32_t)(v % SIDE) / size;
        n = (uint32_t)part[v] + 1 > n ? (uint32_t)part[v] + 1 : n;
    }
    for (uint32_t j = 0; j + 1 < SIDE; j++)
        for (uint32_t i = 0; i + 1 < SIDE; i++) {
            const uint32_t v = j * SIDE + i;
            const uint32_t corner[6] = {v, v + SIDE, v + SIDE + 1, v, v + SIDE + 1, v + 1};
            memcpy(t, corner, sizeof corner);
            t += 6;
        }
    return n;
}

UNIT_TEST(neighbours_differ)
{
    unsigned char hue[SIDE * SIDE];
    unsigned near[SIDE * SIDE];
    for (int size = 1; size < SIDE; size++) {
        const uint32_t n = make_squares(size);
        view_hues_spread(sizeof triangle / sizeof *triangle / 3, triangle, part, n, hue, near);
        for (size_t i = 0; i < sizeof triangle / sizeof *triangle; i++) {
            const int32_t a = part[triangle[i]], b = part[triangle[i % 3 == 2 ? i - 2 : i + 1]];
            ck_assert_msg(a == b || hue[a] != hue[b], "%d and %d of %u", a, b, n);
            ck_assert_uint_lt(hue[a], VIEW_HUES);
        }
    }
}

UNIT_TEST(a_few_parts_have_the_colours_of_their_numbers)
{
    unsigned char hue[VIEW_HUES];
    unsigned near[VIEW_HUES];
    make_squares(20);
    part[5] = -1;
    view_hues_spread(sizeof triangle / sizeof *triangle / 3, triangle, part, 4, hue, near);
    for (unsigned p = 0; p < 4; p++)
        ck_assert_uint_eq(hue[p], p);
}
