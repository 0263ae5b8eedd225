/* Nodes of a replay, one after another, as work_run runs tasks: each makes others ready, and the
 * first of these is the next. The counters of tasks are exact after each node. The clock is read
 * after each node until BATCH in turn are so short that together they would leave no affinity; then
 * once a BATCH, until one takes longer.
 *
 * If two workers need each other's result at each step, the first to finish has nothing left, and
 * the other makes both next nodes ready. To hand one over by a queue moves six cache lines, one
 * after another, from core to core. So the first worker awaits a node that lacks one more
 * predecessor: it looks at that node's counter alone, and the other worker leaves the node to it.
 * No third worker can run the node meanwhile. So the wait is no longer than a node that leaves no
 * affinity may take, and it ends when a queue has a task or other programs use the core. After a
 * vain wait the worker passes over twice as many waits as the last time. */
#include "runtime/base/clock.h"
#include "runtime/plan/node.h"
#include "runtime/workers/internal.h"

enum { BATCH = 4 };

/* The first node that becomes ready is the next one, if the scheduler need not be asked. */
static inline void nodes_ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->type == TASK_NODE && worker->may_chain && !worker->next && work_keeps(worker, task))
        worker->next = task;
    else
        plan_node_ready(graph, worker, task);
}

/* ---- Awaiting a node ---- */

/* The node did not come: the worker passes over twice as many waits as the last time, and one. At
 * most 255. */
static void awaits_failed(struct work_awaits *awaits)
{
    awaits->on = false;
    awaits->pass = awaits->vain = (uint8_t)(2 * awaits->vain + 1);
}

/* No node is left for the worker: it may await one after the next. */
static void awaits_again(struct worker *worker)
{
    struct work_awaits *awaits = &worker->awaits;
    if (awaits->pass)
        awaits->pass--;
    else
        awaits->on = worker->pool->setup.threads > 1 && worker->pool->spin_ticks &&
                     worker->looked >= worker->crowded_until;
}

static inline bool nodes_await(struct worker *worker, struct task *task)
{
    struct work_awaits *awaits = &worker->awaits;
    if (awaits->node || worker->next || !work_keeps(worker, task) || !plan_node_await(task))
        return false;
    awaits->node = task;
    return true;
}

/* True if any queue has tasks. */
static bool nodes_elsewhere(const struct work_pool *pool)
{
    bool some = !queue_is_empty(&pool->queues.shared);
    for (unsigned i = 0; i < pool->setup.threads && !some; i++)
        some = !queue_is_empty(&pool->queues.worker[i].queue);
    return some;
}

/* Waits for the node while there is nothing else to do. Returns whether it came. */
static bool awaits_node(struct worker *worker, struct task *task, struct work_batch *batch)
{
    const struct work_pool *pool = worker->pool;
    if (plan_node_came(task))
        return true;
    if (batch->tasks)
        work_batch_ends(worker, batch);
    uint64_t now = batch->start, since = now;
    bool came = false, crowded = false;
    worker->looked = now;
    while (!(came = plan_node_came(task)) && !crowded && now - since < pool->affinity_ticks &&
           !nodes_elsewhere(pool)) {
        work_pause_core();
        now = base_ticks();
        crowded = work_is_crowded(worker, now);
    }
    queue_bump(&worker->counts.idle, now - since);
    batch->start = now;
    return came;
}

/* As plan_node_count_down. If none of the successors is the next node, the worker awaits one. */
__attribute__((noinline)) static void
nodes_count_down_awaiting(struct worker *worker, struct task *task, struct work_batch *batch)
{
    struct task_graph *graph = worker->pool->setup.graph;
    struct work_awaits *awaits = &worker->awaits;
    plan_node_count_down(graph, worker, task, nodes_ready, nodes_await);
    struct task *node = awaits->node;
    if (!node)
        return;
    awaits->node = NULL;
    if (!worker->next && awaits_node(worker, node, batch)) {
        awaits->vain = 0;
    } else {
        awaits_failed(awaits);
        if (plan_node_give_up(node))
            return;
    }
    if (plan_node_may_run(node->node->plan, node))
        nodes_ready(graph, worker, node);
}

/* ---- One after another ---- */

/* Runs a node and makes its successors ready. */
static inline void nodes_run(struct worker *worker, struct task_frame *frame, struct task *task,
                             struct work_batch *batch, unsigned length)
{
    const struct task *below = work_enters(worker, task);
    const bool affine = plan_is_affine(task->node->plan);
    const bool body = plan_node_run_body(frame, task);
    work_leaves(worker, below);
    queue_bump(&worker->counts.tasks, body);
    if (++batch->tasks == BATCH || worker->brief_nodes < BATCH || affine) {
        const bool alone = batch->tasks == 1;
        const uint64_t took = work_batch_ends(worker, batch);
        if (alone)
            work_set_affinity(worker, task, took);
    }
    worker->finishing = true;
    worker->may_chain = work_goes_on(worker, length);
    if (worker->awaits.on && worker->may_chain && queue_is_empty(&worker->queue))
        nodes_count_down_awaiting(worker, task, batch);
    else
        plan_node_count_down(frame->body.graph, worker, task, nodes_ready, NULL);
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
    if (!task)
        awaits_again(worker);
    worker->within = outer + (batch.start - begin);
    return task;
}
