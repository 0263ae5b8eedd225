#ifndef CLOTH_VERIFY_VERIFY_H
#define CLOTH_VERIFY_VERIFY_H

#include "cloth/base/error.h"
#include "cloth/base/memory.h"
#include "cloth/contact/shape.h"

#include <stdbool.h>
#include <stdint.h>

/* Whether surfaces go through each other, said exactly and by no code that contact has: a second
 * opinion on states and frames. Local functions. */

/* Triangles in space. Those that share a corner have its number. */
struct verify_soup {
    uint32_t n_points, n_triangles;
    uint32_t n_first;     /* pairs are sought among the first ones, and of these with the others */
    const double (*x)[3]; /* n_points, m */
    const uint32_t (*corner)[3]; /* n_triangles */
    const uint32_t *joined;      /* n_points: a number that points have in common which are sewn to
                                  * each other: triangles with two such corners are no pair; NULL:
                                  * none are */
};

/* Two triangles that intersect, the lower number first. */
struct verify_pair {
    uint32_t triangle[2];
};

/* Whether two triangles have a point in common: an edge of one meets the other, which has its
 * boundary; triangles in one plane, and those without area, are no exception. Of two that share one
 * corner this does not count, nor edges that begin there: the opposite edges tell whether they meet
 * elsewhere. Two that share an edge do not intersect. Coordinates as of verify_orient. */
bool verify_meet(const double (*x)[3], const uint32_t a[3], const uint32_t b[3]);

/* Appends all pairs that meet to a list of struct verify_pair, sorted. Of coordinates smaller than
 * VERIFY_LEAST 0 is taken. Errors: CLOTH_E_RUN for one that is larger than VERIFY_MOST or no
 * number, CLOTH_E_MEMORY. Takes n log n and a step for each pair of boxes that meet, or overlap
 * along two axes and are near each other along a third. */
int verify_pairs(const struct verify_soup *soup, struct cloth_list *pairs,
                 struct cloth_error *error);

/* Appends the numbers (uint32_t, ascending) of those of the first triangles that have a point
 * deeper in a convex shape, any but a body, than `depth` (m, > 0); which of those are found that
 * are deeper than `depth` and not than twice that is open. Errors: CLOTH_E_MEMORY. */
int verify_enter(const struct verify_soup *soup, const struct contact_shape *shape,
                 const struct contact_pose *pose, double depth, struct cloth_list *triangles,
                 struct cloth_error *error);

/* Whether a point is inside a closed surface: those triangles of the soup from the first to the
 * one before the end. On it: either. Coordinates as of verify_orient. */
bool verify_inside(const struct verify_soup *soup, uint32_t first, uint32_t end,
                   const double at[3]);

#endif
