/* Two stable counting passes, the second number first: the result is one and the same on every
 * machine. */
#include "cloth/mesh/detail/sort.h"

#include "cloth/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* from: the order before, NULL for 0 .. n-1; which: the number of the pair to sort by. */
static void pass(uint32_t *to, const uint32_t *from, size_t n, const uint32_t *pair, size_t which,
                 uint32_t *start, uint32_t n_keys)
{
    memset(start, 0, ((size_t)n_keys + 1) * sizeof *start);
    for (size_t i = 0; i < n; i++)
        start[pair[2 * i + which] + 1]++;
    for (uint32_t k = 0; k < n_keys; k++)
        start[k + 1] += start[k];
    for (size_t i = 0; i < n; i++) {
        uint32_t item = from ? from[i] : (uint32_t)i;
        to[start[pair[2 * (size_t)item + which]]++] = item;
    }
}

int mesh_sort_pairs(uint32_t *order, size_t n, const uint32_t *pair, uint32_t n_keys,
                    struct cloth_error *error)
{
    int code = CLOTH_E_MEMORY;
    uint32_t *start = cloth_alloc((size_t)n_keys + 1, sizeof *start, error);
    uint32_t *by_second = cloth_alloc(n, sizeof *by_second, error);
    if (start && by_second) {
        pass(by_second, NULL, n, pair, 1, start, n_keys);
        pass(order, by_second, n, pair, 0, start, n_keys);
        code = CLOTH_OK;
    }
    free(start);
    free(by_second);
    return code;
}
