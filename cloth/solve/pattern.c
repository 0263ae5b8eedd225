/* The order of least degree is found once a run, by elimination on bits; it never depends on
 * numbers of the matrix. */
#include "cloth/base/memory.h"
#include "cloth/base/order.h"
#include "cloth/solve/coarse.h"

#include <stdlib.h>

/* The graph left by elimination, as bits: row b of `words` words has the neighbours that b still
 * has. */
struct graph {
    uint32_t n, words;
    uint64_t *bits;
    uint32_t *degree; /* UINT32_MAX: eliminated */
};

static uint64_t *row_of(const struct graph *graph, uint32_t b)
{
    return graph->bits + (size_t)b * graph->words;
}

static uint32_t count_bits(const struct graph *graph, uint32_t b)
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < graph->words; w++)
        count += (uint32_t)__builtin_popcountll(row_of(graph, b)[w]);
    return count;
}

static bool solve_pattern_meets(const struct graph *graph, uint32_t a, uint32_t b)
{
    return row_of(graph, a)[b / 64] >> b % 64 & 1;
}

static void forget(struct graph *graph, uint32_t a, uint32_t b)
{
    row_of(graph, a)[b / 64] &= ~(UINT64_C(1) << b % 64);
}

/* The first block of least degree. */
static uint32_t solve_pattern_least(const struct graph *graph)
{
    uint32_t best = 0;
    for (uint32_t b = 1; b < graph->n; b++)
        if (graph->degree[b] < graph->degree[best])
            best = b;
    return best;
}

/* Joins all that meet b to each other. */
static void eliminate(struct graph *graph, uint32_t b)
{
    for (uint32_t a = 0; a < graph->n; a++) {
        if (!solve_pattern_meets(graph, b, a))
            continue;
        for (uint32_t w = 0; w < graph->words; w++)
            row_of(graph, a)[w] |= row_of(graph, b)[w];
        forget(graph, a, a);
        forget(graph, a, b);
        graph->degree[a] = count_bits(graph, a);
    }
    graph->degree[b] = UINT32_MAX;
}

/* Fills block, place and first; the rows of bits keep the neighbours of each block when it went. */
static void order(struct graph *graph, struct solve_pattern *pattern)
{
    pattern->first[0] = 0;
    for (uint32_t k = 0; k < graph->n; k++) {
        const uint32_t b = solve_pattern_least(graph);
        pattern->block[k] = b;
        pattern->place[b] = k;
        pattern->first[k + 1] = pattern->first[k] + graph->degree[b];
        eliminate(graph, b);
    }
}

static void list(const struct graph *graph, struct solve_pattern *pattern)
{
    for (uint32_t k = 0; k < graph->n; k++) {
        uint32_t *row = pattern->row + pattern->first[k], n = 0;
        for (uint32_t a = 0; a < graph->n; a++)
            if (solve_pattern_meets(graph, pattern->block[k], a))
                row[n++] = pattern->place[a];
        qsort(row, n, sizeof *row, cloth_compare_items_u32);
    }
}

int solve_pattern_make(struct solve_pattern *pattern, uint32_t n, const uint32_t *first,
                       const uint32_t *neighbour, struct cloth_error *error)
{
    struct graph graph = {.n = n, .words = n / 64 + 1};
    *pattern = (struct solve_pattern){.n = n};
    graph.bits = cloth_alloc((size_t)n * graph.words, sizeof *graph.bits, error);
    graph.degree = cloth_alloc(n, sizeof *graph.degree, error);
    pattern->block = cloth_alloc(n, sizeof *pattern->block, error);
    pattern->place = cloth_alloc(n, sizeof *pattern->place, error);
    pattern->first = cloth_alloc((size_t)n + 1, sizeof *pattern->first, error);
    if (!graph.bits || !graph.degree || !pattern->block || !pattern->place || !pattern->first)
        goto done;
    for (uint32_t b = 0; b < n; b++) {
        for (uint32_t i = first[b]; i < first[b + 1]; i++)
            if (neighbour[i] != SOLVE_LEFT_OUT)
                row_of(&graph, b)[neighbour[i] / 64] |= UINT64_C(1) << neighbour[i] % 64;
        graph.degree[b] = count_bits(&graph, b);
    }
    order(&graph, pattern);
    pattern->row = cloth_alloc(pattern->first[n], sizeof *pattern->row, error);
    if (pattern->row)
        list(&graph, pattern);
done:
    free(graph.bits);
    free(graph.degree);
    if (pattern->row)
        return CLOTH_OK;
    solve_pattern_free(pattern);
    return CLOTH_E_MEMORY;
}

void solve_pattern_free(struct solve_pattern *pattern)
{
    free(pattern->block);
    free(pattern->place);
    free(pattern->first);
    free(pattern->row);
    *pattern = (struct solve_pattern){0};
}
