/* Pairs are sorted once; filled in that order, every node's neighbours come out ascending. */
#include "cloth/mesh/detail/graph.h"

#include "cloth/base/memory.h"
#include "cloth/mesh/detail/sort.h"

#include <stdbool.h>
#include <stdlib.h>

/* The pairs with the smaller node first, without those of a node with itself. Returns how many. */
static size_t turn(uint32_t *to, size_t n, const uint32_t *pair)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        uint32_t a = pair[2 * i], b = pair[2 * i + 1];
        if (a == b)
            continue;
        to[2 * kept] = a < b ? a : b;
        to[2 * kept + 1] = a < b ? b : a;
        kept++;
    }
    return kept;
}

/* Keeps the first of equal pairs in the order. Returns how many are left. */
static size_t unique(uint32_t *order, size_t n, const uint32_t *pair)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        const uint32_t *here = pair + 2 * (size_t)order[i];
        const uint32_t *last = kept ? pair + 2 * (size_t)order[kept - 1] : NULL;
        if (!last || here[0] != last[0] || here[1] != last[1])
            order[kept++] = order[i];
    }
    return kept;
}

static int fill(struct mesh_graph *graph, size_t n, const uint32_t *order, const uint32_t *pair,
                struct cloth_error *error)
{
    graph->start = cloth_alloc((size_t)graph->n_nodes + 1, sizeof *graph->start, error);
    graph->neighbour = cloth_alloc(2 * n, sizeof *graph->neighbour, error);
    size_t *next = cloth_alloc((size_t)graph->n_nodes + 1, sizeof *next, error);
    if (!graph->start || !graph->neighbour || !next) {
        free(next);
        return CLOTH_E_MEMORY;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < 2; k++)
            graph->start[pair[2 * (size_t)order[i] + k] + 1]++;
    for (size_t v = 0; v < graph->n_nodes; v++)
        next[v + 1] = graph->start[v + 1] += graph->start[v];
    for (size_t i = 0; i < n; i++) {
        const uint32_t *ends = pair + 2 * (size_t)order[i];
        graph->neighbour[next[ends[0]]++] = ends[1];
        graph->neighbour[next[ends[1]]++] = ends[0];
    }
    free(next);
    return CLOTH_OK;
}

int mesh_graph_build(struct mesh_graph *graph, uint32_t n_nodes, size_t n_pairs,
                     const uint32_t *pair, struct cloth_error *error)
{
    *graph = (struct mesh_graph){.n_nodes = n_nodes};
    if (n_pairs > UINT32_MAX)
        return cloth_fail(error, CLOTH_E_INPUT, "%zu pairs of vertices are too many; at most %u",
                          n_pairs, UINT32_MAX);
    int code = CLOTH_E_MEMORY;
    uint32_t *turned = cloth_alloc(n_pairs, 2 * sizeof *turned, error);
    uint32_t *order = cloth_alloc(n_pairs, sizeof *order, error);
    if (turned && order) {
        size_t n = turn(turned, n_pairs, pair);
        code = mesh_sort_pairs(order, n, turned, n_nodes, error);
        if (!code)
            code = fill(graph, unique(order, n, turned), order, turned, error);
    }
    free(turned);
    free(order);
    if (code)
        mesh_graph_free(graph);
    return code;
}

void mesh_graph_free(struct mesh_graph *graph)
{
    free(graph->start);
    free(graph->neighbour);
    *graph = (struct mesh_graph){0};
}
