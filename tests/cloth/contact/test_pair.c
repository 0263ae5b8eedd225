/* Closest points are held against a plane: weights say that the features are no farther apart than
 * the gap, and all corners beyond planes across the normal that they are no nearer. */
#include "cloth/base/simd.h"
#include "cloth/contact/certificate.h"
#include "tests/cloth/contact/pairs.h"
#include "tests/support/unit.h"

#include <math.h>

static int n_first(enum contact_pair pair)
{
    return pair == CONTACT_VT ? 1 : 2;
}

/* The least along the normal of the first feature less the largest of the second. */
static double apart(enum contact_pair pair, const phys_vec x[4], const phys_vec *n)
{
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 4; k++) {
        const phys_vec from = x[k] - x[0];
        const double at = phys_dot(&from, n);
        if (k < n_first(pair))
            low = fmin(low, at);
        else
            high = fmax(high, at);
    }
    return low - high;
}

static double size_of(const phys_vec x[4])
{
    double size = 0;
    for (int k = 1; k < 4; k++) {
        const phys_vec way = x[k] - x[0];
        size = fmax(size, sqrt(phys_dot(&way, &way)));
    }
    return size;
}

static void check_weights(enum contact_pair pair, const struct contact_nearest *to)
{
    double sum[2] = {0};
    for (int k = 0; k < 4; k++) {
        const bool second = k >= n_first(pair);
        sum[second] += to->weight[k];
        PAIRS_CHECK(second ? to->weight[k] <= 0 : to->weight[k] >= 0);
    }
    PAIRS_CHECK(fabs(sum[0] - 1) <= 1e-15);
    PAIRS_CHECK(fabs(sum[1] + 1) <= 1e-15);
}

/* tolerance: of the size. */
static void check_nearest(enum contact_pair pair, const phys_vec x[4], double tolerance)
{
    struct contact_nearest to;
    phys_vec way = {0};
    contact_nearest_of(pair, x, &to);
    const double off = tolerance * size_of(x);
    check_weights(pair, &to);
    PAIRS_CHECK(to.gap >= 0);
    PAIRS_CHECK(fabs(phys_dot(&to.normal, &to.normal) - 1) <= 1e-14);
    for (int k = 0; k < 4; k++)
        way += to.weight[k] * (x[k] - x[0]);
    way -= to.gap * to.normal;
    PAIRS_CHECK(sqrt(phys_dot(&way, &way)) <= off);
    PAIRS_CHECK(apart(pair, x, &to.normal) >= to.gap - off);
}

UNIT_LOOP(closest, 0, PAIRS_SORTS_N)
{
    phys_vec x[4], y[4];
    const struct pairs_sort *sort = PAIRS_SORTS + _i;
    for (int i = 0, n = pairs_count(); i < n; i++) {
        pairs_draw(KINDS[i & 1], sort, x, y);
        check_nearest(KINDS[i & 1], x, sort->flat > 0 ? 2e-6 : 1e-9);
    }
}

/* The bits are the same with every instruction set. */
UNIT_TEST(same_bits)
{
    const enum cloth_simd widest = cloth_simd;
    struct contact_nearest wide, narrow;
    phys_vec x[4], y[4];
    for (int i = 0, n = pairs_count(); i < n; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        pairs_draw(pair, PAIRS_SORTS + i % PAIRS_SORTS_N, x, y);
        memset(&wide, 0, sizeof wide);
        memset(&narrow, 0, sizeof narrow);
        contact_nearest_of(pair, x, &wide);
        const bool certain = contact_certify(pair, x, y, THICKNESS);
        cloth_simd = CLOTH_SIMD_NONE;
        contact_nearest_of(pair, x, &narrow);
        PAIRS_CHECK(certain == contact_certify(pair, x, y, THICKNESS));
        cloth_simd = widest;
        PAIRS_CHECK(!memcmp(&wide, &narrow, sizeof wide));
    }
}

static void set(phys_vec x[4], const double corner[4][3])
{
    for (int k = 0; k < 4; k++)
        x[k] = (phys_vec){corner[k][0], corner[k][1], corner[k][2], 0};
}

/* Where the answer is known: kind, corners, gap, weights; a weight of 2 stands for any. */
static const struct known {
    enum contact_pair pair;
    double corner[4][3], gap, weight[4];
} KNOWN[] = {
    {CONTACT_VT, {{1, 1, 2}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 2, {1, -0.5, -0.25, -0.25}},
    {CONTACT_VT, {{1, -3, 4}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 5, {1, -0.75, -0.25, 0}},
    {CONTACT_VT,
     {{4, 4, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
     2.8284271247461903,
     {1, 0, -0.5, -0.5}},
    {CONTACT_VT, {{-3, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 3, {1, -0.75, 0, -0.25}},
    {CONTACT_VT, {{-3, 0, -4}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 5, {1, -1, 0, 0}},
    {CONTACT_VT, {{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 0, {1, -0.5, -0.25, -0.25}},
    {CONTACT_VT, {{2, 0, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 0, {1, -0.5, -0.5, 0}},
    {CONTACT_VT, {{0, 4, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 0, {1, 0, 0, -1}},
    {CONTACT_VT, {{1, 3, 0}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, 3, {1, 2, 2, 2}},
    {CONTACT_VT, {{1, 0, 0}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, 0, {1, 2, 2, 2}},
    {CONTACT_VT, {{0, 3, 4}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 5, {1, 2, 2, 2}},
    {CONTACT_VT, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 0, {1, 2, 2, 2}},
    {CONTACT_EE, {{-1, 0, 3}, {3, 0, 3}, {0, -1, 0}, {0, 1, 0}}, 3, {0.75, 0.25, -0.5, -0.5}},
    {CONTACT_EE, {{-1, 0, 0}, {3, 0, 0}, {0, -1, 0}, {0, 1, 0}}, 0, {0.75, 0.25, -0.5, -0.5}},
    {CONTACT_EE, {{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {9, 2, 0}}, 2, {2, 2, 2, 2}},
    {CONTACT_EE, {{0, 0, 0}, {4, 0, 0}, {7, 4, 0}, {9, 4, 0}}, 5, {0, 1, -1, 0}},
    {CONTACT_EE, {{0, 0, 0}, {4, 0, 0}, {2, 0, 0}, {9, 0, 0}}, 0, {2, 2, 2, 2}},
    {CONTACT_EE, {{0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {4, 5, 0}}, 0, {0, 1, -1, 0}},
    {CONTACT_EE, {{1, 0, 2}, {1, 0, 2}, {0, 0, 0}, {4, 0, 0}}, 2, {2, 2, -0.75, -0.25}},
    {CONTACT_EE, {{1, 0, 2}, {1, 0, 2}, {1, 0, 2}, {1, 0, 2}}, 0, {2, 2, 2, 2}},
};
enum { N_KNOWN = sizeof KNOWN / sizeof *KNOWN };

UNIT_TEST(known)
{
    for (int i = 0; i < N_KNOWN; i++) {
        struct contact_nearest to;
        phys_vec x[4];
        set(x, KNOWN[i].corner);
        contact_nearest_of(KNOWN[i].pair, x, &to);
        ck_assert_msg(fabs(to.gap - KNOWN[i].gap) <= 1e-15, "case %d: gap %g", i, to.gap);
        check_nearest(KNOWN[i].pair, x, 1e-15);
        for (int k = 0; k < 4; k++)
            ck_assert_msg(KNOWN[i].weight[k] > 1.5 ||
                              fabs(to.weight[k] - KNOWN[i].weight[k]) <= 1e-15,
                          "case %d: weight %d is %g", i, k, to.weight[k]);
    }
}

/* At a gap of 0 inside both features the normal is across both. */
UNIT_TEST(touching)
{
    for (int i = 0; i < N_KNOWN; i++) {
        struct contact_nearest to;
        phys_vec x[4], a, b;
        set(x, KNOWN[i].corner);
        contact_nearest_of(KNOWN[i].pair, x, &to);
        a = KNOWN[i].pair == CONTACT_VT ? x[2] - x[1] : x[1] - x[0];
        b = KNOWN[i].pair == CONTACT_VT ? x[3] - x[1] : x[3] - x[2];
        ck_assert(to.gap > 0 || fabs(phys_dot(&to.normal, &a)) <= 1e-15);
        ck_assert(to.gap > 0 || fabs(phys_dot(&to.normal, &b)) <= 1e-15);
    }
}
