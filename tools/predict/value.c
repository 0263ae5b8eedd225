/* Values of objects: in which order nodes use them, and on which hosts they are. The order is the
 * runtime's (data/order.h), asked once for each use. A value that is read on another host is one
 * message there, however many read it. */
#include "tools/predict/graph.h"

#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"

#include <stdlib.h>

/* ---- Order ---- */

struct value_use {
    struct predict_graph *graph;
    const struct predict_object *object;
    int host;
};

static bool value_edge(void *context, uint32_t before, uint32_t after)
{
    const struct value_use *use = context;
    const int used = before == predict_writer(use->object) ? use->object->holder
                                                           : (int)use->graph->node[before].host;
    const bool waits = used == use->host; /* a message uses the copy where it comes from */
    if (waits)
        predict_edge(use->graph, before, after);
    return waits;
}

/* The node is the next in the chain that uses the object on a host. */
static void value_order(struct predict_graph *graph, struct data_order_chain *chain, uint32_t node,
                        uint32_t object, int host, bool writes)
{
    struct value_use use = {graph, &graph->object[object], host};
    if (predict_grew(graph,
                     BASE_GROW(graph->reader, graph->readers_capacity, graph->n_readers + 1)))
        data_order_next(chain, graph->reader, &graph->n_readers, node, writes, value_edge, &use);
}

void predict_edge_value(struct predict_graph *graph, uint32_t from, uint32_t to, uint32_t object)
{
    struct predict_object *o = &graph->object[object];
    predict_edge_kind(graph, from, to, true);
    if (!graph->plain || from == PREDICT_NONE || o->shown ||
        graph->node[from].block == graph->node[to].block)
        return;
    o->shown = true;
    graph->shown[from] += (float)o->bytes;
}

/* ---- Bytes ---- */

void predict_hint_add(struct predict_graph *graph, uint32_t object, uint32_t other, double bytes)
{
    for (int turn = 0; turn < 2; turn++) {
        const uint32_t from = turn ? other : object, to = turn ? object : other;
        if (!predict_grew(graph, BASE_GROW(graph->hint, graph->hints_capacity, graph->n_hints + 1)))
            return;
        graph->hint[graph->n_hints] =
            (struct predict_hint){to, graph->object[from].hints, 0.5 * bytes};
        graph->object[from].hints = (uint32_t)graph->n_hints++;
    }
}

/* Blocks there that read the same element count it once each. */
uint64_t predict_bytes_to(const struct predict_graph *graph, uint32_t object, uint32_t host)
{
    const uint64_t whole = graph->object[object].bytes;
    double packed = 0;
    if (!graph->cluster->packed)
        return whole;
    for (size_t i = 0; graph->object[object].leader != PREDICT_NONE && i < graph->n_objects; i++)
        object = graph->object[object].leader;
    for (uint32_t i = graph->object[object].hints; i != PREDICT_NONE; i = graph->hint[i].next)
        if (graph->object[graph->hint[i].object].home == (int)host)
            packed += graph->hint[i].bytes;
    return packed > 0 && packed < (double)whole ? (uint64_t)(packed + 0.5) : whole;
}

/* ---- Reading ---- */

/* A message with the object's value, to a host. */
static uint32_t value_send(struct predict_graph *graph, uint32_t object, uint32_t host)
{
    struct predict_object *o = &graph->object[object];
    const uint64_t bytes = graph->replays ? predict_bytes_to(graph, object, host) : o->bytes;
    uint32_t message = predict_own_node(graph, PREDICT_MESSAGE, (uint32_t)o->holder, 0, bytes);
    if (graph->failed)
        return PREDICT_NONE;
    graph->node[message].block = host;
    graph->linked = false;
    value_order(graph, &o->order, message, object, o->holder, false);
    predict_hold(graph, message);
    predict_link_push(graph, &o->copies, message, host);
    return message;
}

uint32_t predict_fetch(struct predict_graph *graph, uint32_t object, int host)
{
    struct predict_object *o = &graph->object[object];
    if (o->holder == host || o->lasts)
        return predict_writer(o);
    for (uint32_t i = o->copies; i != PREDICT_NONE; i = graph->link[i].next)
        if (graph->link[i].host == (uint32_t)host)
            return graph->link[i].node;
    return value_send(graph, object, (uint32_t)host);
}

uint32_t predict_prepare(struct predict_graph *graph, uint32_t object, duite_mode mode, int host)
{
    if (data_order_joins(mode, NULL, NULL))
        return PREDICT_NONE;
    if (graph->object[object].leaves != PREDICT_NONE)
        predict_reduce(graph, object);
    return data_order_reads(mode) && !graph->failed ? predict_fetch(graph, object, host)
                                                    : PREDICT_NONE;
}

uint32_t predict_prepare_all(struct predict_graph *graph, uint32_t object, duite_mode mode)
{
    const uint32_t first = predict_prepare(graph, object, mode, 0);
    for (uint32_t host = 1; host < graph->cluster->hosts; host++)
        predict_prepare(graph, object, mode, (int)host);
    return first;
}

/* ---- Writing ---- */

/* The copy on the holder is the only one. */
static void value_forget(struct predict_object *o, int holder)
{
    o->holder = holder;
    o->written = true;
    o->shown = false;
    o->copies = PREDICT_NONE;
}

void predict_overwrite(struct predict_graph *graph, uint32_t node, uint32_t object, int host)
{
    struct predict_object *o = &graph->object[object];
    value_order(graph, &o->order, node, object, host, true);
    value_forget(o, host);
}

void predict_set(struct predict_graph *graph, uint32_t object)
{
    const int home = graph->object[object].home;
    predict_prepare(graph, object, DUITE_W, home);
    uint32_t node =
        predict_add(graph, &(struct predict_node){.host = (uint32_t)home, .kind = PREDICT_INSTANT});
    if (graph->failed)
        return;
    graph->linked = false;
    predict_overwrite(graph, node, object, home);
    predict_hold(graph, node);
}

void predict_use(struct predict_graph *graph, uint32_t node, uint32_t object, duite_mode mode,
                 uint32_t prepared)
{
    struct predict_object *o = &graph->object[object];
    const uint32_t host = graph->node[node].host;
    predict_edge_value(graph, prepared, node, object);
    if (data_order_joins(mode, NULL, NULL))
        predict_link_push(graph, &o->leaves, node, host);
    else if (data_order_writes(mode))
        predict_overwrite(graph, node, object, (int)host);
    else
        value_order(graph, &o->order, node, object, (int)host, false);
}

/* A copy stays at the old home. */
void predict_rehome(struct predict_graph *graph, uint32_t object, int host)
{
    struct predict_object *o = &graph->object[object];
    const uint32_t before = (uint32_t)o->holder, writer = predict_writer(o);
    o->home = host;
    if (o->holder == host)
        return;
    o->order.writer = predict_fetch(graph, object, host) + 1;
    o->holder = host;
    predict_link_push(graph, &o->copies, writer, before);
}

/* ---- Several hosts at once ---- */

void predict_enter(struct predict_graph *graph, uint32_t node, uint32_t object, int host,
                   bool reads, bool writes)
{
    struct data_order_chain chain = graph->object[object].order;
    if (reads)
        predict_edge_value(graph, predict_fetch(graph, object, host), node, object);
    if (writes)
        value_order(graph, &chain, node, object, host, true);
}

void predict_leave(struct predict_graph *graph, uint32_t object, const uint64_t *hosts, bool writes)
{
    struct predict_object *o = &graph->object[object];
    const size_t words = base_ranks_words((int)graph->cluster->hosts);
    const int first = base_ranks_next(hosts, words, 0);
    if (writes && first >= 0) {
        value_forget(o, base_ranks_has(hosts, o->home) ? o->home : first);
        o->order = (struct data_order_chain){.writer = graph->over[o->holder] + 1};
    }
    for (int host = first; host >= 0; host = base_ranks_next(hosts, words, host + 1))
        if (!writes)
            value_order(graph, &o->order, graph->over[host], object, host, false);
        else if (host != o->holder)
            predict_link_push(graph, &o->copies, graph->over[host], (uint32_t)host);
}
