/* Certificates of known cases; a cut makes one hold, also where corners are cut further.
 * test_certificate_exact.c asks if the certain is true. */
#include "cloth/contact/certificate.h"
#include "tests/cloth/contact/pairs.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>

/* ---- Known cases ---- */

/* A vertex over a triangle, or an edge over one that it crosses, so high; each goes down by so
 * much. */
static void lay(enum contact_pair pair, double height, double first_down, double second_down,
                phys_vec x[4], phys_vec y[4])
{
    static const double CORNER[2][4][3] = {{{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                                           {{-1, 0, 0}, {3, 0, 0}, {0, -1, 0}, {0, 1, 0}}};
    const int n_first = pair == CONTACT_VT ? 1 : 2;
    for (int k = 0; k < 4; k++) {
        const double *c = CORNER[pair == CONTACT_EE][k];
        x[k] = (phys_vec){0.005 * c[0], 0.005 * c[1], k < n_first ? height : 0, 0};
        y[k] = x[k] - (phys_vec){0, 0, k < n_first ? first_down : second_down, 0};
    }
}

static bool certain(enum contact_pair pair, double height, double first_down, double second_down)
{
    phys_vec x[4], y[4];
    lay(pair, height, first_down, second_down, x, y);
    return contact_certify(pair, x, y, THICKNESS);
}

UNIT_TEST(known)
{
    for (int i = 0; i < 2; i++) {
        const enum contact_pair pair = KINDS[i];
        ck_assert(certain(pair, 1e-3, 0, 0));
        ck_assert(certain(pair, 1e-3, 0.9e-3 - 1e-9, 0)); /* a tenth of the thickness is left */
        ck_assert(!certain(pair, 1e-3, 0.9e-3 + 1e-9, 0));
        ck_assert(!certain(pair, 1e-3, 1e-3, 0));
        ck_assert(!certain(pair, 1e-3, 2e-3, 0)); /* through */
        ck_assert(!certain(pair, 1e-3, 5, 0));
        ck_assert(certain(pair, 1e-3, 5, 5)); /* together */
        ck_assert(certain(pair, 1e-3, 5, 6));
        ck_assert(certain(pair, 1e-4, 0.49e-4, 0)); /* half of a small gap is left */
        ck_assert(!certain(pair, 1e-4, 0.51e-4, 0));
        ck_assert(certain(pair, CONTACT_MARGIN, 0, 0));
        ck_assert(certain(pair, 0.6 * CONTACT_MARGIN, -0.1 * CONTACT_MARGIN, 0)); /* opens */
        ck_assert(!certain(pair, 1.5 * CONTACT_MARGIN, 0.6 * CONTACT_MARGIN, 0));
        ck_assert(!certain(pair, 0, 0, 0));
        ck_assert(!certain(pair, 0, -1, 0)); /* touches at the start */
    }
}

/* A pair at the margin, within 2 m of the origin along each axis, does not touch in floats. */
UNIT_TEST(apart_in_floats)
{
    static const struct pairs_sort AT_MARGIN = {"", 0.01, 0, 0, 1.9, CONTACT_MARGIN, 0, 0};
    for (int i = 0; i < 20000; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        struct contact_nearest nearest;
        phys_vec x[4], y[4];
        pairs_draw(pair, &AT_MARGIN, x, y);
        contact_nearest_of(pair, x, &nearest);
        for (int k = 0; k < 4; k++)
            for (int c = 0; c < 3; c++)
                y[k][c] = (float)x[k][c];
        double between[2] = {INFINITY, INFINITY}; /* least of the first, of minus the second */
        for (int k = 0; k < 4; k++) {
            const bool first = k < (pair == CONTACT_VT ? 1 : 2);
            const phys_vec from = y[k] - y[3];
            const double height = phys_dot(&nearest.normal, &from);
            between[!first] = fmin(between[!first], first ? height : -height);
        }
        ck_assert_double_gt(between[0] + between[1], 0);
    }
}

/* Features 1 um apart turn together by 0.2: no plane of one direction divides them. */
UNIT_TEST(turned)
{
    static const double TURN = 0.2, GAP = 1e-6;
    for (int i = 0; i < 2; i++)
        for (int closes = 0; closes < 2; closes++) {
            phys_vec x[4], y[4];
            lay(KINDS[i], GAP, closes ? 0.6 * GAP : 0, 0, x, y);
            for (int k = 0; k < 4; k++) {
                const phys_vec at = y[k];
                y[k] = (phys_vec){cos(TURN) * at[0] - sin(TURN) * at[2], at[1],
                                  sin(TURN) * at[0] + cos(TURN) * at[2], 0};
            }
            ck_assert(contact_certify(KINDS[i], x, y, THICKNESS) == !closes);
        }
}

UNIT_TEST(not_finite)
{
    const double value[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 8; k++)
            for (int j = 0; j < 3; j++) {
                phys_vec x[4], y[4];
                double t[4] = {1, 1, 1, 1};
                lay(KINDS[i], 1e-3, 0, 0, x, y);
                if (k < 4)
                    x[k] = (phys_vec){0, 0, value[j], 0};
                else
                    y[k - 4] = (phys_vec){0, 0, value[j], 0};
                ck_assert(!contact_certify(KINDS[i], x, y, THICKNESS));
                ck_assert(!contact_cut(KINDS[i], x, y, THICKNESS, 0, t));
            }
}

/* ---- Cuts ---- */

/* True if the plane of a cut may move. */
static bool flies(const phys_vec x[4], const phys_vec y[4])
{
    double least = INFINITY;
    for (int k = 0; k < 4; k++) {
        const phys_vec way = y[k] - x[k];
        least = fmin(least, sqrt(phys_dot(&way, &way)));
    }
    return least > 2 * THICKNESS;
}

/* A cut holds, also if other pairs cut the same corners further, now or in a later round. If the
 * plane may have moved with such corners, it holds once the pair is cut again. */
static void check_cut(enum contact_pair pair, const phys_vec x[4], const phys_vec y[4],
                      unsigned held, const double t[4])
{
    phys_vec end[4], further[4];
    double less[4], again[4] = {1, 1, 1, 1};
    pairs_end(x, y, held, t, end);
    PAIRS_CHECK(contact_certify(pair, x, end, THICKNESS));
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 4; k++)
            less[k] = i == k ? 0 : uniform(0, 1) * (i % 2 ? t[k] : 1);
        pairs_end(x, i % 2 ? y : end, held, less, further);
        if (contact_certify(pair, x, further, THICKNESS))
            continue;
        PAIRS_CHECK(flies(x, y));
        if (held)
            continue;
        PAIRS_CHECK(contact_cut(pair, x, further, THICKNESS, held, again));
        pairs_end(x, further, held, again, end);
        PAIRS_CHECK(contact_certify(pair, x, end, THICKNESS));
    }
}

/* Pairs that hold at the start, so that a cut must be possible where no corner is held. */
static bool starts(enum contact_pair pair, const phys_vec x[4])
{
    return contact_certify(pair, x, x, THICKNESS);
}

UNIT_LOOP(cuts, 0, PAIRS_SORTS_N)
{
    const struct pairs_sort *sort = PAIRS_SORTS + _i;
    int uncut = 0, cut = 0, refused = 0, n = pairs_count();
    for (int i = 0; i < n; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        const unsigned held = i % 3 ? 0 : (unsigned)uniform(0, 16);
        double t[4] = {1, 1, 1, 1};
        phys_vec x[4], y[4];
        pairs_draw(pair, sort, x, y);
        if (contact_certify(pair, x, y, THICKNESS)) {
            uncut++;
            continue;
        }
        if (!contact_cut(pair, x, y, THICKNESS, held, t)) {
            PAIRS_CHECK(held || !starts(pair, x));
            refused++;
            continue;
        }
        for (int k = 0; k < 4; k++)
            PAIRS_CHECK(t[k] >= 0 && t[k] <= 1 && (t[k] == 1 || !(held >> k & 1)));
        check_cut(pair, x, y, held, t);
        cut++;
    }
    printf("# %s: %d of %d uncut, %d cut, %d refused\n", sort->name, uncut, n, cut, refused);
}

/* Pairs that pass by are farther apart than the reach at both ends, as nearest points are, and all
 * that passes is certified. */
UNIT_LOOP(passes_by, 0, PAIRS_SORTS_N)
{
    const struct pairs_sort *sort = PAIRS_SORTS + _i;
    int by = 0, far = 0, n = pairs_count();
    for (int i = 0; i < n; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        struct contact_nearest begin, end;
        phys_vec x[4], y[4];
        pairs_draw(pair, sort, x, y);
        contact_nearest_of(pair, x, &begin);
        contact_nearest_of(pair, y, &end);
        const double nearer = fmin(begin.gap, end.gap), reach = uniform(0, 1.5) * nearer;
        const enum contact_passing is = contact_pass(pair, x, y, THICKNESS, reach);
        PAIRS_CHECK((is != CONTACT_MAY_TOUCH) == contact_certify(pair, x, y, THICKNESS));
        PAIRS_CHECK(is != CONTACT_PASSES_BY || nearer > reach);
        by += is == CONTACT_PASSES_BY;
        far += is == CONTACT_PASSES && nearer > reach;
    }
    printf("# %s: %d of %d pass by, %d more are as far\n", sort->name, by, n, far);
}

/* Pairs get the verdict among others that they get alone. */
UNIT_LOOP(at_once, 0, PAIRS_SORTS_N)
{
    enum { MOST = 13 };
    for (int i = 0, n = pairs_count() / MOST; i < n; i++) {
        struct contact_moving moving[MOST];
        enum contact_passing is[MOST];
        const size_t some = (size_t)i % MOST + 1;
        for (size_t k = 0; k < some; k++) {
            moving[k].pair = KINDS[uniform(0, 1) < 0.5];
            pairs_draw(moving[k].pair, PAIRS_SORTS + _i, moving[k].x, moving[k].y);
        }
        contact_pass_all(some, moving, THICKNESS, 0.002, is);
        for (size_t k = 0; k < some; k++)
            PAIRS_CHECK(is[k] ==
                        contact_pass(moving[k].pair, moving[k].x, moving[k].y, THICKNESS, 0.002));
    }
}

/* Steps towards each other without end: each is certified after its cut, and the gap stays. */
UNIT_TEST(again_and_again)
{
    for (int i = 0; i < 2; i++) {
        double height = 1e-3;
        for (int step = 0; step < 100; step++) {
            double t[4] = {1, 1, 1, 1};
            phys_vec x[4], y[4], end[4];
            lay(KINDS[i], height, 1e-2, -1e-3, x, y);
            ck_assert(contact_cut(KINDS[i], x, y, THICKNESS, 0, t));
            pairs_end(x, y, 0, t, end);
            ck_assert(contact_certify(KINDS[i], x, end, THICKNESS));
            height = end[0][2] - end[3][2];
        }
        ck_assert(height >= CONTACT_MARGIN);
    }
}

/* t as other pairs left it is only lowered; of a side that does not move nothing is taken. */
UNIT_TEST(lowered)
{
    for (int i = 0; i < 2; i++) {
        double t[4] = {0.01, 0.01, 1, 1};
        phys_vec x[4], y[4];
        lay(KINDS[i], 1e-3, 1e-2, 0, x, y);
        if (KINDS[i] == CONTACT_VT)
            t[1] = 1;
        ck_assert(contact_cut(KINDS[i], x, y, THICKNESS, 0, t));
        ck_assert(t[0] == 0.01 && t[2] == 1 && t[3] == 1);
        for (int k = 0; k < 4; k++)
            t[k] = 1;
        ck_assert(contact_cut(KINDS[i], x, y, THICKNESS, 0, t));
        ck_assert(t[0] > 0.08 && t[0] < 0.09 &&
                  t[3] == 1); /* 0.1 of the way to the plane is left */
    }
}

/* Features that fly together lose but what they come nearer, and those in front nothing. */
UNIT_TEST(flown)
{
    for (int i = 0; i < 2; i++)
        for (int down = 0; down < 2; down++) {
            const double fall = down ? 0.1 : -0.1, closing = 2e-3;
            double t[4] = {1, 1, 1, 1};
            phys_vec x[4], y[4];
            lay(KINDS[i], 1e-3, fall + (down ? closing : 0), fall - (down ? 0 : closing), x, y);
            ck_assert(contact_cut(KINDS[i], x, y, THICKNESS, 0, t));
            const int behind = down ? 0 : 3, before = 3 - behind;
            ck_assert(t[before] == 1);
            ck_assert(t[behind] < 1 && (1 - t[behind]) * 0.1 < closing);
            check_cut(KINDS[i], x, y, 0, t);
        }
}

/* An obstacle that comes pushes the plane as far as there is room; into the cloth it is refused. */
UNIT_TEST(pushed)
{
    for (int i = 0; i < 2; i++) {
        const enum contact_pair pair = KINDS[i];
        const unsigned below = pair == CONTACT_VT ? 0xe : 0xc;
        for (double rise = 0; rise < 2e-3; rise += 1e-4) {
            double t[4] = {1, 1, 1, 1};
            phys_vec x[4], y[4];
            lay(pair, 1e-3, 1e-2, -rise, x, y);
            const bool is_cut = contact_cut(pair, x, y, THICKNESS, below, t);
            ck_assert(is_cut == (rise < 0.9e-3 - 1e-9));
            ck_assert(t[3] == 1);
            if (is_cut)
                check_cut(pair, x, y, below, t);
        }
    }
}
