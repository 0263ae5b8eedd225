/* Pairs are visited twice: counted, then put behind their nodes. Springs come in order, so most
 * rows are ascending as they are; the others are sorted. */
#include "cloth/mesh/detail/graph.h"

#include "cloth/base/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct builder {
    struct mesh_graph *graph;
    uint32_t n_vertices;
    const uint32_t *node;
    uint64_t n, ends; /* pairs so far; ends that count */
    uint64_t bad;     /* the first pair with a vertex that has no node, */
    uint32_t vertex;  /* and that vertex */
    bool failed;
};

static uint32_t graph_node_of(const struct builder *builder, uint32_t vertex)
{
    return vertex < builder->n_vertices ? builder->node[vertex] : MESH_NO_PLACE;
}

static void graph_count(void *to, uint32_t a, uint32_t b)
{
    struct builder *builder = to;
    const uint32_t p = graph_node_of(builder, a), q = graph_node_of(builder, b);
    if ((p == MESH_NO_PLACE || q == MESH_NO_PLACE) && !builder->failed) {
        builder->failed = true;
        builder->bad = builder->n;
        builder->vertex = p == MESH_NO_PLACE ? a : b;
    }
    builder->n++;
    if (builder->failed || p == q)
        return;
    builder->graph->start[p + 1]++;
    builder->graph->start[q + 1]++;
    builder->ends += 2;
}

/* While rows are filled, start[i] is where the next neighbour of node i goes. */
static void graph_put(void *to, uint32_t a, uint32_t b)
{
    const struct builder *builder = to;
    const struct mesh_graph *graph = builder->graph;
    const uint32_t p = builder->node[a], q = builder->node[b];
    if (p == q)
        return;
    graph->neighbour[graph->start[p]++] = q;
    graph->neighbour[graph->start[q]++] = p;
}

static int graph_by_number(const void *left, const void *right)
{
    uint32_t a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    return (a > b) - (a < b);
}

/* Sorts each row, drops repeats and closes the gaps. */
static void tidy(struct mesh_graph *graph)
{
    uint32_t *neighbour = graph->neighbour, kept = 0, from = 0;
    for (uint32_t v = 0; v < graph->n_nodes; v++) {
        const uint32_t to = graph->start[v + 1], first = kept;
        bool ascending = true;
        for (uint32_t i = from + 1; i < to && ascending; i++)
            ascending = neighbour[i - 1] <= neighbour[i];
        if (!ascending)
            qsort(neighbour + from, to - from, sizeof *neighbour, graph_by_number);
        for (uint32_t i = from; i < to; i++)
            if (kept == first || neighbour[kept - 1] != neighbour[i])
                neighbour[kept++] = neighbour[i];
        graph->start[v] = first;
        from = to;
    }
    graph->start[graph->n_nodes] = kept;
}

static int graph_fill(struct builder *builder, const struct mesh_pairs *pairs,
                      struct cloth_error *error)
{
    struct mesh_graph *graph = builder->graph;
    graph->neighbour = cloth_alloc(builder->ends, sizeof *graph->neighbour, error);
    if (!graph->neighbour)
        return CLOTH_E_MEMORY;
    for (uint32_t v = 0; v < graph->n_nodes; v++)
        graph->start[v + 1] += graph->start[v];
    pairs->each(pairs->context, graph_put, builder);
    for (uint32_t v = graph->n_nodes; v > 0; v--) /* each was moved on to the next one's */
        graph->start[v] = graph->start[v - 1];
    graph->start[0] = 0;
    tidy(graph);
    return CLOTH_OK;
}

int mesh_graph_build(struct mesh_graph *graph, uint32_t n_nodes, uint32_t n_vertices,
                     const uint32_t *node, const struct mesh_pairs *pairs,
                     struct cloth_error *error)
{
    struct builder builder = {.graph = graph, .n_vertices = n_vertices, .node = node};
    *graph = (struct mesh_graph){.n_nodes = n_nodes};
    graph->start = cloth_alloc((size_t)n_nodes + 1, sizeof *graph->start, error);
    if (!graph->start)
        return CLOTH_E_MEMORY;
    pairs->each(pairs->context, graph_count, &builder);
    int code = CLOTH_OK;
    if (builder.failed)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "pair %llu joins vertex %u, which is not one of the used vertices",
                          (unsigned long long)builder.bad, builder.vertex);
    else if (builder.ends > UINT32_MAX)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "%llu pairs of vertices are too many; at most %u are possible",
                          (unsigned long long)builder.n, UINT32_MAX / 2);
    else
        code = graph_fill(&builder, pairs, error);
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
