#ifndef DUITE_PREDICT_MACHINE_H
#define DUITE_PREDICT_MACHINE_H

#include "runtime/predict/graph.h"

/* The machine in virtual time: what waits where, and what happens next. Shared by simulate.c,
 * queues.c and network.c. */

/* Ready tasks of a worker, or that a host shares: a ring, or a heap if they are served by priority.
 */
struct predict_queue {
    uint32_t *node;
    size_t first, n, capacity; /* a power of two */
    bool heap;
};

/* False without memory. */
bool predict_queue_put(struct predict_queue *queue, const struct predict_node *nodes,
                       uint32_t node);
/* NONE: it is empty. */
uint32_t predict_queue_take(struct predict_queue *queue, const struct predict_node *nodes,
                            duite_end end);

/* What happens at a time: a node is over; `worker` NONE: not on one. Of those at one time the one
 * that was announced first comes first. */
struct predict_event {
    double time;
    uint64_t order;
    uint32_t node, worker;
};
struct predict_events {
    struct predict_event *event;
    size_t n, capacity;
    uint64_t order;
};
bool predict_event_put(struct predict_events *events, double time, uint32_t node, uint32_t worker);
bool predict_event_take(struct predict_events *events, struct predict_event *event);

/* Cards and switch, each free again at a time. */
struct predict_network {
    const struct predict_cluster *cluster;
    double *out, *in; /* by host */
    double fabric;
    uint64_t messages, bytes;
};
/* When a message that is ready now has arrived; *flight: how much of that is latency. */
double predict_message(struct predict_network *network, double now, uint32_t from, uint32_t to,
                       uint64_t bytes, double *flight);
/* When all have what one host (or, all: each of them) sends to all others. */
double predict_exchange(struct predict_network *network, double now, uint64_t bytes, bool all,
                        double *flight);

#endif
