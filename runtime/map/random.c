/* random: a random rank for each object, as by hashing. The least that a mapping with knowledge has
 * to beat. */
#include "runtime/map/map.h"

static int random_map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    for (size_t i = 0; i < graph->n; i++) {
        uint64_t state = (seed << 40) ^ (graph->before + i);
        home[i] = (int)(duite_random(&state) % (uint64_t)n_ranks);
    }
    return 0;
}

const duite_mapping map_random = {
    .name = "random",
    .summary = "each object to a random rank, from the seed",
    .map = random_map,
};
