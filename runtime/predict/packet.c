/* Packets: in a round of a replay all that goes from one host to another in a phase is one message,
 * as plan/messages.c has it. A phase is the number of messages on the longest path to what is sent.
 * The set of a round's packets is an open table; outside of replays each message is a packet. */
#include "runtime/predict/graph.h"

#include "runtime/base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_PAIRS = 64 }; /* hosts: among more, what all send to all rides with nothing */

void predict_packets_clear(struct predict_graph *graph)
{
    if (graph->n_packets)
        memset(graph->packet, 0, graph->packets_capacity * sizeof *graph->packet);
    graph->n_packets = 0;
}

/* Where it is, or goes. */
static uint64_t *packet_place(uint64_t *table, size_t capacity, uint64_t key)
{
    uint64_t state = key;
    size_t at = (size_t)duite_random(&state) & (capacity - 1);
    while (table[at] && table[at] != key)
        at = (at + 1) & (capacity - 1);
    return &table[at];
}

static bool packet_room(struct predict_graph *graph)
{
    const size_t more = graph->packets_capacity ? 2 * graph->packets_capacity : 64;
    uint64_t *table = calloc(more, sizeof *table);
    if (!table)
        return false;
    for (size_t i = 0; i < graph->packets_capacity; i++)
        if (graph->packet[i])
            *packet_place(table, more, graph->packet[i]) = graph->packet[i];
    free(graph->packet);
    graph->packet = table;
    graph->packets_capacity = more;
    return true;
}

/* Whether it is the first of its packet. */
static bool packet_leads(struct predict_graph *graph, uint32_t phase, uint32_t from, uint32_t to)
{
    const uint64_t hosts = graph->cluster->hosts;
    const uint64_t key = 1 + (uint64_t)to + hosts * (from + hosts * phase);
    if (2 * graph->n_packets >= graph->packets_capacity && !packet_room(graph)) {
        graph->failed = true;
        return true;
    }
    uint64_t *place = packet_place(graph->packet, graph->packets_capacity, key);
    const bool first = !*place;
    *place = key;
    graph->n_packets += first;
    return first;
}

int32_t predict_packets(struct predict_graph *graph, uint32_t message)
{
    const struct predict_node *node = &graph->node[message];
    const uint32_t hosts = graph->cluster->hosts;
    if (node->kind == PREDICT_MESSAGE)
        return !graph->replays || packet_leads(graph, node->phase, node->host, node->block);
    const bool all = node->block;
    if (!graph->replays || hosts > MOST_PAIRS)
        return (int32_t)((all ? hosts : 1) * (hosts - 1));
    int32_t n = 0;
    for (uint32_t from = all ? 0 : node->host; from < (all ? hosts : node->host + 1); from++)
        for (uint32_t to = 0; to < hosts; to++)
            n += to != from && packet_leads(graph, node->phase, from, to);
    return n;
}
