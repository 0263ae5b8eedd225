#ifndef CLOTH_PHYSICS_DETAIL_LANES_H
#define CLOTH_PHYSICS_DETAIL_LANES_H

#include "cloth/physics/element.h"

#include <math.h>

/* Elements are worked on four at a time: lane i of every vector belongs to element i of the four.
 * Lanes never meet, so an element's numbers do not depend on which others it stands with. Where
 * fewer than four are left, the last one fills the other lanes and is written once. */

enum { PHYS_WIDE = 4 };

/* Three components of four vectors. */
struct phys_wide {
    phys_vec c[3];
};

typedef int64_t phys_mask __attribute__((vector_size(32)));

/* a where the mask is set, else b. */
PHYS_INLINE void phys_choose(const phys_mask *mask, const phys_vec *a, const phys_vec *b,
                             phys_vec *y)
{
    *y = (phys_vec)((*mask & (phys_mask)*a) | (~*mask & (phys_mask)*b));
}

PHYS_INLINE void phys_sqrt(const phys_vec *a, phys_vec *y)
{
    phys_vec root = *a;
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++)
        root[i] = sqrt(root[i]);
    *y = root;
}

/* 1 / a, 0 where a is not above 0. */
PHYS_INLINE void phys_inverse(const phys_vec *a, phys_vec *y)
{
    const phys_vec zero = {0}, one = {1, 1, 1, 1};
    const phys_mask some = *a > zero;
    phys_vec safe;
    phys_choose(&some, a, &one, &safe);
    safe = one / safe;
    phys_choose(&some, &safe, &zero, y);
}

/* max(a, 0). */
PHYS_INLINE void phys_positive(const phys_vec *a, phys_vec *y)
{
    const phys_vec zero = {0};
    const phys_mask some = *a > zero;
    phys_choose(&some, a, &zero, y);
}

PHYS_INLINE void phys_wide_dot(const struct phys_wide *a, const struct phys_wide *b, phys_vec *y)
{
    *y = (a->c[0] * b->c[0] + a->c[1] * b->c[1]) + a->c[2] * b->c[2];
}

PHYS_INLINE void phys_wide_cross(const struct phys_wide *a, const struct phys_wide *b,
                                 struct phys_wide *y)
{
    y->c[0] = a->c[1] * b->c[2] - a->c[2] * b->c[1];
    y->c[1] = a->c[2] * b->c[0] - a->c[0] * b->c[2];
    y->c[2] = a->c[0] * b->c[1] - a->c[1] * b->c[0];
}

/* y = a - b. */
PHYS_INLINE void phys_wide_from(const struct phys_wide *a, const struct phys_wide *b,
                                struct phys_wide *y)
{
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        y->c[i] = a->c[i] - b->c[i];
}

/* y = p a + q b. */
PHYS_INLINE void phys_wide_mix(const phys_vec *p, const struct phys_wide *a, const phys_vec *q,
                               const struct phys_wide *b, struct phys_wide *y)
{
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        y->c[i] = *p * a->c[i] + *q * b->c[i];
}

PHYS_INLINE void phys_wide_scale(const phys_vec *p, const struct phys_wide *a, struct phys_wide *y)
{
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        y->c[i] = *p * a->c[i];
}

/* Four rows with their lanes turned into columns, and back. */
PHYS_INLINE void phys_turn(const phys_vec row[PHYS_WIDE], phys_vec column[PHYS_WIDE])
{
    const phys_vec a = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
    const phys_vec b = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
    const phys_vec c = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
    const phys_vec d = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    column[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    column[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    column[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    column[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/* The row that a corner means. */
PHYS_INLINE const phys_vec *phys_at(uint32_t n, const phys_vec *own, const phys_vec *ghost,
                                    uint32_t corner)
{
    return corner < n ? own + corner : ghost + (corner - n);
}

/* Which four elements are worked on: `valid` of them, the first is `first`. */
struct phys_four {
    size_t at[PHYS_WIDE];
    size_t valid;
};

PHYS_INLINE void phys_four_from(size_t first, size_t end, struct phys_four *four)
{
    four->valid = end - first < PHYS_WIDE ? end - first : PHYS_WIDE;
    PHYS_UNROLL
    for (size_t i = 0; i < PHYS_WIDE; i++)
        four->at[i] = first + (i < four->valid ? i : four->valid - 1);
}

/* Corner k of the four elements. */
PHYS_INLINE void phys_gather(const struct phys_four *four, uint32_t (*corner)[4], int k, uint32_t n,
                             const phys_vec *own, const phys_vec *ghost, struct phys_wide *y)
{
    phys_vec row[PHYS_WIDE], column[PHYS_WIDE];
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++)
        row[i] = *phys_at(n, own, ghost, corner[four->at[i]][k]);
    phys_turn(row, column);
    PHYS_UNROLL
    for (int i = 0; i < 3; i++)
        y->c[i] = column[i];
}

/* The rows of a list that are the four elements' own. */
PHYS_INLINE void phys_gather_rows(const struct phys_four *four, const phys_vec *list,
                                  phys_vec column[PHYS_WIDE])
{
    phys_vec row[PHYS_WIDE];
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++)
        row[i] = list[four->at[i]];
    phys_turn(row, column);
}

PHYS_INLINE void phys_gather_numbers(const struct phys_four *four, const double *list, phys_vec *y)
{
    phys_vec number = {0};
    PHYS_UNROLL
    for (int i = 0; i < PHYS_WIDE; i++)
        number[i] = list[four->at[i]];
    *y = number;
}

/* The same of consecutive elements: one load where all four are there. */
PHYS_INLINE void phys_take_numbers(const struct phys_four *four, const double *list, phys_vec *y)
{
    if (four->valid == PHYS_WIDE)
        __builtin_memcpy(y, list + four->at[0], sizeof *y);
    else
        phys_gather_numbers(four, list, y);
}

/* Adds to corner k of the four elements, where it is one of the n rows. */
PHYS_INLINE void phys_scatter(const struct phys_four *four, uint32_t (*corner)[4], int k,
                              uint32_t n, const struct phys_wide *add, phys_vec *y)
{
    const phys_vec column[PHYS_WIDE] = {add->c[0], add->c[1], add->c[2], {0}};
    phys_vec row[PHYS_WIDE];
    phys_turn(column, row);
    PHYS_UNROLL
    for (size_t i = 0; i < four->valid; i++)
        if (corner[four->at[i]][k] < n)
            y[corner[four->at[i]][k]] += row[i];
}

/* Which pairs are wanted transposed: bit 0 of at[stride * i]. at NULL: none. */
PHYS_INLINE void phys_transposed(const struct phys_four *four, const uint32_t *at, size_t stride,
                                 phys_mask *transposed)
{
    uint32_t bit[PHYS_WIDE] = {0};
    PHYS_UNROLL
    for (size_t i = 0; at && i < PHYS_WIDE; i++)
        bit[i] = at[stride * (four->at[i] - four->at[0])] & 1;
    *transposed = -(phys_mask){bit[0], bit[1], bit[2], bit[3]};
}

/* -a where the mask is set. */
PHYS_INLINE void phys_negate(const phys_mask *mask, phys_vec *a)
{
    const phys_vec minus = {-0.0, -0.0, -0.0, -0.0};
    *a = (phys_vec)((phys_mask)*a ^ (*mask & (phys_mask)minus));
}

/* Four pairs, each as its lanes have it, of elements that have `stride` pairs. */
PHYS_INLINE void phys_write_pairs(const struct phys_four *four, phys_vec cyclic[3][3],
                                  size_t stride, struct phys_pair *pair)
{
    PHYS_UNROLL
    for (int k = 0; k < 3; k++) {
        const phys_vec column[PHYS_WIDE] = {cyclic[k][0], cyclic[k][1], cyclic[k][2], {0}};
        phys_vec row[PHYS_WIDE];
        phys_turn(column, row);
        PHYS_UNROLL
        for (size_t i = 0; i < four->valid; i++)
            pair[stride * i].cyclic[k] = row[i];
    }
}

/* The sum of one number an element, in order, of those that the block counts: whose first corner is
 * one of its rows. */
PHYS_INLINE double phys_sum_own(const struct phys_four *four, uint32_t (*corner)[4], uint32_t n,
                                const phys_vec *number, double sum)
{
    PHYS_UNROLL
    for (size_t i = 0; i < four->valid; i++)
        if (corner[four->at[i]][0] < n)
            sum += (*number)[i];
    return sum;
}

#endif
