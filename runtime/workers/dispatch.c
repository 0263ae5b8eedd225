/* Chooses by a task's type where it runs and ends. Tasks of the program and the runtime: task/;
 * nodes of recorded graphs: plan/; tasks of other ranks: offload/. Only this file chooses; the
 * folders below do not know each other's types. */
#include "runtime/offload/offload.h"
#include "runtime/plan/plan.h"
#include "runtime/task/event.h"
#include "runtime/workers/internal.h"

bool work_run_task(struct task_graph *graph, struct worker *worker, struct task *task,
                   const duite_call *call)
{
    if (task_is_node(task))
        return plan_node_run(graph, worker, task, call);
    if (task->state != TASK_VOID && task->type == TASK_OFFLOADED)
        return offload_run(graph, worker, task, call);
    if (task->state == TASK_VOID || task->type != TASK_REPLAY)
        return task_run(graph, worker, task, call);
    plan_replay_run(task);
    return false;
}

/* Ends a task whose state or type changed. */
static void finish_changed(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->state == TASK_DELEGATED)
        offload_sent(graph, worker, task);
    else if (task->type == TASK_OFFLOADED)
        offload_answered(graph, task);
    else if (task->state == TASK_HELD || task->state == TASK_ENDED)
        task_held_over(graph, worker, task);
    else
        task_finish(graph, worker, task);
}

void work_finish(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->type == TASK_BODY && task->state == TASK_LOCAL)
        task_finish(graph, worker, task);
    else if (task_is_node(task))
        plan_node_finish(graph, worker, task);
    else if (task->state != TASK_LOCAL)
        finish_changed(graph, worker, task);
    else if (task->type == TASK_REPLAY)
        plan_replay_start(graph, worker, task);
    else if (task->type == TASK_OFFLOADED)
        offload_body_over(worker, task);
    else
        task_finish(graph, worker, task);
}

/* ---- Messages ---- */

void work_guest_over(void *context, struct worker *worker, struct comm_guest *guest)
{
    struct task_graph *graph = context;
    struct task *task = task_guest_over(graph, guest);
    if (task && worker)
        work_finish(graph, worker, task);
    else if (task)
        task_end_later(graph, task);
}

static void message_sent(void *graph, struct worker *worker, struct comm_letter *letter)
{
    work_finish(graph, worker, letter->sender);
}

static void messages_broke(void *graph)
{
    queue_notify(((const struct task_graph *)graph)->pool);
}

static void message_through(void *graph, struct worker *worker, struct comm_channel *channel)
{
    plan_node_finish(graph, worker, channel->node);
}

const struct comm_owner work_messages = {.packet = task_send_packet,
                                         .sent = message_sent,
                                         .came = offload_arrived,
                                         .broke = messages_broke,
                                         .pack = plan_channel_pack,
                                         .unpack = plan_channel_unpack,
                                         .lose = plan_channel_lost,
                                         .through = message_through};
