#ifndef DUITE_OFFLOAD_AWAY_H
#define DUITE_OFFLOAD_AWAY_H

#include "runtime/task/task.h"

/* Leaf tasks that run on another rank than the one that forked them. At home (away.c) such a task
 * stays what it is, unfinished, until what its body left comes back: then it does what the body
 * would have done. There (guest.c) it is a guest: a task with a small reference order of its own,
 * which waits for nothing, as its descendants wait for nothing but one another, and belongs to no
 * rank's count of tasks. Who decides, and what is measured, lies above. Any worker may call these.
 */

/* Whether a ready task may run on another rank; *bytes: that go there and come back. */
bool offload_may_go(const struct task_graph *graph, const struct task *task, size_t *bytes);

/* A ready task that may go is to run on rank `to`, which it is posted to. False without memory, or
 * if everything is being given up: it stays as it was. */
bool offload_send(struct task_graph *graph, struct worker *worker, struct task *task, int to);

/* What a task that is away left came; the callee owns it. */
void offload_came_home(struct task_graph *graph, struct worker *worker, struct data_packet *packet);

/* Communication broke: no task comes home any more, and none goes. */
void offload_away_lost(struct task_graph *graph, struct worker *worker);

/* Calls back with each task that is away, which stays so during the call. */
void offload_away_look(struct task_graph *graph,
                       void (*away)(void *context, const struct task *task, int rank),
                       void *context);

/* A task of another rank came; the packet becomes its. False without memory: it is the caller's. */
bool offload_guest_arrived(struct task_graph *graph, struct worker *worker,
                           struct data_packet *packet);

/* A guest: runs, returns whether a body ran; the body is over; so are its descendants; it is sent.
 */
bool offload_guest_run(struct task_graph *graph, struct worker *worker, struct task *task,
                       const duite_call *call);
void offload_guest_finish(struct worker *worker, struct task *task);
void offload_guest_over(struct task_scope *above, struct worker *worker);
void offload_guest_gone(struct task_graph *graph, struct task *task);

/* A task that went away is sent. */
void offload_away_sent(struct task_graph *graph, struct worker *worker, struct task *task);

/* The rank that a guest comes from. */
int offload_guest_home(const struct task *guest);

/* Guests that are here, until what they left is sent. */
static inline uint64_t offload_guests(const struct task_graph *graph)
{
    return atomic_load_explicit(&graph->guests, memory_order_acquire);
}

#endif
