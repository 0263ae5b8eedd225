/* Nodes of a replay, one after another, as work_run runs tasks: each makes others ready, of which
 * the first is the next. The counters of tasks are exact after each of them. The clock is read
 * after each node, until BATCH in turn are so short that all of them together would leave no
 * affinity; then once for BATCH, until these take longer. */
#include "runtime/base/clock.h"
#include "runtime/plan/node.h"
#include "runtime/workers/internal.h"

enum { BATCH = 4 };

/* The first node that becomes ready is the next one, if the scheduler need not be asked. */
static inline void nodes_ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->type == TASK_NODE && worker->may_chain && !worker->next && !plan_task_affinity(task))
        worker->next = task;
    else
        plan_node_ready(graph, worker, task);
}

/* Runs a node; what it leaves becomes ready. */
static inline void nodes_run(struct worker *worker, struct task_frame *frame, struct task *task,
                             struct work_batch *batch, unsigned length)
{
    const struct task *below = work_enters(worker, task);
    const bool affine = plan_is_affine(task->node->plan);
    const bool body = plan_node_run_body(frame, task);
    work_leaves(worker, below);
    work_bump(&worker->counts.tasks, body);
    if (++batch->tasks == BATCH || worker->brief_nodes < BATCH || affine) {
        const bool alone = batch->tasks == 1;
        const uint64_t took = work_batch_ends(worker, batch);
        if (alone)
            work_set_affinity(worker, task, took);
    }
    worker->finishing = true;
    worker->may_chain = work_goes_on(worker, length);
    plan_node_count_down(frame->body.graph, worker, task, nodes_ready);
    worker->finishing = false;
    worker->may_chain = false;
}

struct task *work_run_nodes(struct worker *worker, struct task *task, unsigned *length)
{
    const uint64_t outer = worker->within, begin = base_ticks();
    struct work_batch batch = {.start = begin,
                               .limit = worker->pool->affinity_ticks / BATCH,
                               .brief = &worker->brief_nodes};
    struct task_frame frame;
    task_frame_init(&frame, worker->pool->setup.graph, worker, &worker->call);
    worker->within = 0;
    for (;; ++*length) {
        nodes_run(worker, &frame, task, &batch, *length);
        task = work_take_next(worker);
        if (!task || task->type != TASK_NODE)
            break;
        if (!batch.tasks)
            batch.start = work_inline_start(worker, *length, batch.start);
    }
    if (batch.tasks)
        work_batch_ends(worker, &batch);
    worker->within = outer + (batch.start - begin);
    return task;
}
