#ifndef DUITE_WORKERS_AWAIT_H
#define DUITE_WORKERS_AWAIT_H

#include "runtime/plan/node.h"
#include "runtime/workers/internal.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* The end of a node on a worker, with or without waiting for a successor (await.c). */

/* The first node that becomes ready is the next one, if the scheduler need not be asked. */
static inline void work_node_ready(struct task_graph *graph, struct worker *worker,
                                   struct task *task)
{
    if (task->type == TASK_NODE && worker->may_chain && !worker->next && work_keeps(worker, task))
        worker->next = task;
    else
        plan_node_ready(graph, worker, task);
}

/* As plan_node_count_down. If none of the successors is the next node, the worker awaits one. */
void work_count_down_awaiting(struct worker *worker, struct task *task, struct work_batch *batch);

/* No node is left for the worker: it may await one after the next. */
void work_may_await(struct worker *worker);

#pragma GCC visibility pop

#endif
