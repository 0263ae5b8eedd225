/* The network in virtual time. Each link of a flow's way divides its bandwidth equally among its
 * flows, and a flow is as fast as the slowest share allows: whatever others leave of theirs stays
 * unused (SimGrid gives it away). When a flow comes or goes, the flows on its links get new rates;
 * on a link with more than 16 only once their number has changed by a sixteenth, or a crowd would
 * cost its square. A rate that changes makes a new event; the one before is void by its order. */
#include "tools/predict/network.h"

#include "runtime/base/memory.h"
#include "tools/predict/machine.h"

#include <math.h>
#include <stdlib.h>

enum { EXACT_FLOWS = 16 };

/* ---- Ways ---- */

/* A place has three links: up, down, and through itself. */
enum link_kind { LINK_UP, LINK_DOWN, LINK_THROUGH, LINK_KINDS };

static void way_add(struct predict_network *network, struct predict_flow *flow, uint32_t place,
                    enum link_kind kind)
{
    const uint32_t link = place * LINK_KINDS + kind;
    if (network->link[link].bandwidth < INFINITY)
        flow->link[flow->n_links++] = link;
    if (kind != LINK_THROUGH)
        flow->latency += network->graph->platform->place[place].latency;
}

/* The sender's side goes up first, so that the switch where both meet is passed once. */
static void way_find(struct predict_network *network, struct predict_flow *flow)
{
    const struct predict_place *place = network->graph->platform->place;
    uint32_t from = flow->from, to = flow->to;
    while (from != to)
        if (network->depth[from] >= network->depth[to]) {
            way_add(network, flow, from, LINK_UP);
            from = place[from].up;
            way_add(network, flow, from, LINK_THROUGH);
        } else {
            way_add(network, flow, to, LINK_DOWN);
            to = place[to].up;
            if (from != to)
                way_add(network, flow, to, LINK_THROUGH);
        }
}

/* ---- Rates ---- */

static bool flow_put_event(struct predict_network *network, uint32_t i, double now)
{
    struct predict_flow *flow = &network->flow[i];
    flow->order = network->events->order;
    return predict_event_put(network->events, now + flow->left / flow->rate, i, PREDICT_FLOW);
}

static double flow_rate(const struct predict_network *network, const struct predict_flow *flow)
{
    double rate = INFINITY;
    for (uint32_t k = 0; k < flow->n_links; k++) {
        const struct predict_link_load *link = &network->link[flow->link[k]];
        const double share = link->bandwidth / (double)link->n;
        rate = share < rate ? share : rate;
    }
    return rate;
}

/* The number of flows on the link has changed; `but` has its rate. */
static bool link_changed(struct predict_network *network, struct predict_link_load *link,
                         uint32_t but, double now)
{
    const uint32_t change =
        link->n > link->counted ? link->n - link->counted : link->counted - link->n;
    bool fine = true;
    if (EXACT_FLOWS * change <= link->counted && link->n > EXACT_FLOWS)
        return true;
    link->counted = link->n;
    for (uint32_t i = 0; i < link->n && fine; i++) {
        struct predict_flow *flow = &network->flow[link->flow[i]];
        const double rate = link->flow[i] == but ? flow->rate : flow_rate(network, flow);
        if (!(rate < flow->rate) && !(flow->rate < rate))
            continue;
        flow->left = fmax(flow->left - flow->rate * (now - flow->since), 0);
        flow->rate = rate;
        flow->since = now;
        fine = flow_put_event(network, link->flow[i], now);
    }
    return fine;
}

/* ---- Flows ---- */

static uint32_t flow_unused(struct predict_network *network)
{
    const uint32_t unused = network->unused;
    if (unused != PREDICT_NONE) {
        network->unused = network->flow[unused].next;
        return unused;
    }
    if (!BASE_GROW(network->flow, network->flows_capacity, network->n_flows + 1))
        return PREDICT_NONE;
    return (uint32_t)network->n_flows++;
}

/* The first message of the flow begins. */
static bool flow_next(struct predict_network *network, uint32_t i, double now)
{
    struct predict_flow *flow = &network->flow[i];
    flow->left = (double)network->graph->node[flow->first].number;
    flow->since = now;
    return flow_put_event(network, i, now);
}

static bool flow_begin(struct predict_network *network, uint32_t i, double now)
{
    struct predict_flow *flow = &network->flow[i];
    bool fine = true;
    for (uint32_t k = 0; k < flow->n_links && fine; k++) {
        struct predict_link_load *link = &network->link[flow->link[k]];
        fine = BASE_GROW(link->flow, link->capacity, link->n + 1);
        if (!fine)
            return false;
        flow->at[k] = link->n;
        link->flow[link->n++] = i;
    }
    flow->rate = flow_rate(network, flow);
    fine = flow_next(network, i, now);
    for (uint32_t k = 0; k < flow->n_links && fine; k++)
        fine = link_changed(network, &network->link[flow->link[k]], i, now);
    return fine;
}

static void link_leave(struct predict_network *network, const struct predict_flow *flow, uint32_t k)
{
    struct predict_link_load *link = &network->link[flow->link[k]];
    const uint32_t last = link->flow[--link->n];
    struct predict_flow *moved = &network->flow[last];
    link->flow[flow->at[k]] = last;
    for (uint32_t j = 0; j < moved->n_links; j++)
        if (moved->link[j] == flow->link[k])
            moved->at[j] = flow->at[k];
}

static bool flow_end(struct predict_network *network, uint32_t i, double now)
{
    struct predict_flow *flow = &network->flow[i];
    uint32_t *list = &network->flows[flow->from];
    bool fine = true;
    for (uint32_t k = 0; k < flow->n_links; k++)
        link_leave(network, flow, k);
    for (uint32_t k = 0; k < flow->n_links && fine; k++)
        fine = link_changed(network, &network->link[flow->link[k]], i, now);
    while (*list != i)
        list = &network->flow[*list].next;
    *list = flow->next;
    flow->next = network->unused;
    flow->order = UINT64_MAX;
    network->unused = i;
    return fine;
}

bool predict_network_send(struct predict_network *network, double now, uint32_t message)
{
    const struct predict_node *node = &network->graph->node[message];
    uint32_t i = network->flows[node->host];
    network->messages++;
    network->bytes += node->number;
    network->behind[message] = PREDICT_NONE;
    while (i != PREDICT_NONE && network->flow[i].to != node->block)
        i = network->flow[i].next;
    if (i != PREDICT_NONE) {
        network->behind[network->flow[i].last] = message;
        network->flow[i].last = message;
        return true;
    }
    if ((i = flow_unused(network)) == PREDICT_NONE)
        return false;
    struct predict_flow *flow = &network->flow[i];
    flow->from = node->host;
    flow->to = node->block;
    flow->first = flow->last = message;
    flow->next = network->flows[node->host];
    flow->n_links = 0;
    flow->latency = 0;
    network->flows[node->host] = i;
    way_find(network, flow);
    return flow_begin(network, i, now);
}

uint32_t predict_network_take(struct predict_network *network, double now, uint32_t i,
                              uint64_t order, double *latency, bool *failed)
{
    struct predict_flow *flow = &network->flow[i];
    if (order != flow->order)
        return PREDICT_NONE;
    const uint32_t message = flow->first;
    *latency = flow->latency;
    flow->first = network->behind[message];
    *failed |=
        flow->first == PREDICT_NONE ? !flow_end(network, i, now) : !flow_next(network, i, now);
    return message;
}

/* ---- Start and stop ---- */

static void network_links(struct predict_network *network)
{
    const struct predict_platform *platform = network->graph->platform;
    for (uint32_t p = 0; p < platform->n_places; p++) {
        const struct predict_place *place = &platform->place[p];
        const bool host = p < platform->n_hosts;
        network->link[p * LINK_KINDS + LINK_UP].bandwidth = place->bandwidth;
        network->link[p * LINK_KINDS + LINK_DOWN].bandwidth = place->bandwidth;
        network->link[p * LINK_KINDS + LINK_THROUGH].bandwidth = host ? INFINITY : place->capacity;
        for (uint32_t up = p; platform->place[up].up != up; up = platform->place[up].up)
            network->depth[p]++;
    }
}

bool predict_network_start(struct predict_network *network, const struct predict_graph *graph,
                           struct predict_events *events)
{
    const struct predict_platform *platform = graph->platform;
    *network = (struct predict_network){.graph = graph, .events = events, .unused = PREDICT_NONE};
    const struct base_array arrays[] = {BASE_ZEROS(network->link, LINK_KINDS * platform->n_places),
                                        BASE_ZEROS(network->depth, platform->n_places),
                                        BASE_ARRAY(network->flows, platform->n_hosts),
                                        BASE_ARRAY(network->behind, graph->n_nodes + 1),
                                        {0}};
    network->memory = base_arrays(arrays);
    if (!network->memory)
        return false;
    for (uint32_t h = 0; h < platform->n_hosts; h++)
        network->flows[h] = PREDICT_NONE;
    network_links(network);
    return true;
}

void predict_network_stop(struct predict_network *network)
{
    for (size_t i = 0; network->memory && i < LINK_KINDS * network->graph->platform->n_places; i++)
        free(network->link[i].flow);
    free(network->flow);
    base_free(network->memory);
}
