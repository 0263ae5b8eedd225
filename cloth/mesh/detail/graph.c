/* Pairs are visited twice: counted, then put behind their nodes. Springs come in order, so most
 * rows are ascending as they are; the others are sorted. */
#include "cloth/mesh/detail/graph.h"

#include "cloth/base/memory.h"
#include "cloth/base/order.h"

#include <metis.h>
#include <stdbool.h>
#include <stdlib.h>

struct builder {
    struct mesh_graph *graph;
    uint32_t n_vertices;
    const uint32_t *node;
    uint64_t n, ends; /* pairs so far; ends that count */
    bool failed;      /* the next pair has a vertex without a node, */
    uint32_t vertex;  /* this one */
};

static uint32_t graph_node_of(const struct builder *builder, uint32_t vertex)
{
    return vertex < builder->n_vertices ? builder->node[vertex] : MESH_NO_PLACE;
}

static void graph_count(void *to, uint32_t a, uint32_t b)
{
    struct builder *builder = to;
    const uint32_t p = graph_node_of(builder, a), q = graph_node_of(builder, b);
    if (builder->failed)
        return;
    builder->failed = p == MESH_NO_PLACE || q == MESH_NO_PLACE;
    builder->vertex = p == MESH_NO_PLACE ? a : b;
    if (builder->failed)
        return;
    builder->n++;
    if (p == q)
        return;
    builder->graph->start[p + 2]++;
    builder->graph->start[q + 2]++;
    builder->ends += 2;
}

/* While rows are filled, start[i + 1] is where the next neighbour of node i goes. */
static void graph_put(void *to, uint32_t a, uint32_t b)
{
    const struct builder *builder = to;
    const struct mesh_graph *graph = builder->graph;
    const uint32_t p = builder->node[a], q = builder->node[b];
    if (p == q)
        return;
    graph->neighbour[graph->start[p + 1]++] = q;
    graph->neighbour[graph->start[q + 1]++] = p;
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
            qsort(neighbour + from, to - from, sizeof *neighbour, cloth_compare_items_u32);
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
        graph->start[v + 2] += graph->start[v + 1];
    pairs->each(pairs->context, graph_put, builder);
    tidy(graph);
    return CLOTH_OK;
}

int mesh_graph_build(struct mesh_graph *graph, uint32_t n_nodes, uint32_t n_vertices,
                     const uint32_t *node, const struct mesh_pairs *pairs,
                     struct cloth_error *error)
{
    struct builder builder = {.graph = graph, .n_vertices = n_vertices, .node = node};
    *graph = (struct mesh_graph){.n_nodes = n_nodes};
    graph->start = cloth_alloc((size_t)n_nodes + 2, sizeof *graph->start, error);
    if (!graph->start)
        return CLOTH_E_MEMORY;
    pairs->each(pairs->context, graph_count, &builder);
    int code = CLOTH_OK;
    if (builder.failed)
        code = cloth_fail(error, CLOTH_E_INPUT,
                          "pair %llu joins vertex %u, which is not one of the used vertices",
                          (unsigned long long)builder.n, builder.vertex);
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

/* ---- Its cut: every choice that METIS could make is set here, so that a graph has one ---- */

#define UNEVEN 1 /* a bisection may miss equal numbers by a thousandth */

static int fits(const struct mesh_graph *graph, struct cloth_error *error)
{
    const uint64_t max = IDX_MAX;
    if (graph->n_nodes < max && graph->start[graph->n_nodes] <= max)
        return CLOTH_OK;
    return cloth_fail(error, CLOTH_E_LIBRARY,
                      "a graph of %u vertices and %u neighbours is too large for METIS with "
                      "%d-bit numbers; one with 64 bits is needed",
                      graph->n_nodes, graph->start[graph->n_nodes], IDXTYPEWIDTH);
}

/* The numbers as METIS takes them: where it lies the same, the array itself; else a copy, or NULL
 * without memory. */
static idx_t *numbers_of(uint32_t *number, size_t n, struct cloth_error *error)
{
    if (sizeof(idx_t) == sizeof *number)
        return (void *)number;
    idx_t *copy = cloth_alloc(n, sizeof *copy, error);
    for (size_t i = 0; copy && i < n; i++)
        copy[i] = (idx_t)number[i];
    return copy;
}

static void free_numbers(idx_t *copy, const uint32_t *number)
{
    if ((const void *)copy != number)
        free(copy);
}

static int call_metis(const struct mesh_graph *graph, uint32_t n_parts, idx_t *start,
                      idx_t *neighbour, idx_t *part, struct cloth_error *error)
{
    idx_t n = (idx_t)graph->n_nodes, constraints = 1, parts = (idx_t)n_parts, cut;
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_NUMBERING] = 0;
    options[METIS_OPTION_UFACTOR] = UNEVEN;
    options[METIS_OPTION_DBGLVL] = 0;
    int code = METIS_PartGraphRecursive(&n, &constraints, start, neighbour, NULL, NULL, NULL,
                                        &parts, NULL, NULL, options, &cut, part);
    if (code == METIS_OK)
        return CLOTH_OK;
    return cloth_fail(error, code == METIS_ERROR_MEMORY ? CLOTH_E_MEMORY : CLOTH_E_LIBRARY,
                      "METIS could not cut %u vertices into %u blocks: %s", graph->n_nodes, n_parts,
                      code == METIS_ERROR_INPUT    ? "wrong input"
                      : code == METIS_ERROR_MEMORY ? "out of memory"
                                                   : "unknown error");
}

int mesh_partition(uint32_t *part, const struct mesh_graph *graph, uint32_t n_parts,
                   struct cloth_error *error)
{
    const size_t n = graph->n_nodes, n_neighbours = graph->start[n];
    if (n_parts < 2 || n_neighbours == 0) {
        for (size_t v = 0; v < n; v++)
            part[v] = (uint32_t)(v * n_parts / n);
        return CLOTH_OK;
    }
    int code = fits(graph, error);
    if (code)
        return code;
    idx_t *start = numbers_of(graph->start, n + 1, error);
    idx_t *neighbour = numbers_of(graph->neighbour, n_neighbours, error);
    idx_t *answer = numbers_of(part, n, error);
    code = CLOTH_E_MEMORY;
    if (start && neighbour && answer)
        code = call_metis(graph, n_parts, start, neighbour, answer, error);
    for (size_t v = 0; v < n && !code; v++)
        part[v] = (uint32_t)answer[v];
    free_numbers(start, graph->start);
    free_numbers(neighbour, graph->neighbour);
    free_numbers(answer, part);
    return code;
}

/* ---- Empty parts ---- */

static uint32_t pieces_needed(uint32_t size, uint32_t largest)
{
    return size / largest + (size % largest ? 1 : 0);
}

static uint64_t pieces_needed_in_all(uint32_t n_parts, const uint32_t *size, uint32_t largest)
{
    uint64_t sum = 0;
    for (uint32_t p = 0; p < n_parts; p++)
        sum += pieces_needed(size[p], largest);
    return sum;
}

void mesh_pieces(uint32_t n_parts, const uint32_t *size, uint32_t *pieces)
{
    uint32_t low = 1, high = 1; /* the largest piece is in low .. high */
    for (uint32_t p = 0; p < n_parts; p++)
        high = size[p] > high ? size[p] : high;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (pieces_needed_in_all(n_parts, size, middle) <= n_parts)
            high = middle;
        else
            low = middle + 1;
    }
    uint64_t spare = n_parts - pieces_needed_in_all(n_parts, size, low);
    for (uint32_t p = 0; p < n_parts; p++) {
        pieces[p] = pieces_needed(size[p], low);
        uint32_t more = low > 1 ? pieces_needed(size[p], low - 1) - pieces[p] : 0;
        more = more < spare ? more : (uint32_t)spare;
        pieces[p] += more;
        spare -= more;
    }
}
