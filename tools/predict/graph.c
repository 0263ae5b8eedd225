/* Nodes of a predicted run, and the nodes that each waits for. Dependences are those that the
 * runtime derives from the accesses in fork order: readers wait for the last writer, and a writer
 * waits for the readers where it overwrites. A value that is read on another host is one message
 * there, however many read it. In a replay the compiled round says which hosts run a node and which
 * need a value (replay.c). */
#include "tools/predict/graph.h"

#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"
#include "runtime/plan/passes.h"
#include "runtime/task/task.h"

#include <stdlib.h>
#include <string.h>

static bool graph_room(struct predict_graph *graph, void *array, size_t *capacity, size_t n,
                       size_t size)
{
    void **old = array;
    if (n < *capacity && !graph->failed)
        return true;
    void *moved = graph->failed ? NULL : base_grow(*old, capacity, n + 1, size);
    graph->failed |= !moved;
    if (moved)
        *old = moved;
    return moved != NULL;
}

uint32_t predict_add(struct predict_graph *graph, const struct predict_node *node)
{
    graph->failed |= graph->n_nodes >= PREDICT_NONE;
    if (!graph_room(graph, &graph->node, &graph->nodes_capacity, graph->n_nodes,
                    sizeof *graph->node))
        return 0;
    if (graph->plain) {
        if (!graph_room(graph, &graph->shown, &graph->shown_capacity, graph->n_nodes,
                        sizeof *graph->shown))
            return 0;
        graph->shown[graph->n_nodes] = 0;
    }
    graph->node[graph->n_nodes] = *node;
    graph->node[graph->n_nodes].pending = 1;
    graph->node[graph->n_nodes].edge = PREDICT_NONE;
    return (uint32_t)graph->n_nodes++;
}

void predict_edge_kind(struct predict_graph *graph, uint32_t from, uint32_t to, bool reads)
{
    if (from == PREDICT_NONE || from == to || (graph->plain && !reads) ||
        !graph_room(graph, &graph->edge, &graph->edges_capacity, graph->n_edges,
                    sizeof *graph->edge))
        return;
    graph->linked |= from >= graph->round;
    graph->edge[graph->n_edges] = (struct predict_edge){to, graph->node[from].edge};
    graph->node[from].edge = (uint32_t)graph->n_edges++;
    graph->node[to].pending++;
}

void predict_edge(struct predict_graph *graph, uint32_t from, uint32_t to)
{
    predict_edge_kind(graph, from, to, false);
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

static void link_push(struct predict_graph *graph, uint32_t *list, uint32_t node, uint32_t host)
{
    if (!graph_room(graph, &graph->link, &graph->links_capacity, graph->n_links,
                    sizeof *graph->link))
        return;
    graph->link[graph->n_links] = (struct predict_link){node, host, *list};
    *list = (uint32_t)graph->n_links++;
}

uint32_t predict_own_node(struct predict_graph *graph, enum predict_kind kind, uint32_t host,
                          uint32_t what, uint64_t number)
{
    double seconds = kind == PREDICT_TASK || kind == PREDICT_EVERYWHERE ? graph->own[what] : 0;
    return predict_add(graph, &(struct predict_node){.number = number,
                                                     .kernel = graph->run->n_kernels + what,
                                                     .host = host,
                                                     .block = host,
                                                     .priority = INT32_MAX,
                                                     .seconds = (float)seconds,
                                                     .kind = kind});
}

/* ---- Reading ---- */

void predict_hint_add(struct predict_graph *graph, uint32_t object, uint32_t other, double bytes)
{
    for (int turn = 0; turn < 2; turn++) {
        const uint32_t from = turn ? other : object, to = turn ? object : other;
        if (!graph_room(graph, &graph->hint, &graph->hints_capacity, graph->n_hints,
                        sizeof *graph->hint))
            return;
        graph->hint[graph->n_hints] =
            (struct predict_hint){to, graph->object[from].hints, 0.5 * bytes};
        graph->object[from].hints = (uint32_t)graph->n_hints++;
    }
}

/* The bytes of an object that a host gets. Blocks there that read the same element count it once
 * each. */
static uint64_t transfer_bytes(const struct predict_graph *graph, uint32_t object, uint32_t host)
{
    const uint64_t whole = graph->object[object].bytes;
    double packed = 0;
    if (!graph->cluster->packed || !graph->replays)
        return whole;
    for (size_t i = 0; graph->object[object].leader != PREDICT_NONE && i < graph->n_objects; i++)
        object = graph->object[object].leader;
    for (uint32_t i = graph->object[object].hints; i != PREDICT_NONE; i = graph->hint[i].next)
        if (graph->object[graph->hint[i].object].home == (int)host)
            packed += graph->hint[i].bytes;
    return packed > 0 && packed < (double)whole ? (uint64_t)(packed + 0.5) : whole;
}

/* The host that sends another one the object's value, and the phase of a replay's round: the
 * holder, or an earlier receiver if the value goes from host to host. */
static int transfer_source(struct predict_graph *graph, uint32_t object, uint32_t host,
                           uint32_t *phase)
{
    const struct predict_object *o = &graph->object[object];
    size_t n = 0, at = 1, far = 1;
    *phase = graph->travel.phase;
    if (!graph->replays || !graph->travel.need ||
        !plan_relay_ring(graph->travel.need, (int)graph->cluster->hosts, o->holder, graph->ring,
                         &n))
        return o->holder;
    while (at < n && graph->ring[at] != (int)host)
        at++;
    for (; 2 * far <= at; far *= 2)
        ++*phase;
    return at < n ? graph->ring[at - far] : o->holder;
}

/* A message with the object's value, to a host. */
static uint32_t transfer_add(struct predict_graph *graph, uint32_t object, uint32_t host)
{
    struct predict_object *o = &graph->object[object];
    uint32_t phase;
    const int from = transfer_source(graph, object, host, &phase);
    const uint32_t before = from == o->holder ? o->writer : predict_fetch(graph, object, from);
    uint32_t message = predict_own_node(graph, PREDICT_MESSAGE, (uint32_t)from, 0,
                                        transfer_bytes(graph, object, host));
    if (graph->failed)
        return PREDICT_NONE;
    graph->node[message].block = host;
    graph->linked = false;
    predict_edge(graph, before, message);
    predict_hold(graph, message);
    graph->node[message].priority = predict_packet(graph, phase, (uint32_t)from, host);
    link_push(graph, &o->readers, message, (uint32_t)from);
    return message;
}

/* The hosts that still need the object's value, in graph->among. Returns how many. */
static uint32_t exchange_receivers(struct predict_graph *graph, const struct predict_object *o)
{
    const size_t words = base_ranks_words((int)graph->cluster->hosts);
    memcpy(graph->among, graph->travel.need, words * sizeof *graph->among);
    base_ranks_remove(graph->among, o->holder);
    for (uint32_t i = o->copies; i != PREDICT_NONE; i = graph->link[i].next)
        base_ranks_remove(graph->among, (int)graph->link[i].host);
    return base_ranks_count(graph->among, words);
}

/* The packets of a value that goes to n hosts, the set graph->among: directly, or from host to
 * host. Hosts that get it another way send it on, too. */
static int32_t exchange_packets(struct predict_graph *graph, struct predict_node *node, uint32_t n)
{
    const uint64_t *need = graph->replays ? graph->travel.need : NULL;
    const uint32_t phase = graph->travel.phase;
    size_t ring = 0;
    int32_t packets = 0;
    node->hops = need ? plan_relay_ring(need, (int)graph->cluster->hosts, (int)node->host,
                                        graph->ring, &ring)
                      : 0;
    for (uint32_t round = 0; round < node->hops; round++)
        for (size_t far = (size_t)1 << round, i = 0; i < far && i + far < ring; i++)
            if (base_ranks_has(graph->among, graph->ring[i + far]))
                packets += predict_packet(graph, phase + round, (uint32_t)graph->ring[i],
                                          (uint32_t)graph->ring[i + far]);
    if (node->hops)
        return packets;
    node->hops = 1;
    return predict_packets(graph, phase, node->host, graph->among, n);
}

/* Adds a node after which all hosts that need the object's value have it. */
static uint32_t exchange_value(struct predict_graph *graph, uint32_t object)
{
    struct predict_object *o = &graph->object[object];
    uint32_t exchange = predict_own_node(graph, PREDICT_EXCHANGE, (uint32_t)o->holder, 0, o->bytes);
    if (graph->failed)
        return PREDICT_NONE;
    struct predict_node *node = &graph->node[exchange];
    node->block = 0; /* one sends */
    node->copies = node->placed =
        graph->travel.need ? exchange_receivers(graph, o) : graph->cluster->hosts - 1;
    graph->linked = false;
    predict_edge(graph, o->writer, exchange);
    for (uint32_t i = o->copies; i != PREDICT_NONE && graph->travel.need; i = graph->link[i].next)
        predict_edge(graph, graph->link[i].node, exchange);
    predict_hold(graph, exchange);
    node->priority = exchange_packets(graph, node, node->placed);
    if (node->hops > 1) /* the first host sends once in each round */
        node->placed = node->hops;
    link_push(graph, &o->readers, exchange, (uint32_t)o->holder);
    return exchange;
}

uint32_t predict_fetch(struct predict_graph *graph, uint32_t object, int host)
{
    struct predict_object *o = &graph->object[object];
    if (o->holder == PREDICT_ALL || o->holder == host || o->lasts ||
        (graph->cluster->hosts == 1 && host == PREDICT_ALL))
        return o->writer;
    if (host == PREDICT_ALL) {
        o->writer = exchange_value(graph, object);
        o->holder = PREDICT_ALL;
        return o->writer;
    }
    for (uint32_t i = o->copies; i != PREDICT_NONE; i = graph->link[i].next)
        if (graph->link[i].host == (uint32_t)host)
            return graph->link[i].node;
    uint32_t message = transfer_add(graph, object, (uint32_t)host);
    link_push(graph, &o->copies, message, (uint32_t)host);
    return message;
}

/* ---- Writing ---- */

void predict_overwrite(struct predict_graph *graph, uint32_t node, uint32_t object, int host)
{
    struct predict_object *o = &graph->object[object];
    bool in_place = o->holder == host || o->holder == PREDICT_ALL || host == PREDICT_ALL;
    if (in_place)
        predict_edge(graph, o->writer, node);
    for (uint32_t i = o->readers; i != PREDICT_NONE; i = graph->link[i].next)
        if (host == PREDICT_ALL || graph->link[i].host == (uint32_t)host)
            predict_edge(graph, graph->link[i].node, node);
    o->writer = node;
    o->holder = host;
    o->written = true;
    o->shown = false;
    o->readers = o->copies = PREDICT_NONE;
}

/* ---- Sets ---- */

void predict_set(struct predict_graph *graph, uint32_t object, int host)
{
    predict_prepare(graph, object, DUITE_W, host);
    uint32_t node =
        predict_add(graph, &(struct predict_node){.host = host == PREDICT_ALL ? 0 : (uint32_t)host,
                                                  .kind = PREDICT_INSTANT});
    if (graph->failed)
        return;
    graph->linked = false;
    predict_overwrite(graph, node, object, host);
    predict_hold(graph, node);
}

/* ---- Uses ---- */

uint32_t predict_prepare(struct predict_graph *graph, uint32_t object, duite_mode mode, int host)
{
    if (mode == DUITE_CW)
        return PREDICT_NONE;
    if (graph->object[object].leaves != PREDICT_NONE)
        predict_reduce(graph, object, graph->object[object].home);
    return mode == DUITE_W || graph->failed ? PREDICT_NONE : predict_fetch(graph, object, host);
}

void predict_use(struct predict_graph *graph, uint32_t node, uint32_t object, duite_mode mode,
                 uint32_t prepared)
{
    const uint32_t at = graph->node[node].host;
    const int host = graph->node[node].kind == PREDICT_EVERYWHERE ? PREDICT_ALL : (int)at;
    predict_edge_value(graph, prepared, node, object);
    if (mode == DUITE_CW)
        link_push(graph, &graph->object[object].leaves, node, at);
    else if (mode != DUITE_R)
        predict_overwrite(graph, node, object, host);
    else if (!graph->plain) /* there no writer waits for readers */
        link_push(graph, &graph->object[object].readers, node, at);
}

/* A copy stays at the old home. */
void predict_rehome(struct predict_graph *graph, uint32_t object, int host)
{
    struct predict_object *o = &graph->object[object];
    const uint32_t before = (uint32_t)o->holder, writer = o->writer;
    o->home = host;
    if (o->holder == PREDICT_ALL || o->holder == host)
        return;
    o->writer = predict_fetch(graph, object, host);
    o->holder = host;
    link_push(graph, &o->copies, writer, before);
}

void predict_hold(struct predict_graph *graph, uint32_t node)
{
    if (!graph->linked)
        predict_edge_kind(graph, graph->flag, node, true);
}

void predict_graph_free(struct predict_graph *graph)
{
    free(graph->node);
    free(graph->shown);
    free(graph->edge);
    free(graph->op);
    free(graph->object);
    free(graph->link);
    free(graph->hint);
    base_free(graph->count);
    base_free(graph->piece);
    base_free(graph->began);
    base_free(graph->among);
    base_free(graph->ring);
    base_free(graph->phase);
    free(graph->packet);
}
