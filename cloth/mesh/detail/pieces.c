/* The size of the largest piece decides everything else. */
#include "cloth/mesh/detail/pieces.h"

static uint32_t needed(uint32_t size, uint32_t largest)
{
    return size / largest + (size % largest ? 1 : 0);
}

static uint64_t needed_in_all(uint32_t n_parts, const uint32_t *size, uint32_t largest)
{
    uint64_t sum = 0;
    for (uint32_t p = 0; p < n_parts; p++)
        sum += needed(size[p], largest);
    return sum;
}

void mesh_pieces(uint32_t n_parts, const uint32_t *size, uint32_t *pieces)
{
    uint32_t low = 1, high = 1; /* the largest piece is in low .. high */
    for (uint32_t p = 0; p < n_parts; p++)
        high = size[p] > high ? size[p] : high;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (needed_in_all(n_parts, size, middle) <= n_parts)
            high = middle;
        else
            low = middle + 1;
    }
    uint64_t spare = n_parts - needed_in_all(n_parts, size, low);
    for (uint32_t p = 0; p < n_parts; p++) {
        pieces[p] = needed(size[p], low);
        uint32_t more = low > 1 ? needed(size[p], low - 1) - pieces[p] : 0;
        more = more < spare ? more : (uint32_t)spare;
        pieces[p] += more;
        spare -= more;
    }
}
