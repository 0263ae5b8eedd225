/* Runs forked tasks one after another, as run_any of worker.c runs all kinds. A task is the
 * worker's alone until it is finished. The counters of tasks are exact after each task, the time in
 * bodies after each batch. */
#include "runtime/base/clock.h"
#include "runtime/task/call.h"
#include "runtime/workers/internal.h"

/* Tasks between two looks at the clock. */
enum { BATCH = 16 };

/* Tasks from the queue before the worker looks around again. */
enum { IN_TURN = 16 };

uint64_t work_batch_ends(struct worker *worker, struct work_batch *batch)
{
    const uint64_t end = base_ticks(), took = end > batch->start ? end - batch->start : 0;
    const uint64_t outside = worker->within + (batch->tasks - 1) * worker->gap;
    *batch->brief = took < batch->limit * batch->tasks ? *batch->brief + batch->tasks : 0;
    worker->within = 0;
    queue_bump(&worker->counts.busy, took > outside ? took - outside : 0);
    batch->start = end;
    batch->tasks = 0;
    return took;
}

/* Runs and finishes a task, which makes others ready. `batch` NULL: its time counts for a body
 * below. */
__attribute__((always_inline)) static inline void
bodies_run(struct worker *worker, struct task_frame *frame, struct task *task,
           struct work_batch *batch, unsigned length)
{
    const struct task *below = work_enters(worker, task);
    const bool body = task_run_body(frame, task);
    work_leaves(worker, below);
    queue_bump(&worker->counts.tasks, body);
    if (batch && (++batch->tasks == BATCH || worker->brief_bodies < BATCH))
        work_batch_ends(worker, batch);
    worker->finishing = true;
    worker->may_chain = work_goes_on(worker, length);
    task_finish(frame->body.graph, worker, task);
    worker->finishing = false;
    worker->may_chain = false;
}

/* Without an inline task: the next one of the worker's own queue, if it would take that. NULL: let
 * it look around. */
static inline struct task *bodies_take(struct worker *worker, unsigned in_turn)
{
    struct queue *queue = &worker->queue;
    if (in_turn > IN_TURN || worker->brief_bodies < BATCH || worker->waits ||
        !worker->pool->queues.by_affinity || queue_ranks(queue))
        return NULL;
    return queue_take(queue, DUITE_NEWEST);
}

struct task *work_run_bodies(struct worker *worker, struct task *task, unsigned *length)
{
    const uint64_t outer = worker->within, begin = base_ticks();
    struct work_batch batch = {
        .start = begin, .limit = worker->pool->brief_ticks, .brief = &worker->brief_bodies};
    struct task_frame frame;
    task_frame_init(&frame, worker->pool->setup.graph, worker, &worker->call);
    worker->within = 0;
    for (unsigned in_turn = 1;; ++*length) {
        bodies_run(worker, &frame, task, &batch, *length);
        task = work_take_next(worker);
        if (!task && (task = bodies_take(worker, in_turn++)))
            *length = 0;
        if (!task || !work_is_plain_body(worker, task))
            break;
        if (!batch.tasks)
            batch.start = work_inline_start(worker, *length, batch.start);
    }
    if (batch.tasks)
        work_batch_ends(worker, &batch);
    worker->within = outer + (batch.start - begin);
    return task;
}

/* The newest of the worker's own queue, if the body that waits forked it. */
static inline struct task *bodies_take_child(struct worker *worker)
{
    struct queue *queue = &worker->queue;
    struct task *task = queue_ranks(queue) ? NULL : queue_take(queue, DUITE_NEWEST);
    if (!task || task->scope == worker->waits)
        return task;
    queue_push(queue, task);
    queue_wake_one(&worker->pool->queues, DUITE_NO_QUEUE); /* it could not be found meanwhile */
    return NULL;
}

void work_run_children(struct worker *worker, bool (*done)(void *context), void *context)
{
    struct task *task = bodies_take_child(worker);
    struct task_frame frame;
    task_frame_init(&frame, worker->pool->setup.graph, worker, &worker->call);
    for (unsigned length = 1; task; length++) {
        if (!work_is_plain_body(worker, task)) {
            work_run(worker, task);
            return;
        }
        bodies_run(worker, &frame, task, NULL, length);
        task = work_take_next(worker);
        if (!task && !done(context))
            task = bodies_take_child(worker);
    }
}
