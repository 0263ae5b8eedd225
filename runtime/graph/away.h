#ifndef DUITE_GRAPH_AWAY_H
#define DUITE_GRAPH_AWAY_H

#include "runtime/graph/graph.h"

/* Leaf tasks that run on another rank than the one that forked them. At home (away.c) such a task
 * stays what it is, unfinished, until what its body left comes back: then it does what the body
 * would have done. There (guest.c) it is a guest: a task with a small reference order of its own,
 * which waits for nothing, as its descendants wait for nothing but one another, and belongs to no
 * rank's count of tasks. Who decides, and what is measured, lies above. Any worker may call these.
 */

/* Whether a ready task may run on another rank; *bytes: that go there and come back. */
bool graph_may_go(const struct graph *graph, const struct graph_task *task, size_t *bytes);

/* A ready task that may go is to run on rank `to`, which it is posted to. False without memory, or
 * if everything is being given up: it stays as it was. */
bool graph_send_away(struct graph *graph, void *worker, struct graph_task *task, int to);

/* What a task that is away left came; the callee owns it. */
void graph_came_home(struct graph *graph, void *worker, struct data_packet *packet);

/* Communication broke: no task comes home any more, and none goes. */
void graph_away_lost(struct graph *graph, void *worker);

/* Calls back with each task that is away, which stays so during the call. */
void graph_away_look(struct graph *graph,
                     void (*away)(void *context, const struct graph_task *task, int rank),
                     void *context);

/* A task of another rank came; the packet becomes its. False without memory: it is the caller's. */
bool graph_guest_arrived(struct graph *graph, void *worker, struct data_packet *packet);

/* The rank that a guest comes from. */
int graph_guest_home(const struct graph_task *guest);

/* Guests that are here, until what they left is sent. */
static inline uint64_t graph_guests(const struct graph *graph)
{
    return atomic_load_explicit(&graph->guests, memory_order_acquire);
}

#endif
