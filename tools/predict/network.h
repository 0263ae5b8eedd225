#ifndef DUITE_TOOLS_PREDICT_NETWORK_H
#define DUITE_TOOLS_PREDICT_NETWORK_H

#include "tools/predict/graph.h"
#include "tools/predict/platform.h"

/* The network in virtual time (network.c). */

struct predict_events;

/* A link: how many flows are on it, and were when their rates were taken last. */
struct predict_link_load {
    double bandwidth;
    uint32_t *flow;
    uint32_t n, counted;
    size_t capacity;
};

/* Places up from both hosts to the switch that they share: a link each, and switches. */
enum { PREDICT_MOST_LINKS = 4 * PREDICT_MOST_SWITCHES + 1 };

/* The messages from one host to another, one after the other. */
struct predict_flow {
    uint32_t from, to;
    uint32_t first, last; /* messages; first: it is on its way */
    uint32_t next;        /* of the same sender, or among the unused; or NONE */
    uint32_t n_links, link[PREDICT_MOST_LINKS];
    uint32_t at[PREDICT_MOST_LINKS]; /* its place among the flows of each */
    double latency;
    double left, rate, since; /* bytes, of the first message; since then at this rate */
    uint64_t order;           /* of the event at which it is through */
};

struct predict_network {
    const struct predict_graph *graph;
    struct predict_events *events;
    struct predict_link_load *link;
    uint32_t *depth;  /* by place: switches above it */
    uint32_t *flows;  /* by host: those from it, or NONE */
    uint32_t *behind; /* by node: the message that waits behind this one, or NONE */
    void *memory;
    struct predict_flow *flow;
    size_t n_flows, flows_capacity;
    uint32_t unused;
    uint64_t messages, bytes;
};

/* False without memory; predict_network_stop is due all the same. */
bool predict_network_start(struct predict_network *network, const struct predict_graph *graph,
                           struct predict_events *events);
void predict_network_stop(struct predict_network *network);

/* A message begins its way now, or waits behind others of its hosts. False without memory. */
bool predict_network_send(struct predict_network *network, double now, uint32_t message);

/* An event of flows. Returns the message that is through now and needs *latency more to come; or
 * NONE: the flow has changed its rate since. *failed is set without memory. */
uint32_t predict_network_take(struct predict_network *network, double now, uint32_t flow,
                              uint64_t order, double *latency, bool *failed);

#endif
