#ifndef CLOTH_MESH_DETAIL_SORT_H
#define CLOTH_MESH_DETAIL_SORT_H

#include "cloth/base/error.h"

#include <stddef.h>
#include <stdint.h>

/* order[0 .. n-1] becomes the permutation that sorts the n pairs by (first, second); equal pairs
 * keep their order. pair: n x 2, each number below n_keys; n <= UINT32_MAX. Time and memory linear
 * in n + n_keys. Errors: CLOTH_E_MEMORY. Local. */
int mesh_sort_pairs(uint32_t *order, size_t n, const uint32_t *pair, uint32_t n_keys,
                    struct cloth_error *error);

#endif
