/* Where a ready task goes: to its rank, if it is to be sent; to another one, if a balancer wants
 * that; next to the task that made it ready; or to the queue that the scheduler names. Most tasks
 * stay with the worker that made them ready, and no policy is asked. */
#include "runtime/task/body.h"
#include "runtime/task/internal.h"

__attribute__((noinline)) static void place_put(struct worker *worker, struct task *task,
                                                unsigned queue)
{
    struct queue_pool *pool = worker->queues;
    queue_bump(&worker->counts.placed, 1);
    /* Forks of the main program go to the inbox, where others take all at once. That costs both
     * sides less than a deque that one fills while the other empties it. A body mostly waits for
     * its forks itself. */
    if (queue == worker->index && (worker->finishing || queue_in_body(worker)))
        queue_push(&worker->queue, task);
    else if (queue < pool->n)
        queue_put(&pool->worker[queue].queue, task);
    else
        queue_put(&pool->shared, task);
    queue_wake_one(pool, queue);
}

/* The queue that the scheduler names. */
static unsigned place_named(const struct worker *worker, const duite_ready *ready)
{
    base_mark_begin(worker->mark, BASE_SCHEDULER_PLACE);
    const unsigned queue = worker->queues->scheduler->place(worker->state, ready);
    base_mark_end(worker->mark);
    return queue;
}

/* True if the scheduler wants the task inline after the one that made it ready. */
static bool place_is_inline(const struct worker *worker, const duite_ready *ready)
{
    base_mark_begin(worker->mark, BASE_SCHEDULER_CHAIN);
    const int is_inline = worker->queues->scheduler->chain(worker->state, ready);
    base_mark_end(worker->mark);
    return is_inline;
}

/* True if no body waits, or the task may run on top of it. */
static inline bool place_fits(const struct worker *worker, const struct task *task)
{
    return !worker->waits || task->scope == worker->waits ||
           (queue_nests_freely(worker) && task_may_run_other(worker->waits, task));
}

/* Next, unless a body waits below and the task may not run on top: then it goes to a queue. */
__attribute__((noinline)) static void place_on_top(struct worker *worker, struct task *task)
{
    if (place_fits(worker, task))
        worker->next = task;
    else
        place_put(worker, task, worker->index);
}

/* Apart from the rest, since most tasks stay and need no description. */
__attribute__((noinline)) static void place_ask(const struct task_graph *graph,
                                                struct worker *worker, struct task *task,
                                                bool may_run, uint32_t affinity)
{
    const duite_ready ready = {.kernel = task_has_body(task) ? graph->kernels[task->kernel]->name
                                                             : task_own_name(task_own_number(task)),
                               .number = task->number,
                               .block = task->block,
                               .priority = task->priority,
                               .cost = task->cost,
                               .path = task_path(task),
                               .affinity = affinity};
    if (may_run && place_is_inline(worker, &ready) && place_fits(worker, task))
        worker->next = task;
    else
        place_put(worker, task, place_named(worker, &ready));
}

__attribute__((noinline)) void task_place(struct task_graph *graph, struct worker *worker,
                                          struct task *task, uint32_t affinity)
{
    const struct queue_pool *pool = worker->queues;
    if (task_to_send(task)) {
        comm_send(graph->comm, task->send);
        return;
    }
    if (pool->goes_away && pool->goes_away(worker, task))
        return;
    const bool may_run = worker->may_chain && !worker->next;
    if (!pool->by_affinity || !queue_keeps(worker, affinity))
        place_ask(graph, worker, task, may_run, affinity);
    else if (may_run)
        place_on_top(worker, task);
    else
        place_put(worker, task, worker->index);
}

/* True if no policy is asked where the task goes, as for most. */
static inline bool place_is_straight(const struct queue_pool *pool, const struct task *task)
{
    return task->type == TASK_BODY && task->state == TASK_LOCAL && pool->straight;
}

/* All calls are tail calls: for most tasks, which become next, no register is saved. */
void task_ready(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (!place_is_straight(graph->pool, task))
        task_place(graph, worker, task, 0);
    else if (!worker->may_chain || worker->next)
        place_put(worker, task, worker->index);
    else if (worker->waits)
        place_on_top(worker, task);
    else
        worker->next = task;
}

struct queue_rank task_rank(const struct task *task)
{
    return (struct queue_rank){.priority = task->priority, .path = task_path(task)};
}
