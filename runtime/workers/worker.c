/* A worker owns its queue, its scheduler's state and its counters; others reach it through its
 * inbox and its park only. One turn of its loop: it finds a task in its own queue, the shared one,
 * or that of a victim named by the scheduler. It runs the task and those inline after it, and looks
 * for messages in between. Without a task it idles (idle.c). */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/base/report.h"
#include "runtime/workers/internal.h"

#include <stdio.h>
#include <stdlib.h>

/* The clock is read before one in so many inline tasks. */
enum { CLOCKED = 16 };

/* Tries of a scheduler that names victims, in one round. */
enum { MAX_ATTEMPTS = 64, MAX_ATTEMPTS_A_WORKER = 16 };

/* ---- Find ---- */

bool work_is_endless(struct work_pool *pool, unsigned attempt)
{
    if (attempt < MAX_ATTEMPTS + MAX_ATTEMPTS_A_WORKER * pool->setup.threads)
        return false;
    atomic_store_explicit(&pool->endless, 1, memory_order_relaxed);
    return true;
}

static void steal_count(struct worker *worker, unsigned victim)
{
    const struct work_near *near = &worker->pool->near;
    queue_bump(&worker->counts.stolen, 1);
    queue_bump(&worker->counts.far, work_near_is_far(near, worker->index, victim));
    trace_mark(worker->ring, TRACE_STEAL, victim, 0);
}

/* Takes a task from its own queue, the shared one, or a victim's; NULL: none. */
static struct task *worker_find(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    base_mark_begin(worker->mark, BASE_SCHEDULER_SERVE);
    duite_end end = pool->setup.scheduler->serve(worker->state);
    base_mark_end(worker->mark);
    struct queue *queue = &worker->queue;
    struct task *task = queue_take(queue, end);
    if (!task)
        task = queue_take_shared(queue = &pool->queues.shared, end);
    for (unsigned attempt = 0; !task; attempt++) {
        unsigned victim = work_victim(worker, attempt);
        if (victim >= pool->setup.threads || work_is_endless(pool, attempt))
            break;
        if (victim == worker->index)
            continue;
        task = queue_steal(queue = &pool->queues.worker[victim].queue, &worker->queue);
        if (task)
            steal_count(worker, victim);
    }
    worker->left_some = task && queue_ranks(queue);
    return task;
}

/* ---- Run ---- */

bool work_poll(struct worker *worker)
{
    struct comm *comm = worker->pool->setup.comm;
    return comm && comm_poll(comm, worker);
}

bool work_has_no_other(const struct worker *worker)
{
    return worker->index && !worker->waits && queue_is_empty(&worker->queue) &&
           queue_is_empty(&worker->pool->queues.shared);
}

/* The start of the next inline task. Reading the clock costs as much as all else between two short
 * tasks, so the last measured gap is mostly used again. */
uint64_t work_inline_start(struct worker *worker, unsigned length, uint64_t end)
{
    if (!worker->pool->setup.comm && length % CLOCKED)
        return end + worker->gap;
    uint64_t now = base_ticks();
    worker->gap = now - end;
    return now;
}

/* Runs the task's body and adds up its time; `own` is without the worker's other tasks, messages
 * and idling inside the body. Returns the end. The task is not finished yet. */
static uint64_t run_body(struct worker *worker, struct task *task, uint64_t start, bool inlined)
{
    struct work_pool *pool = worker->pool;
    uint64_t outer = worker->within;
    worker->within = 0;
    const struct task *below = work_enters(worker, task_has_body(task) ? task : NULL);
    bool body = work_run_task(pool->setup.graph, worker, task, &worker->call);
    work_leaves(worker, below);
    uint64_t end = base_ticks(), took = end > start ? end - start : 0;
    uint64_t own = took > worker->within ? took - worker->within : 0;
    work_set_affinity(worker, task, took);
    if (worker->ring)
        work_note_task(worker, task, &(struct work_ran){start, took, took - own, body, inlined});
    worker->within = outer + took;
    queue_bump(&worker->counts.tasks, body);
    queue_bump(&worker->counts.busy, body ? own : 0);
    if (pool->balance && body)
        work_learn(worker, task, own);
    return end;
}

/* Finishes the task, which makes others ready: one of them may be the worker's next. */
static void run_finish(struct worker *worker, struct task *task, unsigned length)
{
    struct work_pool *pool = worker->pool;
    worker->finishing = true;
    worker->may_chain = work_goes_on(worker, length);
    if (task_to_send(task))
        comm_send(pool->setup.comm, task->send);
    else
        work_finish(pool->setup.graph, worker, task);
    worker->finishing = false;
    worker->may_chain = false;
}

/* Between two tasks, now and then: messages, and grants to ranks that request tasks. */
static void run_poll(struct worker *worker, struct comm *comm, uint64_t now)
{
    if (!comm_posted(comm) && now - worker->polled <= worker->pool->poll_ticks)
        return;
    worker->polled = now;
    work_poll(worker);
    if (worker->pool->balance)
        work_grant(worker);
}

/* Runs the task and those inline after it; *length counts them. Returns the task that runs inline
 * next in another loop, or NULL. */
static struct task *run_any(struct worker *worker, struct task *task, unsigned *length)
{
    struct work_pool *pool = worker->pool;
    struct comm *comm = pool->setup.comm;
    uint64_t start = base_ticks();
    for (;; ++*length) {
        if (pool->balance && work_begins(worker, task))
            start = base_ticks();
        uint64_t end = run_body(worker, task, start, *length > 1);
        run_finish(worker, task, *length);
        if (comm)
            run_poll(worker, comm, end);
        task = work_take_next(worker);
        const bool wrote = worker->ring && work_note_relieve(worker);
        if (!task || work_is_plain_node(worker, task) || work_is_plain_body(worker, task))
            return task;
        start = wrote ? base_ticks() : work_inline_start(worker, *length, end);
    }
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
        if (work_is_plain_body(worker, task))
            task = work_run_bodies(worker, task, &length);
        else if (work_is_plain_node(worker, task))
            task = work_run_nodes(worker, task, &length);
        else
            task = run_any(worker, task, &length);
    }
    running = NULL;
}

/* ---- The loop ---- */

struct task *work_find(struct worker *worker)
{
    return worker_find(worker);
}

void work_look(struct worker *worker, const struct work_wish *wish)
{
    struct task *task = worker_find(worker);
    if (task) {
        work_busy_again(worker);
        work_run(worker, task);
    } else if (work_poll(worker)) {
        work_stir(worker);
    } else {
        work_idle(worker, wish);
    }
}

void *work_thread(void *argument)
{
    struct worker *worker = argument;
    struct work_pool *pool = worker->pool;
    work_cores_bind(worker->unit);
    worker->stack = base_stack_here();
    while (!atomic_load_explicit(&pool->stop, memory_order_acquire))
        work_look(worker, &(struct work_wish){0});
    base_pool_thread_end();
    return NULL;
}
