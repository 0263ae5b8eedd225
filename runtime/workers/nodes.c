/* Nodes of a replay, one after another, as work_run runs tasks: each makes others ready, of which
 * the first is the next. The counters of tasks are exact after each of them. The clock is read
 * after each node, until BATCH in turn are so short that all of them together would leave no
 * affinity; then once for BATCH, until these take longer. */
#include "runtime/base/clock.h"
#include "runtime/plan/node.h"
#include "runtime/workers/internal.h"

enum { BATCH = 4 };

/* Nodes since the clock was read. */
struct nodes_time {
    uint64_t start;
    unsigned nodes;
};

/* Reads the clock after a node, the last one of `time`; NULL: it may be gone. */
static void nodes_clock(struct worker *worker, const struct task *task, struct nodes_time *time)
{
    const uint64_t end = base_ticks(), took = end > time->start ? end - time->start : 0;
    const uint64_t outside = worker->within + (time->nodes - 1) * worker->gap;
    const bool brief = took < worker->pool->affinity_ticks / BATCH * time->nodes;
    if (task && time->nodes == 1)
        work_set_affinity(worker, task, took);
    worker->brief = brief ? worker->brief + time->nodes : 0;
    worker->within = 0;
    work_bump(&worker->counts.busy, took > outside ? took - outside : 0);
    *time = (struct nodes_time){.start = end};
}

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
                             struct nodes_time *time, unsigned length)
{
    const struct task *below = atomic_load_explicit(&worker->runs, memory_order_relaxed);
    const bool affine = plan_is_affine(task->node->plan);
    atomic_store_explicit(&worker->runs, task, memory_order_release);
    const bool body = plan_node_run_body(frame, task);
    work_leaves(worker, below);
    work_bump(&worker->counts.tasks, body);
    if (++time->nodes == BATCH || worker->brief < BATCH || affine)
        nodes_clock(worker, task, time);
    worker->finishing = true;
    worker->may_chain = work_goes_on(worker, length);
    plan_node_count_down(frame->body.graph, worker, task, nodes_ready);
    worker->finishing = false;
    worker->may_chain = false;
}

struct task *work_run_nodes(struct worker *worker, struct task *task, unsigned *length)
{
    const uint64_t outer = worker->within, begin = base_ticks();
    struct nodes_time time = {.start = begin};
    struct task_frame frame;
    task_frame_init(&frame, worker->pool->setup.graph, worker, &worker->call);
    worker->within = 0;
    for (;; ++*length) {
        nodes_run(worker, &frame, task, &time, *length);
        task = worker->next;
        worker->next = NULL;
        work_bump(&worker->counts.chained, task != NULL);
        if (!task || task->type != TASK_NODE)
            break;
        if (!time.nodes)
            time.start = work_inline_start(worker, *length, time.start);
    }
    if (time.nodes)
        nodes_clock(worker, NULL, &time);
    worker->within = outer + (time.start - begin);
    return task;
}
