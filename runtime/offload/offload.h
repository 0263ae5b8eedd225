#ifndef DUITE_OFFLOAD_OFFLOAD_H
#define DUITE_OFFLOAD_OFFLOAD_H

#include "runtime/task/task.h"

/* Tasks are offloaded, with their subtrees, to another rank than the one that forked them.
 *
 * At home (send.c) such a task is delegated: it stays unfinished until its result comes; then it
 * does what its body and its children would have done. On the other rank (receive.c) it is an
 * offloaded task, with a small reference order of its own. It waits for nothing, its descendants
 * wait only for one another, and no rank's count of tasks has it. Any of its descendants may be
 * delegated in turn, to a third rank or back home. The layers above decide which tasks go, and
 * measure. Any worker may call these functions. */

/* True if a ready task may run on another rank; *bytes: how many go there and come back. */
bool offload_may_go(const struct task_graph *graph, const struct task *task, size_t *bytes);

/* Sends a ready task that may go to rank `to`, where its result is expected from. False without
 * memory, or once nothing comes any more: then the task stays as it was. */
bool offload_send(struct task_graph *graph, struct worker *worker, struct task *task, int to);

/* A task of another rank came; the packet becomes the callee's. False without memory: then it stays
 * the caller's. */
bool offload_arrived(void *graph, struct worker *worker, struct data_packet *packet);

/* Runs an offloaded task; returns whether a body ran. */
bool offload_run(struct task_graph *graph, struct worker *worker, struct task *task,
                 const duite_call *call);
/* The body of an offloaded task is over. */
void offload_body_over(struct worker *worker, struct task *task);
/* Its descendants are over, too: its result is sent. `above` is the top of its scopes. */
void offload_over(struct task_scope *above, struct worker *worker);
/* Its result is sent: frees it. */
void offload_answered(struct task_graph *graph, struct task *task);

/* The message of a delegated task is sent. */
void offload_sent(struct task_graph *graph, struct worker *worker, struct task *task);

/* The rank that an offloaded task comes from. */
int offload_home(const struct task *own);

/* The number of offloaded tasks here whose results are not sent yet. */
static inline uint64_t offload_count(const struct task_graph *graph)
{
    return atomic_load_explicit(&graph->offloaded, memory_order_acquire);
}

#endif
