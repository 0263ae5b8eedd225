/* Pairs of triangles whose answer is known, in every order of their corners, and moved by whole
 * metres. */
#include "cloth/verify/verify.h"
#include "tests/support/unit.h"

#include <math.h>

/* Six points; the second triangle has the corners b, the first one 0 1 2. */
struct pair {
    const char *name;
    double x[6][3];
    uint32_t b[3];
    bool meet;
};

#define ULP 0x1p-52
#define FLOOR                                                                                      \
    {0, 0, 0}, {1, 0, 0},                                                                          \
    {                                                                                              \
        0, 0, 1                                                                                    \
    }
#define OTHER                                                                                      \
    {                                                                                              \
        3, 4, 5                                                                                    \
    }

static const struct pair PAIRS[] = {
    {"one pierces the other", {FLOOR, {.2, -1, .2}, {.3, 1, .2}, {.2, 1, .3}}, OTHER, true},
    {"above each other", {FLOOR, {0, 1, 0}, {1, 1, 0}, {0, 1, 1}}, OTHER, false},
    {"the plane is crossed beside", {FLOOR, {2, -1, 2}, {2, 1, 2}, {2, 1, 3}}, OTHER, false},
    {"a corner on the face", {FLOOR, {.25, 0, .25}, {.25, 1, .25}, {.5, 1, .25}}, OTHER, true},
    {"a corner an ulp above the face",
     {FLOOR, {.25, ULP, .25}, {.25, 1, .25}, {.5, 1, .25}},
     OTHER,
     false},
    {"a corner an ulp below the face",
     {FLOOR, {.25, -ULP, .25}, {.25, 1, .25}, {.5, 1, .25}},
     OTHER,
     true},
    {"a corner 1e-9 m below the face",
     {FLOOR, {.25, -1e-9, .25}, {.25, 1, .25}, {.5, 1, .25}},
     OTHER,
     true},
    {"a corner 1e-60 m above the face",
     {FLOOR, {.25, 1e-60, .25}, {.25, 1, .25}, {.5, 1, .25}},
     OTHER,
     false},
    {"a corner 1e-60 m below the face",
     {FLOOR, {.25, -1e-60, .25}, {.25, 1, .25}, {.5, 1, .25}},
     OTHER,
     true},
    {"a corner on an edge", {FLOOR, {.5, 0, 0}, {.5, 1, -1}, {.7, 1, -1}}, OTHER, true},
    {"a corner an ulp beside an edge",
     {FLOOR, {.5, 0, -ULP}, {.5, 1, -1}, {.7, 1, -1}},
     OTHER,
     false},
    {"a corner on a corner", {FLOOR, {1, 0, 0}, {2, 1, 0}, {2, 1, 1}}, OTHER, true},
    {"an edge on an edge", {FLOOR, {0, 0, 0}, {1, 0, 0}, {.5, 1, -1}}, OTHER, true},
    {"edges that cross in one point", {FLOOR, {.5, -1, 0}, {.5, 1, 0}, {.5, 0, -1}}, OTHER, true},
    {"edges that miss by an ulp",
     {FLOOR, {.5, -1, -ULP}, {.5, 1, -ULP}, {.5, 0, -1}},
     OTHER,
     false},
    {"the same place", {FLOOR, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, OTHER, true},
    {"overlap in a plane", {FLOOR, {.1, 0, .1}, {2, 0, .1}, {.1, 0, 2}}, OTHER, true},
    {"inside the other in a plane", {FLOOR, {.1, 0, .1}, {.2, 0, .1}, {.1, 0, .2}}, OTHER, true},
    {"beside each other in a plane", {FLOOR, {1, 0, 1}, {2, 0, 1}, {1, 0, 2}}, OTHER, false},
    {"touch in a plane", {FLOOR, {.5, 0, .5}, {2, 0, 1}, {1, 0, 2}}, OTHER, true},
    {"on one line, but apart", {FLOOR, {2, 0, 0}, {3, 0, 0}, {2, 1, 0}}, OTHER, false},
    {"overlap in a slanted plane",
     {{0, 0, 0}, {1, 1, 0}, {0, 1, 1}, {.25, .5, .25}, {2, 2, 0}, {0, 2, 2}},
     OTHER,
     true},
    {"beside each other in a slanted plane",
     {{0, 0, 0}, {1, 1, 0}, {0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {1, 3, 2}},
     OTHER,
     false},
    {"a shared corner in a flat fan", {FLOOR, {-1, 0, 0}, {0, 0, -1}}, {0, 3, 4}, false},
    {"a shared corner in a roof", {FLOOR, {-1, 1, 0}, {0, 1, -1}}, {0, 3, 4}, false},
    {"a shared corner, folded over in the plane", {FLOOR, {1, 0, .5}, {.5, 0, 1}}, {0, 3, 4}, true},
    {"a shared corner, and the opposite edge pierces",
     {FLOOR, {.25, -1, .25}, {.25, 1, .25}},
     {0, 3, 4},
     true},
    {"a shared corner, and the opposite edge passes beside",
     {FLOOR, {.75, -1, -.25}, {.75, 1, -.25}},
     {0, 3, 4},
     false},
    {"a shared corner, and another corner on the face",
     {FLOOR, {.25, 0, .25}, {.25, 1, .25}},
     {0, 3, 4},
     true},
    {"a shared corner, and another corner an ulp above the face",
     {FLOOR, {.25, ULP, .25}, {.25, 1, .25}},
     {0, 3, 4},
     false},
    {"a shared corner, and edges on each other", {FLOOR, {.5, 0, 0}, {.5, 1, 0}}, {0, 3, 4}, true},
    {"a shared corner, and edges on each other the long way",
     {FLOOR, {2, 0, 0}, {.5, 1, 0}},
     {0, 3, 4},
     true},
    {"a shared edge", {FLOOR, {.1, 1, .1}}, {0, 1, 3}, false},
    {"a shared edge, folded flat", {FLOOR, {.1, 0, .1}}, {0, 1, 3}, false},
    {"without area, through the other",
     {FLOOR, {.25, -1, .25}, {.25, 1, .25}, {.25, 0, .25}},
     OTHER,
     true},
    {"without area, beside the other", {FLOOR, {2, -1, 2}, {2, 1, 2}, {2, 0, 2}}, OTHER, false},
    {"a point on the other", {FLOOR, {.25, 0, .25}, {.25, 0, .25}, {.25, 0, .25}}, OTHER, true},
    {"a point beside the other", {FLOOR, {1, 0, 1}, {1, 0, 1}, {1, 0, 1}}, OTHER, false},
    {"two lines that cross",
     {{0, 0, 0}, {1, 1, 1}, {.5, .5, .5}, {1, 0, 0}, {0, 1, 1}, {.25, .75, .75}},
     OTHER,
     true},
    {"two lines that miss",
     {{0, 0, 0}, {1, 1, 1}, {.5, .5, .5}, {1, ULP, 0}, {0, 1, 1}, {0, 1, 1}},
     OTHER,
     false},
};

/* Corners in the order k, of six. */
static void turn(const uint32_t from[3], int k, uint32_t to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = from[k < 3 ? (i + k) % 3 : (5 + k - i) % 3];
}

static void check_pair(const struct pair *pair, const double (*x)[3])
{
    static const uint32_t first[3] = {0, 1, 2};
    for (int k = 0; k < 36; k++) {
        uint32_t a[3], b[3];
        turn(first, k / 6, a);
        turn(pair->b, k % 6, b);
        ck_assert_msg(verify_meet(x, a, b) == pair->meet, "%s, in order %d", pair->name, k);
        ck_assert_msg(verify_meet(x, b, a) == pair->meet, "%s, in order %d, swapped", pair->name,
                      k);
    }
}

UNIT_TEST(known)
{
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; i++)
        check_pair(PAIRS + i, PAIRS[i].x);
}

/* Axes renamed. Half sizes and signs are exact. */
UNIT_TEST(turned)
{
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; i++)
        for (int k = 0; k < 6; k++) {
            double x[6][3];
            for (int p = 0; p < 6; p++)
                for (int c = 0; c < 3; c++)
                    x[p][c] = (k & 1 ? -0.5 : 1) * PAIRS[i].x[p][(c + k / 2) % 3];
            check_pair(PAIRS + i, (const double(*)[3])x);
        }
}

/* Far from the origin coordinates are coarse: steps of 2^-36 m at 65,536 m. */
UNIT_TEST(far_away)
{
    const double far[3] = {65536, -65536, 98304}, step = 0x1p-36;
    for (int k = -2; k <= 2; k++) {
        double x[6][3] = {FLOOR, {.25, 0, .25}, {.25, 1, .25}, {.5, 1, .25}};
        for (int p = 0; p < 6; p++)
            for (int c = 0; c < 3; c++)
                x[p][c] += far[c];
        x[3][1] += k * step;
        const struct pair pair = {"far away", {{0}}, OTHER, k <= 0};
        check_pair(&pair, (const double(*)[3])x);
    }
}

/* Corners that are next to a slanted plane: rounding has put each of them on some side of it, but
 * some ulps below the nearest double, and above it, no doubt is left. */
UNIT_TEST(slanted)
{
    static const uint32_t a[3] = {0, 1, 2}, b[3] = {3, 4, 5};
    for (int k = 1; k < 200; k++) {
        const double u = 0.1 * k / 200, v = 0.1 - 0.3 * u;
        double x[6][3] = {{.3, 0, 0},         {0, .3, 0}, {0, 0, .3},
                          {u, v, .3 - u - v}, {1, 1, 1},  {1, 2, 1}};
        double low = x[3][2], high = x[3][2];
        for (int i = 0; i < 4; i++) {
            low = nextafter(low, -1);
            high = nextafter(high, 1);
        }
        x[3][2] = low;
        ck_assert(verify_meet((const double(*)[3])x, a, b));
        x[3][2] = high;
        ck_assert(!verify_meet((const double(*)[3])x, a, b));
    }
}
