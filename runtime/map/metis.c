/* metis: equal weights, few bytes between ranks: METIS' recursive bisection of the hinted graph
 * (Karypis & Kumar, SIAM J. Sci. Comput. 20(1), 1998), with the seed of the run. A graph without
 * edges, or with no more objects than ranks, goes to `block`; but without any hint to `cyclic`.
 * Then it is unknown which objects the program's loops use together, and work that moves on over
 * the objects, as in a factorisation, keeps all ranks busy. */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <metis.h>
#include <stdbool.h>
#include <string.h>

/* METIS counts in integers: weights are scaled so that their sum stays far below its range. */
static void metis_scale(size_t n, const double *from, idx_t *to)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += from[i];
    double factor = sum > 0 ? 1e8 / sum : 0;
    for (size_t i = 0; i < n; i++)
        to[i] = 1 + (idx_t)(from[i] * factor);
}

static int metis_partition(const duite_object_graph *graph, int n_ranks, uint64_t seed, idx_t *work,
                           int *home)
{
    size_t n = graph->n, edges = graph->start[n];
    idx_t *start = work, *neighbour = start + n + 1, *weight = neighbour + edges,
          *edge_weight = weight + n, *part = edge_weight + edges;
    for (size_t i = 0; i <= n; i++)
        start[i] = (idx_t)graph->start[i];
    for (size_t i = 0; i < edges; i++)
        neighbour[i] = (idx_t)graph->neighbour[i];
    metis_scale(n, graph->weight, weight);
    metis_scale(edges, graph->edge_weight, edge_weight);
    idx_t options[METIS_NOPTIONS], count = (idx_t)n, constraints = 1, parts = n_ranks, cut;
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = (idx_t)(seed & 0x7fffffff);
    int code = METIS_PartGraphRecursive(&count, &constraints, start, neighbour, weight, NULL,
                                        edge_weight, &parts, NULL, NULL, options, &cut, part);
    if (code != METIS_OK)
        return base_error(DUITE_E_SYSTEM, "METIS failed with code %d on %zu objects and %d ranks",
                          code, n, n_ranks);
    for (size_t i = 0; i < n; i++)
        home[i] = (int)part[i];
    return DUITE_OK;
}

/* True if there are no edges and all weights are equal. */
static bool metis_knows_nothing(const duite_object_graph *graph)
{
    bool equal = !graph->start[graph->n];
    for (size_t i = 1; i < graph->n && equal; i++)
        equal = !(graph->weight[i] < graph->weight[0] || graph->weight[i] > graph->weight[0]);
    return equal;
}

int map_by_metis(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    size_t n = graph->n, edges = graph->start[n];
    if (metis_knows_nothing(graph))
        return map_cyclic.map(graph, n_ranks, seed, home);
    if (!edges || n <= (size_t)n_ranks)
        return map_block.map(graph, n_ranks, seed, home);
    if (edges > 0x3fffffff)
        return base_error(DUITE_E_ARGUMENT, "metis: %zu edges are too many", edges);
    idx_t *work = base_alloc((3 * n + 1 + 2 * edges) * sizeof *work);
    if (!work)
        return base_no_memory("the mapping");
    int code = metis_partition(graph, n_ranks, seed, work, home);
    base_free(work);
    return code;
}

const duite_mapping map_metis = {
    .size = sizeof(duite_mapping),
    .name = "metis",
    .summary = "METIS on the hinted objects: equal weights, few bytes between ranks",
    .map = map_by_metis,
};
