/* The sweep finds the pairs that all pairs, tried one by one, have. */
#include "cloth/verify/verify.h"
#include "tests/support/random.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 400, POINTS = 3 * TRIANGLES };

struct soup {
    double x[POINTS][3];
    uint32_t corner[TRIANGLES][3];
    struct verify_soup made;
};

/* Triangles of a size in a box, some of them `giant`; shared: each has a corner of the one before.
 */
static struct verify_soup *make(struct soup *soup, const double box[3], double size, double giant,
                                bool shared)
{
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        double middle[3];
        const double reach = t % 50 == 7 && giant > 0 ? giant : size;
        for (int c = 0; c < 3; c++)
            middle[c] = uniform(-box[c], box[c]);
        for (uint32_t i = 0; i < 3; i++) {
            soup->corner[t][i] = 3 * t + i;
            for (int c = 0; c < 3; c++)
                soup->x[3 * t + i][c] = middle[c] + uniform(-reach, reach) * (box[c] > 0);
        }
        if (shared && t % 3)
            soup->corner[t][0] = soup->corner[t - 1][2];
    }
    soup->made = (struct verify_soup){.n_points = POINTS,
                                      .n_triangles = TRIANGLES,
                                      .n_first = TRIANGLES,
                                      .x = (const double(*)[3])soup->x,
                                      .corner = (const uint32_t(*)[3])soup->corner};
    return &soup->made;
}

/* Returns how many pairs there are. */
static size_t check_soup(const struct verify_soup *soup)
{
    struct cloth_list list = {0};
    UNIT_FINE(verify_pairs(soup, &list, &error));
    const struct verify_pair *pair = list.items;
    size_t n = 0;
    for (uint32_t a = 0; a < soup->n_first; a++)
        for (uint32_t b = a + 1; b < soup->n_triangles; b++) {
            if (!verify_meet(soup->x, soup->corner[a], soup->corner[b]))
                continue;
            ck_assert_msg(n < list.n && pair[n].triangle[0] == a && pair[n].triangle[1] == b,
                          "the pair %u %u is not pair %zu of %zu", a, b, n, list.n);
            n++;
        }
    ck_assert_uint_eq(n, list.n);
    free(list.items);
    return n;
}

UNIT_TEST(soups)
{
    static struct soup soup;
    static const double boxes[][3] = {{1, 1, 1}, {1, 1, 0.01},   {0.01, 3, 0.01}, {1, 0, 1},
                                      {0, 0, 0}, {1e-3, 1e3, 1}, {0, 5, 0}};
    size_t least = SIZE_MAX, n;
    for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++)
        for (int k = 0; k < 12; k++) {
            struct verify_soup *made =
                make(&soup, boxes[b], k % 3 ? 0.1 : 0.3, k % 4 ? 0 : 2, k & 1);
            made->n_first = k % 5 ? TRIANGLES : TRIANGLES / 3;
            n = check_soup(made);
            least = b == 0 && n < least ? n : least;
        }
    ck_assert_uint_gt(least, 0);
}

UNIT_TEST(far_away)
{
    static struct soup soup;
    struct verify_soup *made = make(&soup, (const double[3]){1, 1, 1}, 0.1, 0, false);
    for (int p = 0; p < 30; p++)
        soup.x[p][p % 3] = 1e6;
    ck_assert_uint_gt(check_soup(made), 0);
}

UNIT_TEST(few)
{
    static struct soup soup;
    struct verify_soup *made = make(&soup, (const double[3]){1, 1, 1}, 1, 0, false);
    for (uint32_t n = 0; n < 5; n++) {
        made->n_triangles = made->n_first = n;
        check_soup(made);
    }
    made->n_triangles = 5;
    made->n_first = 0;
    ck_assert_uint_eq(check_soup(made), 0);
}

/* Numbers without an exact answer are refused; those below the least that it can have are 0. */
UNIT_TEST(bounds)
{
    static struct soup soup;
    static const double wrong[] = {NAN, INFINITY, -INFINITY, 1e61};
    struct cloth_list list = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct verify_soup *made = make(&soup, (const double[3]){1, 1, 1}, 0.1, 0, false);
        soup.x[77][1] = wrong[i];
        UNIT_REFUSED(verify_pairs(made, &list, &error), CLOTH_E_RUN, "point 77");
    }
    struct cloth_error error = {0};
    struct verify_soup *made = make(&soup, (const double[3]){1, 1, 1}, 0.1, 0, false);
    const double x[6][3] = {{0, 0, 0},        {1, 0, 0},   {0, 0, 1},
                            {.2, 1e-300, .2}, {.2, 1, .2}, {.3, 1, .2}};
    memcpy(soup.x, x, sizeof x);
    made->n_triangles = made->n_first = 2;
    ck_assert_int_eq(verify_pairs(made, &list, &error), CLOTH_OK);
    ck_assert_uint_eq(list.n, 1);
    free(list.items);
}

/* Two triangles that cross are a pair, unless a corner of one is sewn to one of the other. */
UNIT_TEST(sewn)
{
    static struct soup soup;
    static const uint32_t joined[3][6] = {
        {0, 1, 2, 3, 4, 5}, {0, 1, 2, 0, 4, 5}, {0, 1, 2, 3, 3, 5}};
    static const double x[6][3] = {{0, 0, 0},     {1, 0, 0},    {0, 1, 0},
                                   {.2, .2, -.2}, {.2, .2, .8}, {.3, .9, .3}};
    struct verify_soup *made = make(&soup, (const double[3]){1, 1, 1}, 1, 0, false);
    memcpy(soup.x, x, sizeof x);
    made->n_triangles = made->n_first = 2;
    for (int i = -1; i < 3; i++) {
        struct cloth_list list = {0};
        made->joined = i < 0 ? NULL : joined[i];
        UNIT_FINE(verify_pairs(made, &list, &error));
        ck_assert_uint_eq(list.n, i != 1);
        free(list.items);
    }
}
