/* Sums of a predicted run: each host that contributes combines its contributions, and sends one
 * piece to the host that adds up. A replay whose result is read on several hosts exchanges pieces,
 * and each of these hosts adds. A sum's cost on a host follows from the contributions and pieces
 * that it combines, not from its cost in the trace. */
#include "tools/predict/graph.h"

#include "runtime/base/rank_set.h"
#include "runtime/task/task.h"

/* How many contributions each host has, in graph->count; returns the most that one has. */
static uint32_t leaves_count(struct predict_graph *graph, uint32_t object)
{
    const struct predict_object *o = &graph->object[object];
    uint32_t most = 0;
    for (uint32_t i = o->leaves; i != PREDICT_NONE; i = graph->link[i].next) {
        const uint32_t n = ++graph->count[graph->link[i].host];
        most = n > most ? n : most;
    }
    return most;
}

/* Zeros the counts. Adds the merges that the sum took in the trace: one for each contribution, and
 * one for each piece from a rank to another that added up. Returns how many hosts contribute. */
static uint32_t leaves_forget(struct predict_graph *graph, uint32_t object, bool all)
{
    const struct predict_object *o = &graph->object[object];
    const double ranks = graph->run->n_ranks;
    uint32_t hosts = 0;
    for (uint32_t i = o->leaves; i != PREDICT_NONE; i = graph->link[i].next) {
        hosts += graph->count[graph->link[i].host] != 0;
        graph->count[graph->link[i].host] = 0;
        graph->merges++;
    }
    graph->merges += (ranks - 1) * (all ? ranks : 1);
    return hosts;
}

/* A piece for each other host that contributes, and its message: in graph->piece by host. */
static void pieces_make(struct predict_graph *graph, uint32_t object, uint32_t home)
{
    const struct predict_object *o = &graph->object[object];
    for (uint32_t i = o->leaves; i != PREDICT_NONE; i = graph->link[i].next)
        graph->piece[graph->link[i].host] = PREDICT_NONE;
    for (uint32_t i = o->leaves; i != PREDICT_NONE && !graph->failed; i = graph->link[i].next) {
        uint32_t host = graph->link[i].host;
        if (host == home)
            continue;
        if (graph->piece[host] == PREDICT_NONE) {
            graph->piece[host] = predict_own_node(graph, PREDICT_TASK, host, TASK_PIECES, 0);
            if (!graph->failed)
                graph->node[graph->piece[host]].seconds = (float)graph->count[host];
        }
        predict_edge(graph, graph->link[i].node, graph->piece[host]);
    }
}

/* Each contributor has a value of its own. */
static void edge_contribution(struct predict_graph *graph, uint32_t from, uint32_t sum,
                              uint32_t object)
{
    predict_edge_kind(graph, from, sum, true);
    if (graph->plain && graph->node[from].block != graph->node[sum].block)
        graph->shown[from] += (float)graph->object[object].bytes;
}

/* The nodes that the sum waits for where it is made: pieces of other hosts come by message. */
static void pieces_gather(struct predict_graph *graph, uint32_t object, uint32_t home, uint32_t sum)
{
    const struct predict_object *o = &graph->object[object];
    for (uint32_t i = o->leaves; i != PREDICT_NONE && !graph->failed; i = graph->link[i].next) {
        uint32_t host = graph->link[i].host;
        if (host == home)
            edge_contribution(graph, graph->link[i].node, sum, object);
        else if (graph->piece[host] != PREDICT_NONE)
            predict_edge(graph, graph->piece[host], sum);
        if (host != home)
            graph->piece[host] = PREDICT_NONE;
    }
}

/* The pieces' messages take their places. */
static void pieces_send(struct predict_graph *graph, uint32_t object, uint32_t home)
{
    const struct predict_object *o = &graph->object[object];
    for (uint32_t i = o->leaves; i != PREDICT_NONE && !graph->failed; i = graph->link[i].next) {
        uint32_t host = graph->link[i].host, piece = graph->piece[host];
        if (host == home || graph->node[piece].kind == PREDICT_MESSAGE)
            continue;
        uint32_t message = predict_own_node(graph, PREDICT_MESSAGE, host, 0, o->bytes);
        graph->node[message].block = home;
        predict_edge(graph, piece, message);
        graph->node[message].priority = predict_packet(graph, graph->phase[host], host, home);
        graph->piece[host] = message;
    }
}

/* Counts the copies and packets from host to host. Returns the most subtrees that one host takes.
 */
static uint32_t hops_count(struct predict_graph *graph, struct predict_node *node)
{
    const struct predict_travel *travel = &graph->travel;
    uint32_t most = 0;
    int32_t packets = 0;
    node->copies = 0;
    for (size_t i = 0; i < travel->n_hops; i++) {
        const struct predict_hop *hop = &travel->hop[i];
        const uint32_t n = graph->count[hop->to] += hop->n;
        most = n > most ? n : most;
        node->copies += hop->n;
        packets += predict_packet(graph, travel->sum_phase + hop->round, hop->from, hop->to);
    }
    for (size_t i = 0; i < travel->n_hops; i++)
        graph->count[travel->hop[i].to] = 0;
    node->placed = most;
    node->priority = packets;
    node->hops = travel->rounds;
    return most;
}

/* Counts the pieces from contributing hosts to those that add up. Returns the most that one takes.
 */
static uint32_t exchange_count(struct predict_graph *graph, uint32_t object,
                               struct predict_node *node)
{
    const struct predict_object *o = &graph->object[object];
    const size_t words = base_ranks_words((int)graph->cluster->hosts);
    const uint64_t *to = graph->travel.runs;
    const uint32_t receivers = base_ranks_count(to, words);
    uint32_t senders = 0, within = 0, packets = 0;
    base_ranks_clear(graph->among, words);
    for (uint32_t i = o->leaves; i != PREDICT_NONE; i = graph->link[i].next) {
        const uint32_t host = graph->link[i].host;
        if (base_ranks_has(graph->among, (int)host))
            continue;
        base_ranks_add(graph->among, (int)host);
        const bool adds = base_ranks_has(to, (int)host);
        senders++;
        within += adds;
        packets += (uint32_t)predict_packets(graph, graph->phase[host], host, to, receivers - adds);
    }
    const uint32_t out = receivers - (within == senders), in = senders - (within == receivers);
    node->copies = (uint64_t)senders * receivers - within;
    node->placed = out > in ? out : in;
    node->priority = (int32_t)packets;
    node->hops = 1;
    return in;
}

/* Each host sends its pieces to all others that add up. *most: the most that one of them takes. */
static uint32_t pieces_exchange(struct predict_graph *graph, uint32_t object, uint32_t *most)
{
    const struct predict_object *o = &graph->object[object];
    uint32_t exchange = predict_own_node(graph, PREDICT_EXCHANGE, 0, 0, o->bytes);
    if (graph->failed)
        return PREDICT_NONE;
    graph->node[exchange].block = 1; /* all send */
    for (uint32_t i = o->leaves; i != PREDICT_NONE; i = graph->link[i].next)
        predict_edge(graph, graph->link[i].node, exchange);
    *most = graph->travel.n_hops ? hops_count(graph, &graph->node[exchange])
                                 : exchange_count(graph, object, &graph->node[exchange]);
    return exchange;
}

/* The seconds of a sum are merges until all sums of the trace are counted. */
void predict_sums_take(struct predict_graph *graph, double seconds)
{
    const uint32_t first = graph->run->n_kernels;
    for (size_t i = 0; i < graph->n_nodes; i++) {
        struct predict_node *node = &graph->node[i];
        if (node->kernel >= first &&
            (node->kernel - first == TASK_COMBINE || node->kernel - first == TASK_PIECES ||
             node->kernel - first == TASK_NODE_SUM))
            node->seconds *= (float)seconds;
    }
}

void predict_reduce(struct predict_graph *graph, uint32_t object, int host)
{
    const bool all = host == PREDICT_ALL;
    const uint32_t home = all ? 0 : (uint32_t)host, most = leaves_count(graph, object);
    const uint32_t own = all ? most : graph->count[home];
    uint32_t fetched = predict_fetch(graph, object, host), exchange = PREDICT_NONE;
    if (!all) {
        pieces_make(graph, object, home);
        pieces_send(graph, object, home);
    }
    uint32_t taken = leaves_forget(graph, object, all) - (own > 0);
    if (all)
        exchange = pieces_exchange(graph, object, &taken);
    uint32_t sum = predict_own_node(graph, all ? PREDICT_EVERYWHERE : PREDICT_TASK, home,
                                    graph->replays ? TASK_NODE_SUM : TASK_COMBINE, 0);
    if (graph->failed)
        return;
    graph->node[sum].seconds = (float)(own + taken);
    predict_edge_value(graph, fetched, sum, object);
    predict_edge(graph, exchange, sum);
    if (!all)
        pieces_gather(graph, object, home, sum);
    predict_overwrite(graph, sum, object, host);
    graph->object[object].leaves = PREDICT_NONE;
}
