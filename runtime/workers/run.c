/* Runs tasks one after another: call the body, look at the clock, finish, which makes others ready,
 * and take the next. These steps stand here once, in run_in_turn; constants make its forms. A task
 * is the worker's alone until it is finished. The counters of tasks are exact after each task, the
 * time in bodies after each batch. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/task/call.h"
#include "runtime/workers/internal.h"

#include <stdio.h>
#include <stdlib.h>

/* On one rank without a trace most tasks need few of the steps that others need: their calls are
 * direct, with one frame for all, and the clock is read once a batch. */
enum run_form {
    RUN_ANY,  /* any task; after each: trace, balancer, messages */
    RUN_BODY, /* forked tasks with bodies; while they are brief, a few more from the queue */
    RUN_NODE, /* nodes of a replay with bodies: they own no versions and no memory */
    RUN_CHILD /* as RUN_BODY, for children of the body that waits on this worker, on top of it:
                 their time counts as that body's, so the clock is not read */
};

enum {
    LONGEST_INLINE = 64, /* inline tasks between two looks at the queues */
    CLOCKED = 16,        /* inline tasks between two looks at the clock where a batch begins */
    BODIES = 16,         /* tasks of a batch, */
    NODES = 4,           /* and nodes: so few that together they may still leave no affinity */
    IN_TURN = 16         /* tasks from the queue before the worker looks around again */
};

/* ---- Batches ---- */

static inline unsigned *batch_brief(struct worker *worker, enum run_form form)
{
    return form == RUN_NODE ? &worker->brief_nodes : &worker->brief_bodies;
}

static inline void batch_begin(struct worker *worker, struct work_batch *batch, uint64_t start)
{
    batch->start = start;
    batch->outer = worker->within;
    worker->within = 0;
}

void work_batch_end(struct worker *worker, struct work_batch *batch)
{
    const uint64_t end = base_ticks();
    const uint64_t outside = worker->within + (batch->tasks - 1) * worker->gap;
    batch->took = end > batch->start ? end - batch->start : 0;
    batch->own = batch->took > outside ? batch->took - outside : 0;
    if (batch->brief) {
        *batch->brief =
            batch->took < batch->limit * batch->tasks ? *batch->brief + batch->tasks : 0;
        queue_bump(&worker->counts.busy, batch->own);
    }
    worker->within = batch->outer + batch->took;
    batch->start = end;
    batch->tasks = 0;
}

/* The start of the next inline task, if the last one ended at `end`. Reading the clock costs as
 * much as all else between two short tasks, so the last measured gap is mostly used again. */
static uint64_t batch_next_start(struct worker *worker, unsigned length, uint64_t end)
{
    if (!worker->pool->setup.comm && length % CLOCKED)
        return end + worker->gap;
    uint64_t now = base_ticks();
    worker->gap = now - end;
    return now;
}

/* ---- Any task ---- */

/* The task ran, and is a batch of its own. */
static void any_clock(struct worker *worker, const struct task *task, struct work_batch *batch,
                      bool body, bool inlined)
{
    struct work_ran ran = {.start = batch->start, .body = body, .inlined = inlined};
    batch->tasks = 1;
    work_batch_end(worker, batch);
    ran.took = batch->took;
    ran.within = batch->took - batch->own;
    work_set_affinity(worker, task, batch->took);
    if (worker->ring)
        work_note_task(worker, task, &ran);
    if (!body)
        return;
    queue_bump(&worker->counts.busy, batch->own);
    if (worker->pool->balance)
        work_learn(worker, task, batch->own);
}

static void any_finish(struct worker *worker, struct task *task)
{
    const struct work_setup *setup = &worker->pool->setup;
    if (task_to_send(task))
        comm_send(setup->comm, task->send);
    else
        work_finish(setup->graph, worker, task);
}

/* Between two tasks: now and then messages, and grants to ranks that request tasks; the trace goes
 * to its file if its ring is full. Returns whether that took time beside the messages. */
static bool any_between(struct worker *worker, uint64_t now)
{
    if (worker->pool->setup.comm)
        work_serve(worker, now);
    return worker->ring && work_note_relieve(worker);
}

/* ---- The next task ---- */

/* True if the worker may run the task in this form. Nodes of a replay do not follow one another on
 * top of a body that waits, so the last node was asked. */
static inline bool run_fits(const struct worker *worker, const struct task *task,
                            enum run_form form)
{
    const struct work_pool *pool = worker->pool;
    const bool local = task->state == TASK_LOCAL, node = local && task->type == TASK_NODE;
    const bool body = local && task->type == TASK_BODY && pool->plain;
    if (form != RUN_ANY)
        return form == RUN_NODE ? node : body;
    return !body && !(node && pool->plain_nodes && !worker->waits);
}

/* The next one of the worker's own queue, if it would take that. NULL: let it look around. */
static inline struct task *run_next_queued(struct worker *worker, unsigned in_turn)
{
    struct queue *queue = &worker->queue;
    if (in_turn > IN_TURN || worker->brief_bodies < BODIES || worker->waits ||
        !worker->pool->queues.by_affinity || queue_ranks(queue))
        return NULL;
    return queue_take(queue, DUITE_NEWEST);
}

/* The newest of the worker's own queue, if the body that waits forked it. */
static inline struct task *run_next_child(struct worker *worker)
{
    struct queue *queue = &worker->queue;
    struct task *task = queue_ranks(queue) ? NULL : queue_take(queue, DUITE_NEWEST);
    if (!task || task->scope == worker->waits)
        return task;
    queue_push(queue, task);
    queue_wake_one(&worker->pool->queues, DUITE_NO_QUEUE); /* it could not be found meanwhile */
    return NULL;
}

/* True if one more task may run inline after `length` of them. A chain goes on while the queues
 * have no other task, since another worker would need all its data. */
static inline bool run_goes_on(const struct worker *worker, unsigned length)
{
    return length % LONGEST_INLINE ||
           (worker->index && !worker->waits && queue_is_empty(&worker->queue) &&
            queue_is_empty(&worker->pool->queues.shared));
}

/* ---- The steps ---- */

#define STEP __attribute__((always_inline)) static inline

/* Returns whether the task's body ran. */
STEP bool run_call(struct task_graph *graph, struct worker *worker, struct task_frame *frame,
                   struct task *task, enum run_form form)
{
    const struct task *below =
        work_enters(worker, form != RUN_ANY || task_has_body(task) ? task : NULL);
    const bool body = form == RUN_ANY    ? work_run_task(graph, worker, task, &worker->call)
                      : form == RUN_NODE ? plan_node_run_body(frame, task)
                                         : task_run_body(frame, task);
    work_leaves(worker, below);
    queue_bump(&worker->counts.tasks, body);
    return body;
}

/* A batch ends when it is full, as long as tasks are not brief, and with each node where some have
 * an affinity. */
STEP void run_clock(struct worker *worker, const struct task *task, struct work_batch *batch,
                    enum run_form form)
{
    const unsigned most = form == RUN_NODE ? NODES : BODIES;
    const bool alone = ++batch->tasks == 1;
    if (batch->tasks != most && *batch_brief(worker, form) >= most &&
        !(form == RUN_NODE && plan_is_affine(task->node->plan)))
        return;
    work_batch_end(worker, batch);
    if (form == RUN_NODE && alone)
        work_set_affinity(worker, task, batch->took);
}

/* One of the tasks that become ready may be the worker's next. */
STEP void run_finish(struct task_graph *graph, struct worker *worker, struct task *task,
                     struct work_batch *batch, unsigned length, enum run_form form)
{
    worker->finishing = true;
    worker->may_chain = run_goes_on(worker, length);
    if (form == RUN_ANY)
        any_finish(worker, task);
    else if (form != RUN_NODE)
        task_finish(graph, worker, task);
    else if (worker->awaits.on && worker->may_chain && queue_is_empty(&worker->queue))
        work_count_down_awaiting(worker, task, batch);
    else
        plan_node_count_down(graph, worker, task, work_node_ready, NULL);
    worker->finishing = false;
    worker->may_chain = false;
}

STEP struct task *run_next(struct worker *worker, unsigned *length, unsigned *in_turn,
                           const struct work_wish *until, enum run_form form)
{
    struct task *task = work_take_next(worker);
    if (task || form == RUN_ANY || form == RUN_NODE)
        return task;
    if (form == RUN_BODY)
        task = run_next_queued(worker, (*in_turn)++);
    else if (!until->done(until->context))
        task = run_next_child(worker);
    if (task)
        *length = 0;
    return task;
}

/* Runs the task and those of its form that come next; *length counts inline tasks in turn. Returns
 * the task of another form that comes next, or NULL. */
STEP struct task *run_in_turn(struct worker *worker, struct task *task, unsigned *length,
                              const struct work_wish *until, enum run_form form)
{
    const struct work_pool *pool = worker->pool;
    const bool any = form == RUN_ANY, timed = form != RUN_CHILD;
    struct work_batch batch = {.start = timed ? base_ticks() : 0,
                               .limit = form == RUN_NODE ? pool->affinity_ticks / NODES
                                                         : pool->brief_ticks,
                               .brief = any ? NULL : batch_brief(worker, form)};
    struct task_graph *graph = pool->setup.graph;
    struct task_frame frame;
    if (!any)
        task_frame_init(&frame, graph, worker, &worker->call);
    for (unsigned in_turn = 1;; ++*length) {
        if (any && pool->balance && work_begins(worker, task))
            batch.start = base_ticks();
        if (timed && !batch.tasks)
            batch_begin(worker, &batch, batch.start);
        const bool body = run_call(graph, worker, &frame, task, form);
        if (any)
            any_clock(worker, task, &batch, body, *length > 1);
        else if (timed)
            run_clock(worker, task, &batch, form);
        run_finish(graph, worker, task, &batch, *length, form);
        const bool late = any && any_between(worker, batch.start);
        task = run_next(worker, length, &in_turn, until, form);
        if (!task || !run_fits(worker, task, form))
            break;
        if (timed && !batch.tasks)
            batch.start = late ? base_ticks() : batch_next_start(worker, *length, batch.start);
    }
    if (timed && batch.tasks)
        work_batch_end(worker, &batch);
    return task;
}

/* ---- The forms ---- */

__attribute__((noinline)) static struct task *run_any(struct worker *worker, struct task *task,
                                                      unsigned *length)
{
    return run_in_turn(worker, task, length, NULL, RUN_ANY);
}

__attribute__((noinline)) static struct task *run_bodies(struct worker *worker, struct task *task,
                                                         unsigned *length)
{
    return run_in_turn(worker, task, length, NULL, RUN_BODY);
}

__attribute__((noinline)) static struct task *run_nodes(struct worker *worker, struct task *task,
                                                        unsigned *length)
{
    task = run_in_turn(worker, task, length, NULL, RUN_NODE);
    if (!task)
        work_may_await(worker);
    return task;
}

/* A C++ exception or the end of the thread left a function of the program, and this loop with it.
 * The task can neither be finished nor run again, and others would wait for it for ever. */
static void run_is_left(struct worker *const *running)
{
    char text[512];
    if (!*running)
        return;
    const struct task_graph *graph = (*running)->pool->setup.graph;
    const struct task *task = atomic_load_explicit(&(*running)->runs, memory_order_relaxed);
    snprintf(text, sizeof text,
             "duite: %s%s was left by a C++ exception or the end of its thread (rank %d, worker "
             "%u); it has to return, and this process ends\n",
             task ? "the body of kernel " : "a law or a policy",
             task ? graph->kernels[task->kernel]->name : "", graph->rank, (*running)->index);
    base_report(text);
    abort();
}

void work_run(struct worker *worker, struct task *task)
{
    __attribute__((cleanup(run_is_left))) struct worker *running = worker;
    if (worker->left_some) {
        atomic_thread_fence(memory_order_seq_cst);
        queue_wake_one(&worker->pool->queues, DUITE_NO_QUEUE);
    }
    worker->left_some = false;
    for (unsigned length = 1; task; length++) {
        if (run_fits(worker, task, RUN_ANY))
            task = run_any(worker, task, &length);
        else if (task->type == TASK_NODE)
            task = run_nodes(worker, task, &length);
        else
            task = run_bodies(worker, task, &length);
    }
    running = NULL;
}

void work_run_children(struct worker *worker, bool (*done)(void *context), void *context)
{
    const struct work_wish until = {.done = done, .context = context};
    struct task *task = run_next_child(worker);
    unsigned length = 1;
    if (task && run_fits(worker, task, RUN_CHILD))
        task = run_in_turn(worker, task, &length, &until, RUN_CHILD);
    if (task)
        work_run(worker, task);
}
