/* If two workers of a replay need each other's result at each step, the first to finish has nothing
 * left, and the other makes both next nodes ready. To hand one over by a queue moves six cache
 * lines, one after another, from core to core. So the first worker awaits a node that lacks one
 * more predecessor: it looks at that node's counter alone, and the other worker leaves the node to
 * it. No third worker can run the node meanwhile. So the wait is no longer than a node that leaves
 * no affinity may take, and it ends when a queue has a task or other programs use the core. After a
 * vain wait the worker passes over twice as many waits as the last time. */
#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

void work_may_await(struct worker *worker)
{
    struct work_awaits *awaits = &worker->awaits;
    if (awaits->pass)
        awaits->pass--;
    else
        awaits->on = worker->pool->setup.threads > 1 && worker->pool->spin_ticks &&
                     worker->looked >= worker->crowded_until;
}

static inline bool awaits_take(struct worker *worker, struct task *task)
{
    struct work_awaits *awaits = &worker->awaits;
    if (awaits->node || worker->next || !work_keeps(worker, task) || !plan_node_await(task))
        return false;
    awaits->node = task;
    return true;
}

/* True if any queue has tasks. */
static bool awaits_see_others(const struct work_pool *pool)
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
        work_batch_end(worker, batch);
    uint64_t now = batch->start, since = now;
    bool came = false, crowded = false;
    worker->looked = now;
    while (!(came = plan_node_came(task)) && !crowded && now - since < pool->affinity_ticks &&
           !awaits_see_others(pool)) {
        work_pause_core();
        now = base_ticks();
        crowded = work_is_crowded(worker, now);
    }
    queue_bump(&worker->counts.idle, now - since);
    batch->start = now;
    return came;
}

void work_count_down_awaiting(struct worker *worker, struct task *task, struct work_batch *batch)
{
    struct task_graph *graph = worker->pool->setup.graph;
    struct work_awaits *awaits = &worker->awaits;
    plan_node_count_down(graph, worker, task, work_node_ready, awaits_take);
    struct task *node = awaits->node;
    if (!node)
        return;
    awaits->node = NULL;
    if (!worker->next && awaits_node(worker, node, batch)) {
        awaits->vain = 0;
    } else {
        awaits->on = false; /* it passes over twice as many waits as the last time, and one */
        awaits->pass = awaits->vain = (uint8_t)(2 * awaits->vain + 1);
        if (plan_node_give_up(node))
            return;
    }
    if (plan_node_may_run(node->node->plan, node))
        work_node_ready(graph, worker, node);
}
