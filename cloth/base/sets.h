#ifndef CLOTH_BASE_SETS_H
#define CLOTH_BASE_SETS_H

#include <stdint.h>

/* Disjoint sets of the numbers 0 to n - 1 (union-find, with path halving). parent is the caller's
 * array of n numbers. No number is below its parent, so that the root of a set is its lowest
 * number, in whatever order the sets were joined. */

static inline void cloth_sets_start(uint32_t *parent, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        parent[i] = i;
}

/* The lowest number of the set that i is in. */
static inline uint32_t cloth_sets_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/* Makes one set of the two that a and b are in. */
static inline void cloth_sets_join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = cloth_sets_root(parent, a);
    b = cloth_sets_root(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

#endif
