#ifndef CLOTH_VERIFY_VERIFY_H
#define CLOTH_VERIFY_VERIFY_H

#include "cloth/base/error.h"
#include "cloth/base/memory.h"
#include "cloth/contact/shape.h"

#include <stdbool.h>
#include <stdint.h>

/* Exact tests for intersections of surfaces. They share no code with contact: a second opinion
 * on states and frames. Local functions. */

/* Triangles in space. Triangles that share a corner have its number. */
struct verify_soup {
    uint32_t n_points, n_triangles;
    uint32_t n_first; /* pairs are sought among the first, and between the first and the others */
    const double (*x)[3];        /* n_points, m */
    const uint32_t (*corner)[3]; /* n_triangles */
    const uint32_t *joined;      /* n_points: points sewn to each other have the same number;
                                  * triangles with two such corners are no pair; NULL: no point is
                                  * sewn */
};

/* Two triangles that intersect, the lower number first. */
struct verify_pair {
    uint32_t triangle[2];
};

/* True if two triangles have a common point: an edge of one meets the other, boundary included.
 * This holds in one plane and without area, too. A shared corner and the edges that begin there
 * do not count: only the opposite edges do. Triangles that share an edge do not intersect.
 * Coordinates as of verify_orient. */
bool verify_meet(const double (*x)[3], const uint32_t a[3], const uint32_t b[3]);

/* Appends all pairs that meet to a list of struct verify_pair, sorted. Coordinates below
 * VERIFY_LEAST count as 0. Errors: CLOTH_E_RUN for one above VERIFY_MOST or no number,
 * CLOTH_E_MEMORY. Time: n log n, and a step for each pair of boxes that meet, or overlap along
 * two axes and are near along the third. */
int verify_pairs(const struct verify_soup *soup, struct cloth_list *pairs,
                 struct cloth_error *error);

/* Appends the numbers (uint32_t, ascending) of the first triangles with a point deeper than
 * `depth` (m, > 0) in a convex shape, any but a body. Triangles between `depth` and twice
 * `depth` may or may not be found. Errors: CLOTH_E_MEMORY. */
int verify_enter(const struct verify_soup *soup, const struct contact_shape *shape,
                 const struct contact_pose *pose, double depth, struct cloth_list *triangles,
                 struct cloth_error *error);

/* True if a point is inside a closed surface, made of the soup's triangles from `first` to
 * before `end`. On the surface: either. Coordinates as of verify_orient. */
bool verify_inside(const struct verify_soup *soup, uint32_t first, uint32_t end,
                   const double at[3]);

#endif
