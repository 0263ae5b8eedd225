/* Reverse Cuthill-McKee: every choice is by degree, then by number, so that there are no ties. */
#include "cloth/base/order.h"
#include "cloth/base/memory.h"
#include "cloth/mesh/detail/graph.h"

#include <stdlib.h>
#include <string.h>

#define DONE UINT32_MAX

int mesh_order_make(struct mesh_order *order, const struct mesh_graph *graph,
                    struct cloth_error *error)
{
    uint32_t widest = 0;
    for (size_t v = 0; v < graph->n_nodes; v++)
        if (graph->start[v + 1] - graph->start[v] > widest)
            widest = graph->start[v + 1] - graph->start[v];
    *order = (struct mesh_order){.graph = graph};
    order->degree = cloth_take(&order->memory, graph->n_nodes, sizeof *order->degree, error);
    order->seen = cloth_take(&order->memory, graph->n_nodes, sizeof *order->seen, error);
    order->queue = cloth_take(&order->memory, graph->n_nodes, sizeof *order->queue, error);
    order->placed = cloth_take(&order->memory, graph->n_nodes, sizeof *order->placed, error);
    order->sorted = cloth_take(&order->memory, widest, sizeof *order->sorted, error);
    return order->memory.lacks ? CLOTH_E_MEMORY : CLOTH_OK;
}

/* Appends the neighbours of a node that this walk has not met, in order of degree and number. */
static uint32_t order_visit(struct mesh_order *order, uint32_t node, uint32_t n)
{
    const struct mesh_graph *graph = order->graph;
    size_t fresh = 0;
    for (uint32_t i = graph->start[node]; i < graph->start[node + 1]; i++) {
        uint32_t other = graph->neighbour[i];
        if (order->part[other] != order->part[node] || order->seen[other] >= order->walk)
            continue;
        order->seen[other] = order->walk;
        order->sorted[fresh++] = (uint64_t)order->degree[other] << 32 | other;
    }
    qsort(order->sorted, fresh, sizeof *order->sorted, cloth_by_u64);
    for (size_t i = 0; i < fresh; i++)
        order->queue[n++] = (uint32_t)order->sorted[i];
    return n;
}

/* Walks a component breadth first from a node into queue[0 .. *n-1]. Returns the number of levels;
 * *last: where in the queue the last one starts. */
static uint32_t order_walk(struct mesh_order *order, uint32_t from, uint32_t *n, uint32_t *last)
{
    uint32_t levels = 0;
    order->walk++;
    order->seen[from] = order->walk;
    order->queue[0] = from;
    *n = 1;
    for (uint32_t i = 0, end = 1; i < end; end = *n, levels++) {
        *last = i;
        for (; i < end; i++)
            *n = order_visit(order, order->queue[i], *n);
    }
    return levels;
}

/* Leaves in the queue the walk of the component of `node` from one of its ends. */
static uint32_t walk_from_end(struct mesh_order *order, uint32_t node)
{
    uint32_t n, last, levels = order_walk(order, node, &n, &last), before = 0;
    for (int rounds = 0; levels > before && rounds < 8; rounds++) {
        uint32_t end = order->queue[last];
        for (uint32_t i = last + 1; i < n; i++) {
            uint32_t other = order->queue[i];
            if (order->degree[other] < order->degree[end] ||
                (order->degree[other] == order->degree[end] && other < end))
                end = other;
        }
        before = levels;
        levels = order_walk(order, end, &n, &last);
    }
    return n;
}

static void find_degrees(struct mesh_order *order, uint32_t n, const uint32_t *nodes)
{
    const struct mesh_graph *graph = order->graph;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t node = nodes[i], degree = 0;
        for (uint32_t k = graph->start[node]; k < graph->start[node + 1]; k++)
            degree += order->part[graph->neighbour[k]] == order->part[node];
        order->degree[node] = degree;
        order->seen[node] = 0;
    }
}

void mesh_order_part(struct mesh_order *order, const uint32_t *part, uint32_t n, uint32_t *nodes)
{
    uint32_t placed = 0;
    if (n == 0)
        return;
    order->part = part;
    order->walk = 0;
    qsort(nodes, n, sizeof *nodes, cloth_compare_items_u32);
    find_degrees(order, n, nodes);
    for (uint32_t i = 0; i < n; i++) {
        if (order->seen[nodes[i]] == DONE)
            continue;
        for (uint32_t met = walk_from_end(order, nodes[i]); met > 0; met--) {
            uint32_t node = order->queue[met - 1];
            order->placed[placed++] = node;
            order->seen[node] = DONE;
        }
    }
    memcpy(nodes, order->placed, n * sizeof *nodes);
}
