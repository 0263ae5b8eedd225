/* From hints to homes: the graph of leaders, in the order they were made, goes to the mapping, and
 * followers go with their leaders. Every rank draws the same conclusion; homes are never asked for.
 */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

enum { NO_NODE = -1 };

struct nodes {
    duite_object_graph graph; /* points into the rest */
    int64_t *node;            /* by slot: its leader's node, or NO_NODE */
    double *weight, *edge_weight;
    size_t *start, *end; /* by node: its row of edges while it grows */
    uint32_t *neighbour;
    int *home;
};

static void nodes_free(struct nodes *nodes)
{
    base_free(nodes->node);
    base_free(nodes->weight);
    base_free(nodes->edge_weight);
    base_free(nodes->start);
    base_free(nodes->end);
    base_free(nodes->neighbour);
    base_free(nodes->home);
}

/* The hint of entry i, or NULL if its object was freed (and its slot perhaps taken again). */
static const struct data_hint *entry(struct data_table *table, size_t i)
{
    const struct data_hint *hint = data_hint_find(table, table->unsettled[i].slot);
    return hint == &table->unsettled[i] ? hint : NULL;
}

static int allocate(const struct data_table *table, struct nodes *nodes)
{
    size_t most = table->n_unsettled;
    nodes->node = base_alloc(table->n_slots * sizeof *nodes->node);
    nodes->weight = base_alloc_zero(most * sizeof *nodes->weight);
    nodes->home = base_alloc_zero(most * sizeof *nodes->home);
    nodes->start = base_alloc_zero((most + 1) * sizeof *nodes->start);
    nodes->end = base_alloc_zero((most + 1) * sizeof *nodes->end);
    if (!nodes->node || !nodes->weight || !nodes->home || !nodes->start || !nodes->end)
        return base_no_memory("the mapping");
    for (uint32_t slot = 0; slot < table->n_slots; slot++)
        nodes->node[slot] = NO_NODE;
    return DUITE_OK;
}

/* Numbers the leaders and adds up the weights of those who follow them. */
static void number(struct data_table *table, struct nodes *nodes)
{
    size_t n = 0;
    for (size_t i = 0; i < table->n_unsettled; i++) {
        const struct data_hint *hint = entry(table, i);
        if (hint && data_hint_leader(table, hint->slot) == hint->slot)
            nodes->node[hint->slot] = (int64_t)n++;
    }
    for (size_t i = 0; i < table->n_unsettled; i++) {
        const struct data_hint *hint = entry(table, i);
        int64_t node = hint ? nodes->node[data_hint_leader(table, hint->slot)] : NO_NODE;
        if (node == NO_NODE)
            continue;
        nodes->node[hint->slot] = node;
        nodes->weight[node] += hint->weight;
    }
    nodes->graph.n = n;
}

static void count_edge(struct nodes *nodes, size_t a, size_t b, double weight)
{
    (void)b;
    (void)weight;
    nodes->start[a + 1]++;
}

/* Adds to the edge if it is there already. Rows are short: a block has few neighbours. */
static void add_edge(struct nodes *nodes, size_t a, size_t b, double weight)
{
    size_t i = nodes->start[a];
    while (i < nodes->end[a] && nodes->neighbour[i] != b)
        i++;
    if (i == nodes->end[a]) {
        nodes->neighbour[i] = (uint32_t)b;
        nodes->edge_weight[i] = 0;
        nodes->end[a]++;
    }
    nodes->edge_weight[i] += weight;
}

/* Calls `visit` for each hinted edge between different nodes, both ways. */
static void each_edge(struct data_table *table, struct nodes *nodes,
                      void (*visit)(struct nodes *, size_t, size_t, double))
{
    for (size_t i = 0; i < table->n_unsettled; i++) {
        const struct data_hint *hint = entry(table, i);
        for (size_t j = 0; hint && j < hint->n; j++) {
            int64_t a = nodes->node[hint->slot], b = nodes->node[hint->neighbour[j]];
            if (a == NO_NODE || b == NO_NODE || a == b)
                continue;
            visit(nodes, (size_t)a, (size_t)b, hint->edge_weight[j]);
            visit(nodes, (size_t)b, (size_t)a, hint->edge_weight[j]);
        }
    }
}

/* Closes the gaps that repeated edges left. */
static void compress(struct nodes *nodes)
{
    size_t n = nodes->graph.n, to = 0;
    for (size_t a = 0; a < n; a++) {
        size_t from = nodes->start[a], length = nodes->end[a] - from;
        memmove(nodes->neighbour + to, nodes->neighbour + from, length * sizeof *nodes->neighbour);
        memmove(nodes->edge_weight + to, nodes->edge_weight + from,
                length * sizeof *nodes->edge_weight);
        nodes->start[a] = to;
        to += length;
    }
    nodes->start[n] = to;
}

static int build_edges(struct data_table *table, struct nodes *nodes)
{
    size_t n = nodes->graph.n;
    each_edge(table, nodes, count_edge);
    for (size_t a = 0; a < n; a++) {
        nodes->start[a + 1] += nodes->start[a];
        nodes->end[a] = nodes->start[a];
    }
    nodes->neighbour = base_alloc(nodes->start[n] * sizeof *nodes->neighbour);
    nodes->edge_weight = base_alloc(nodes->start[n] * sizeof *nodes->edge_weight);
    if (!nodes->neighbour || !nodes->edge_weight)
        return base_no_memory("the mapping");
    each_edge(table, nodes, add_edge);
    compress(nodes);
    nodes->graph = (duite_object_graph){.n = n,
                                        .before = table->settled,
                                        .weight = nodes->weight,
                                        .start = nodes->start,
                                        .neighbour = nodes->neighbour,
                                        .edge_weight = nodes->edge_weight};
    return DUITE_OK;
}

static int ask(const struct data_table *table, struct nodes *nodes, const duite_mapping *mapping,
               uint64_t seed)
{
    if (table->n_ranks == 1)
        return DUITE_OK;
    int code = mapping->map(&nodes->graph, table->n_ranks, seed, nodes->home);
    if (code)
        return code;
    for (size_t i = 0; i < nodes->graph.n; i++)
        if (nodes->home[i] < 0 || nodes->home[i] >= table->n_ranks)
            return base_error(DUITE_E_ARGUMENT, "mapping %s sends an object to rank %d of %d",
                              mapping->name, nodes->home[i], table->n_ranks);
    return DUITE_OK;
}

/* A follower of an object that was settled before goes to its home. */
static void move_in(struct data_table *table, const struct nodes *nodes)
{
    for (size_t i = 0; i < table->n_unsettled; i++) {
        const struct data_hint *hint = entry(table, i);
        if (!hint)
            continue;
        int64_t node = nodes->node[hint->slot];
        const struct data_object *leader = &table->object[data_hint_leader(table, hint->slot)];
        struct data_object *object = &table->object[hint->slot];
        int with_leader = leader->home < 0 ? 0 : leader->home; /* -1: freed before it had a home */
        object->holder = node != NO_NODE ? nodes->home[node] : with_leader;
    }
    data_hints_settled(table);
    table->settled += nodes->graph.n;
}

int map_settle(struct data_table *table, const duite_mapping *mapping, uint64_t seed)
{
    if (!table->n_unsettled)
        return DUITE_OK;
    struct nodes nodes = {0};
    int code = allocate(table, &nodes);
    if (!code) {
        number(table, &nodes);
        code = build_edges(table, &nodes);
    }
    if (!code)
        code = ask(table, &nodes, mapping, seed);
    if (!code)
        move_in(table, &nodes);
    nodes_free(&nodes);
    return code;
}
