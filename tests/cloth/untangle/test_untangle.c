/* Starts that are tangled at random, of two sheets and of one that is folded, are free afterwards
 * by the exact check and by brute force; what is held stays, edges keep their lengths nearly, and
 * the same start gives the same bits. */
#include "cloth/contact/pair.h"
#include "cloth/untangle/untangle.h"
#include "cloth/verify/orient.h"
#include "cloth/verify/verify.h"
#include "tests/support/random.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 24, POINTS = SIDE * SIDE, SHEETS = 2, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };
static const double EDGE = 8e-3, THICKNESS = 2e-3; /* m */

static phys_vec start[SHEETS * POINTS], x[SHEETS * POINTS];
static uint32_t corner[SHEETS * TRIANGLES][3], layer[SHEETS];
static unsigned char held[SHEETS * POINTS];
static uint32_t sheets;
static const struct contact_apart *ignored; /* NULL: all meet */

/* ---- Sheets ---- */

static void make_sheets(uint32_t n)
{
    uint32_t t = 0;
    sheets = n;
    memset(held, 0, sizeof held);
    memset(layer, 0, sizeof layer);
    for (uint32_t s = 0; s < n; s++)
        for (uint32_t i = 0; i < SIDE - 1; i++)
            for (uint32_t j = 0; j < SIDE - 1; j++) {
                const uint32_t v = s * POINTS + i * SIDE + j;
                const uint32_t both[2][3] = {{v, v + SIDE + 1, v + 1}, {v, v + SIDE, v + SIDE + 1}};
                for (int k = 0; k < 2; k++)
                    memcpy(corner[t++], both[k], sizeof *corner);
            }
}

/* Waves of up to `high` (m) in all, on each sheet its own; the sheets are `apart` (m). Triangles
 * face up. */
static void wave_sheets(double high, double apart)
{
    for (uint32_t s = 0; s < sheets; s++) {
        double vector[3][3];
        for (int w = 0; w < 3; w++) {
            vector[w][0] = uniform(-70, 70);
            vector[w][1] = uniform(-70, 70);
            vector[w][2] = uniform(0, 6);
        }
        for (uint32_t i = 0; i < POINTS; i++) {
            const double u = EDGE * (i / SIDE), v = EDGE * (i % SIDE);
            double y = apart * s;
            for (int w = 0; w < 3; w++)
                y += high / 3 * sin(vector[w][0] * u + vector[w][1] * v + vector[w][2]);
            start[s * POINTS + i] = (phys_vec){v + 1e-4 * s, y, u + 2e-4 * s, 0};
        }
    }
}

/* One sheet, folded over along its middle, 8 mm from itself; its upper half has dips of `deep` (m).
 */
static void fold_sheet(double deep)
{
    const double radius = 4e-3, bend = 2 * atan(1) * radius, middle = 0.5 * EDGE * (SIDE - 1);
    const double at[2][2] = {{uniform(-0.07, -0.03), uniform(0.03, 0.08)},
                             {uniform(-0.07, -0.03), uniform(0.1, 0.15)}};
    for (uint32_t i = 0; i < POINTS; i++) {
        const double s = EDGE * (i / SIDE) - middle, z = EDGE * (i % SIDE);
        double along = radius * cos(s / radius), y = radius * sin(s / radius);
        if (s < -bend || s > bend) {
            along = bend - fabs(s);
            y = s > 0 ? radius : -radius;
        }
        for (int k = 0; k < 2 && s > bend; k++)
            y -= deep * exp(-(pow(along - at[k][0], 2) + pow(z - at[k][1], 2)) / 3e-4);
        start[i] = (phys_vec){along, y, z, 0};
    }
}

/* ---- What is looked at ---- */

static uint32_t count_triangles(void)
{
    return sheets * TRIANGLES;
}

static size_t count_pairs(const phys_vec *at)
{
    static double place[SHEETS * POINTS][3];
    struct cloth_list pairs = {0};
    for (uint32_t p = 0; p < sheets * POINTS; p++)
        for (int c = 0; c < 3; c++)
            place[p][c] = verify_coordinate(at[p][c]);
    const struct verify_soup soup = {.n_points = sheets * POINTS,
                                     .n_triangles = count_triangles(),
                                     .n_first = count_triangles(),
                                     .x = (const double(*)[3])place,
                                     .corner = (const uint32_t(*)[3])corner};
    UNIT_FINE(verify_pairs(&soup, &pairs, &error));
    free(pairs.items);
    return pairs.n;
}

/* The least gap between a vertex and a triangle without it. */
static double least_gap(void)
{
    double least = INFINITY;
    for (uint32_t p = 0; p < sheets * POINTS; p++)
        for (uint32_t t = 0; t < count_triangles(); t++) {
            const uint32_t *c = corner[t];
            const phys_vec four[4] = {x[p], x[c[0]], x[c[1]], x[c[2]]};
            const phys_vec away = x[p] - x[c[0]];
            struct contact_nearest nearest;
            if (c[0] == p || c[1] == p || c[2] == p || phys_dot(&away, &away) > 4 * EDGE * EDGE)
                continue;
            contact_nearest_of(CONTACT_VT, four, &nearest);
            least = fmin(least, nearest.gap);
        }
    return least;
}

/* The most that an edge of a triangle is longer or shorter than it was, as a factor. */
static double stretch(void)
{
    double most = 1;
    for (uint32_t t = 0; t < count_triangles(); t++)
        for (int k = 0; k < 3; k++) {
            const uint32_t a = corner[t][k], b = corner[t][(k + 1) % 3];
            const phys_vec was = start[b] - start[a], is = x[b] - x[a];
            const double factor = sqrt(phys_dot(&is, &is) / phys_dot(&was, &was));
            most = fmax(most, fmax(factor, 1 / factor));
        }
    return most;
}

static struct untangle_result run(void)
{
    struct contact_surface surface[SHEETS + 1];
    for (uint32_t s = 0; s <= sheets; s++)
        surface[s] = (struct contact_surface){s * POINTS, s * TRIANGLES};
    const struct contact_soup soup = {.n_cloths = sheets, .surface = surface, .welded = corner};
    const struct untangle_cloths cloths = {
        .soup = &soup, .layer = layer, .held = held, .apart = ignored, .thickness = THICKNESS};
    struct untangle_result result;
    memcpy(x, start, sizeof x);
    UNIT_FINE(untangle(&cloths, x, NULL, &result, &error));
    return result;
}

static void expect_free(int seed, const struct untangle_result *result)
{
    const struct untangle_count *left = &result->left;
    ck_assert_msg(!(left->pairs + left->entered + left->near + left->layers) && !count_pairs(x),
                  "seed %d: %lu pairs, %lu near, %lu in layers are left after %u rounds", seed,
                  (unsigned long)left->pairs, (unsigned long)left->near,
                  (unsigned long)left->layers, result->rounds);
    ck_assert_msg(least_gap() >= 0.1 * THICKNESS * (1 - 1e-9), "seed %d: a gap of %g m", seed,
                  least_gap());
    ck_assert_msg(stretch() < 1.6, "seed %d: an edge is %g times as long", seed, stretch());
}

/* ---- Cases ---- */

static int seeds(void)
{
    return unit_quick() ? 3 : 12;
}

UNIT_TEST(sheets_through_each_other)
{
    make_sheets(2);
    for (int seed = 1; seed <= seeds(); seed++) {
        random_seed = (uint64_t)seed;
        const double high = uniform(4e-3, 12e-3);
        wave_sheets(high, uniform(1e-3, 6e-3));
        ck_assert(count_pairs(start) > 0);
        const struct untangle_result result = run();
        expect_free(seed, &result);
    }
}

UNIT_TEST(a_sheet_through_itself)
{
    make_sheets(1);
    for (int seed = 1; seed <= seeds(); seed++) {
        random_seed = (uint64_t)seed;
        fold_sheet(uniform(9e-3, 13e-3));
        ck_assert(count_pairs(start) > 0);
        const struct untangle_result result = run();
        expect_free(seed, &result);
    }
}

/* The upper sheet is the inner one, all of it or part. The outer one goes down through it: up is
 * where triangles face. */
UNIT_TEST(layers)
{
    make_sheets(2);
    for (int seed = 1; seed <= seeds(); seed++) {
        random_seed = (uint64_t)seed;
        const double high = uniform(1e-3, 4e-3);
        wave_sheets(high, uniform(1e-3, 8e-3));
        layer[0] = 3;
        layer[1] = 1;
        const struct untangle_result result = run();
        expect_free(seed, &result);
        for (uint32_t p = 0; p < POINTS; p++) /* within the border both have the same places */
            if (p / SIDE > 2 && p / SIDE < SIDE - 3 && p % SIDE > 2 && p % SIDE < SIDE - 3)
                ck_assert_msg(x[p][1] > x[POINTS + p][1], "seed %d: vertex %u is inside", seed, p);
        ck_assert(!memcmp(x + POINTS, start + POINTS, sizeof x / 2) || result.moved > 0);
    }
}

/* Every fifth vertex of the first sheet. */
UNIT_TEST(what_is_held_stays)
{
    make_sheets(2);
    for (uint32_t p = 0; p < POINTS; p += 5)
        held[p] = 1;
    random_seed = 7;
    wave_sheets(8e-3, 4e-3);
    const struct untangle_result result = run();
    expect_free(7, &result);
    for (uint32_t p = 0; p < POINTS; p += 5)
        ck_assert(!memcmp(x + p, start + p, sizeof *x));
}

UNIT_TEST(the_same_bits)
{
    static phys_vec first[SHEETS * POINTS];
    make_sheets(2);
    random_seed = 3;
    wave_sheets(8e-3, 4e-3);
    run();
    memcpy(first, x, sizeof x);
    run();
    ck_assert(!memcmp(first, x, sizeof x));
}

UNIT_TEST(a_free_start_stays)
{
    make_sheets(2);
    random_seed = 3;
    wave_sheets(2e-3, 5e-3);
    const struct untangle_result result = run();
    ck_assert_uint_eq(result.rounds, 0);
    ck_assert_uint_eq(result.moved, 0);
    ck_assert(!memcmp(x, start, sizeof x));
}

UNIT_TEST(what_does_not_meet_stays)
{
    static unsigned char table[SHEETS * SHEETS] = {0, 1, 1, 0};
    const struct contact_apart all = {.n_cloths = SHEETS, .apart = table};
    make_sheets(2);
    random_seed = 3;
    wave_sheets(8e-3, 4e-3);
    ignored = &all;
    const struct untangle_result result = run();
    ignored = NULL;
    ck_assert_uint_eq(result.moved, 0);
}

/* Sheets that cut into each other from their borders, upright ones: nothing is cut off, and the
 * contour tells the way. */
UNIT_TEST(borders_that_cut_each_other)
{
    make_sheets(2);
    for (uint32_t s = 0; s < 2; s++)
        for (uint32_t i = 0; i < POINTS; i++) {
            const double u = EDGE * (i / SIDE), v = EDGE * (i % SIDE) - 0.5 * EDGE * SIDE;
            const double far = u - 1.7e-3;
            start[s * POINTS + i] = s ? (phys_vec){-far, 0.1 * far, v + 1e-3, 0}
                                      : (phys_vec){far, v - 1.3e-3, 0.1 * far, 0};
        }
    ck_assert(count_pairs(start) > 0);
    const struct untangle_result result = run();
    expect_free(0, &result);
}
