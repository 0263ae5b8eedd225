/* Every choice that METIS could make is set here, so that a graph has one cut only. */
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/graph.h"

#include <metis.h>
#include <stdlib.h>

#define UNEVEN 1 /* a bisection may miss equal numbers by a thousandth */

static const char *metis_text(int code)
{
    switch (code) {
    case METIS_ERROR_INPUT:
        return "wrong input";
    case METIS_ERROR_MEMORY:
        return "out of memory";
    default:
        return "unknown error";
    }
}

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
                      metis_text(code));
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
