#ifndef TESTS_CLOTH_CONTACT_PAIRS_H
#define TESTS_CLOTH_CONTACT_PAIRS_H

/* Random pairs of features that move, of several sorts. */
#include "cloth/contact/certificate.h"
#include "tests/support/random.h"

#include <check.h>
#include <stdlib.h>
#include <string.h>

struct pairs_sort {
    const char *name;
    double size;   /* m: corners lie in a cube of that side */
    double way;    /* m: own way of a corner along each axis, at most */
    double common; /* m: of all corners along each axis, at most */
    double offset; /* m: of the pair from the origin along each axis, at most */
    double gap;    /* m: the features start so far apart; 0: as it falls */
    double flat;   /* how much of the triangle's or the edges' angle is left; 0: all */
    double turn;   /* of all corners about each axis through the cube's middle, at most */
};

static const struct pairs_sort PAIRS_SORTS[] = {
    {"as the bench has them", 0.01, 0.002, 0.002, 1, 0, 0, 0},
    {"fast ones", 0.01, 0.02, 0.01, 1, 0, 0, 0},
    {"a large common velocity", 0.01, 0.002, 100, 1, 0, 0, 0},
    {"gaps of 1e-6 m", 0.01, 1e-6, 0.001, 1, 1e-6, 0, 0},
    {"gaps of 1e-6 m, a large common velocity, far away", 0.01, 2e-6, 1000, 1e6, 1e-6, 0, 0},
    {"gaps of two margins", 0.01, CONTACT_MARGIN, 1e-3, 1, 2 * CONTACT_MARGIN, 0, 0},
    {"far away", 0.01, 0.002, 0.002, 1e6, 0, 0, 0},
    {"nearly parallel edges, needles", 0.01, 0.002, 0.002, 1, 0, 1e-7, 0},
    {"nearly parallel edges and needles at 1e-6 m", 0.01, 2e-6, 0.002, 1, 1e-6, 1e-9, 0},
    {"turned together at 1e-6 m", 0.01, 1e-6, 1e-3, 1, 1e-6, 0, 0.5},
    {"turned together at two margins, far away", 0.01, CONTACT_MARGIN, 1, 1e3, 2 * CONTACT_MARGIN,
     0, 0.1},
};
enum { PAIRS_SORTS_N = sizeof PAIRS_SORTS / sizeof *PAIRS_SORTS };

static inline void pairs_vector(double reach, phys_vec *x)
{
    *x = (phys_vec){uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach), 0};
}

/* Draws corners, which lie together: the first feature's begin, then the second's. */
static inline void pairs_corners(enum contact_pair pair, const struct pairs_sort *sort,
                                 phys_vec x[4])
{
    for (int k = 0; k < 4; k++)
        pairs_vector(0.5 * sort->size, x + k);
    if (sort->flat > 0 && pair == CONTACT_VT)
        x[3] = x[1] + uniform(0, 2) * (x[2] - x[1]) + sort->flat * x[3];
    if (sort->flat > 0 && pair == CONTACT_EE)
        x[3] = x[2] + uniform(-2, 2) * (x[1] - x[0]) + sort->flat * x[3];
}

/* Adds the way of a corner that turns about an axis through the cube's middle. */
static inline void pairs_turn(const phys_vec *axis, const phys_vec *x, phys_vec *way)
{
    const phys_vec a = *axis, b = *x;
    *way += (phys_vec){a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0], 0};
}

static inline void pairs_draw(enum contact_pair pair, const struct pairs_sort *sort, phys_vec x[4],
                              phys_vec y[4])
{
    struct contact_nearest nearest;
    phys_vec common, offset, way, axis = {0};
    pairs_corners(pair, sort, x);
    contact_nearest_of(pair, x, &nearest);
    for (int k = 0; k < (pair == CONTACT_VT ? 1 : 2) && sort->gap > 0; k++)
        x[k] -= (nearest.gap - sort->gap) * nearest.normal;
    pairs_vector(sort->common, &common);
    pairs_vector(sort->offset, &offset);
    if (sort->turn > 0)
        pairs_vector(sort->turn, &axis);
    for (int k = 0; k < 4; k++) {
        pairs_vector(sort->way, &way);
        pairs_turn(&axis, x + k, &way);
        x[k] += offset;
        y[k] = x[k] + common + way;
    }
}

static const enum contact_pair KINDS[2] = {CONTACT_VT, CONTACT_EE};
static const double THICKNESS = 0.001; /* m */

/* Where corners end that go so much of their way, but for those that are held. */
static inline void pairs_end(const phys_vec x[4], const phys_vec y[4], unsigned held,
                             const double t[4], phys_vec end[4])
{
    for (int k = 0; k < 4; k++)
        end[k] = held >> k & 1 ? y[k] : x[k] + t[k] * (y[k] - x[k]);
}

/* How many pairs of a kind: quick, DUITE_LONG=1 for the full number, or that of make check. */
static inline int pairs_count(void)
{
    const char *is_long = getenv("DUITE_LONG"), *is_quick = getenv("DUITE_QUICK");
    if (is_long && !strcmp(is_long, "1"))
        return 1000000;
    return is_quick && !strcmp(is_quick, "1") ? 1000 : 10000;
}

/* As ck_assert, which writes to a file each time. */
#define PAIRS_CHECK(what)                                                                          \
    do {                                                                                           \
        if (!(what))                                                                               \
            ck_abort_msg("%s", #what);                                                             \
    } while (0)

#endif
