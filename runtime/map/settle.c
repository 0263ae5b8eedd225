/* Hints, and the homes that follow from them. A program says which objects belong together, the
 * same on every rank. When homes are needed, the graph of leaders, in the order they were made,
 * goes to the mapping, and objects colocated with a leader get its home. Every rank comes to the
 * same homes; no rank asks another. All objects without a home are alive, since a free settles them
 * first. The work is that of these objects and their hints, not of all objects. */
#include "runtime/map/blocks.h"
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/object.h"

#include <stdlib.h>
#include <string.h>

/* ---- Hints ---- */

static int hint_check_object(struct data_table *table, duite_object name)
{
    return data_object_find(table, name) ? DUITE_OK : DUITE_E_OBJECT;
}

static int hint_check_weight(const char *what, double weight)
{
    if (weight >= 0 && weight <= 1e300)
        return DUITE_OK;
    return base_error(DUITE_E_ARGUMENT, "duite_hint: %s %g is not a finite number >= 0", what,
                      weight);
}

static int hint_check_edges(struct data_table *table, size_t n, const duite_object *neighbours,
                            const double *edge_weights)
{
    if (n && !neighbours)
        return base_error(DUITE_E_ARGUMENT, "duite_hint: no neighbours");
    for (size_t i = 0; i < n; i++) {
        int code = hint_check_object(table, neighbours[i]);
        if (!code)
            code = hint_check_weight("edge weight", edge_weights ? edge_weights[i] : 1);
        if (code)
            return code;
    }
    return DUITE_OK;
}

static int hint_add_edges(struct data_hint *hint, size_t n, const duite_object *neighbours,
                          const double *edge_weights)
{
    uint32_t *neighbour = realloc(hint->neighbour, (hint->n + n) * sizeof *neighbour);
    if (neighbour)
        hint->neighbour = neighbour;
    double *edge = realloc(hint->edge_weight, (hint->n + n) * sizeof *edge);
    if (edge)
        hint->edge_weight = edge;
    if (!neighbour || !edge)
        return base_no_memory("a hint");
    for (size_t i = 0; i < n; i++) {
        neighbour[hint->n] = neighbours[i].slot;
        edge[hint->n++] = edge_weights ? edge_weights[i] : 1;
    }
    return DUITE_OK;
}

int map_hint(struct data_table *table, duite_object object, double weight, size_t n,
             const duite_object *neighbours, const double *edge_weights)
{
    int code = hint_check_object(table, object);
    if (!code)
        code = hint_check_weight("weight", weight);
    if (!code)
        code = hint_check_edges(table, n, neighbours, edge_weights);
    struct data_hint *hint = code ? NULL : data_hint_find(table, object.slot);
    if (!hint)
        return code;
    hint->weight = weight;
    return n ? hint_add_edges(hint, n, neighbours, edge_weights) : DUITE_OK;
}

/* True if `object` is on the chain of leaders that begins with `slot`. */
static bool leader_is_above(struct data_table *table, uint32_t slot, uint32_t object)
{
    while (slot != object) {
        const struct data_hint *hint = data_hint_find(table, slot);
        if (!hint || hint->leader == slot)
            return false;
        slot = hint->leader;
    }
    return true;
}

int map_colocate(struct data_table *table, duite_object object, duite_object leader)
{
    int code = hint_check_object(table, object);
    if (!code)
        code = hint_check_object(table, leader);
    if (code)
        return code;
    struct data_hint *hint = data_hint_find(table, object.slot);
    if (leader_is_above(table, leader.slot, object.slot))
        return base_error(DUITE_E_ARGUMENT, "duite_colocate: object %u.%u would be its own leader",
                          object.slot, object.generation);
    if (hint)
        hint->leader = leader.slot;
    return DUITE_OK;
}

/* ---- Homes ---- */

struct nodes {
    void *memory; /* of the arrays by place in `unsettled` */
    size_t n;
    uint32_t *node; /* its leader's node; MAP_NO_BLOCK: that is settled */
    double *weight; /* by node, as is `home` */
    int *home;
    struct map_traffic traffic; /* between nodes, as hinted */
};

static int nodes_allocate(const struct data_table *table, struct nodes *nodes)
{
    const size_t max = table->n_unsettled;
    const struct base_array arrays[] = {BASE_ARRAY(nodes->node, max),
                                        BASE_ZEROS(nodes->weight, max),
                                        BASE_ZEROS(nodes->home, max),
                                        {0}};
    nodes->memory = base_arrays(arrays);
    return nodes->memory ? DUITE_OK : base_no_memory("the mapping");
}

/* The node of the object in a slot. */
static uint32_t node_of(const struct data_table *table, const struct nodes *nodes, uint32_t slot)
{
    const struct data_hint *hint = data_hint_find(table, slot);
    return hint ? nodes->node[hint - table->unsettled] : MAP_NO_BLOCK;
}

/* Lets each object follow the end of its chain of leaders directly: an object that follows none, or
 * one with a home. Each link is walked a few times only, since walked chains are cut short. */
static void leaders_shorten(struct data_table *table)
{
    for (size_t i = 0; i < table->n_unsettled; i++) {
        uint32_t end = table->unsettled[i].slot;
        struct data_hint *hint;
        while ((hint = data_hint_find(table, end)) && hint->leader != end)
            end = hint->leader;
        for (uint32_t slot = table->unsettled[i].slot, next; slot != end; slot = next) {
            hint = data_hint_find(table, slot);
            next = hint->leader;
            hint->leader = end;
        }
    }
}

/* Numbers the leaders and adds up the weights of the objects that are colocated with them. */
static void nodes_number(const struct data_table *table, struct nodes *nodes)
{
    const struct data_hint *hint = table->unsettled;
    for (size_t i = 0; i < table->n_unsettled; i++)
        nodes->node[i] = hint[i].leader == hint[i].slot ? (uint32_t)nodes->n++ : MAP_NO_BLOCK;
    for (size_t i = 0; i < table->n_unsettled; i++) {
        nodes->node[i] = node_of(table, nodes, hint[i].leader);
        if (nodes->node[i] != MAP_NO_BLOCK)
            nodes->weight[nodes->node[i]] += hint[i].weight;
    }
}

static int nodes_join(const struct data_table *table, struct nodes *nodes)
{
    bool fine = true;
    for (size_t i = 0; i < table->n_unsettled && fine; i++) {
        const struct data_hint *hint = &table->unsettled[i];
        for (size_t j = 0; j < hint->n && fine; j++)
            fine =
                map_traffic_read(&nodes->traffic, nodes->node[i],
                                 node_of(table, nodes, hint->neighbour[j]), hint->edge_weight[j]);
    }
    return fine ? map_traffic_end(&nodes->traffic, nodes->n) : base_no_memory("the mapping");
}

static int nodes_ask(const struct data_table *table, struct nodes *nodes,
                     const struct map_policy *mapping, uint64_t seed)
{
    const duite_object_graph graph = {.n = nodes->n,
                                      .before = table->settled,
                                      .weight = nodes->weight,
                                      .start = nodes->traffic.start,
                                      .neighbour = nodes->traffic.neighbour,
                                      .edge_weight = nodes->traffic.bytes};
    const int code = map_ask(mapping, &graph, table->n_ranks, seed, nodes->home);
    if (code)
        return code;
    for (size_t i = 0; i < nodes->n; i++)
        if (nodes->home[i] < 0 || nodes->home[i] >= table->n_ranks)
            return base_error(DUITE_E_ARGUMENT, "mapping %s sends an object to rank %d of %d",
                              mapping->own->name, nodes->home[i], table->n_ranks);
    return DUITE_OK;
}

/* Gives leaders their homes and numbers there, and the other objects their leader's home. */
static void nodes_settle(struct data_table *table, const struct nodes *nodes)
{
    for (size_t i = 0; i < table->n_unsettled; i++) {
        uint32_t slot = table->unsettled[i].slot;
        if (table->unsettled[i].leader != slot)
            continue;
        uint64_t state = table->homes ^ (uint64_t)nodes->home[nodes->node[i]];
        table->homes = duite_random(&state);
        data_object_settle(table, slot, nodes->home[nodes->node[i]]);
    }
    for (size_t i = 0; i < table->n_unsettled; i++)
        data_object_join(table, table->unsettled[i].slot, table->unsettled[i].leader);
    data_hints_forget(table);
    table->settled += nodes->n;
}

int map_settle(struct data_table *table, const struct map_policy *mapping, uint64_t seed)
{
    if (!table->n_unsettled)
        return DUITE_OK;
    struct nodes nodes = {0};
    int code = nodes_allocate(table, &nodes);
    if (!code) {
        leaders_shorten(table);
        nodes_number(table, &nodes);
    }
    if (!code && table->n_ranks > 1)
        code = nodes_join(table, &nodes);
    if (!code && table->n_ranks > 1)
        code = nodes_ask(table, &nodes, mapping, seed);
    if (!code)
        nodes_settle(table, &nodes);
    map_traffic_free(&nodes.traffic);
    base_free(nodes.memory);
    return code;
}
