/* A task's type says whose it is: the program's and the runtime's own are run and ended by task/,
 * nodes of recorded graphs by plan/, tasks of other ranks by offload/. The choice is made here and
 * nowhere else; below this folder nobody knows the types of another one. */
#include "runtime/offload/away.h"
#include "runtime/plan/replay.h"
#include "runtime/workers/internal.h"

bool work_run_task(struct task_graph *graph, struct worker *worker, struct task *task,
                   const duite_call *call)
{
    switch (task->kind) {
    case TASK_REPLAY:
        plan_replay_run(task);
        return false;
    case TASK_NODE:
    case TASK_NODE_SET:
    case TASK_NODE_SUM:
    case TASK_NODE_PARTIAL:
    case TASK_NODE_COPY:
    case TASK_NODE_VIEW:
    case TASK_NODE_FLAG:
        return plan_node_run(graph, worker, task, call);
    case TASK_GUEST:
        return offload_guest_run(graph, worker, task, call);
    default:
        return task_run(graph, worker, task, call);
    }
}

void work_finish(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task_is_node(task))
        plan_node_finish(graph, worker, task);
    else if (task->kind == TASK_REPLAY)
        plan_replay_start(graph, worker, task);
    else if (task->kind == TASK_GUEST)
        offload_guest_finish(worker, task);
    else if (task->kind == TASK_RESULT)
        offload_guest_gone(graph, task);
    else if (task->kind == TASK_AWAY)
        offload_away_sent(graph, worker, task);
    else
        task_finish(graph, worker, task);
}

void work_offloaded_over(struct task_scope *top, struct worker *worker)
{
    offload_guest_over(top, worker);
}
