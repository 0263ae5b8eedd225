/* cyclic: object after object to rank after rank. Balances numbers but separates all neighbours:
 * the worst sensible case. */
#include "runtime/map/map.h"

static int cyclic_map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = (int)((graph->before + i) % (uint64_t)n_ranks);
    return 0;
}

const duite_mapping map_cyclic = {
    .name = "cyclic",
    .summary = "object after object to rank after rank",
    .map = cyclic_map,
};
