/* block: contiguous ranges of objects, in the order they were made, of equal weight. Ignores hints;
 * few messages if neighbours are made one after another. */
#include "runtime/map/map.h"

/* Object i goes to the rank where the middle of its weight falls; fewer objects than ranks go
 * round. */
static int block_map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    double sum = 0, before = 0;
    for (size_t i = 0; i < graph->n; i++)
        sum += graph->weight[i];
    for (size_t i = 0; i < graph->n; i++) {
        double middle = sum > 0 ? (before + 0.5 * graph->weight[i]) / sum : 0;
        int rank = (int)(middle * n_ranks);
        if (graph->n < (size_t)n_ranks)
            rank = (int)((graph->before + i) % (uint64_t)n_ranks);
        home[i] = rank < n_ranks ? rank : n_ranks - 1;
        before += graph->weight[i];
    }
    return 0;
}

const duite_mapping map_block = {
    .name = "block",
    .summary = "contiguous ranges of equal weight, in the order the objects were made",
    .map = block_map,
};
