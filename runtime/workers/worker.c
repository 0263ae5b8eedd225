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

/* ---- Ready: a task goes to a queue ---- */

static duite_ready ready_describe(const struct task_graph *graph, const struct task *task)
{
    const char *name = task_has_body(task) ? graph->kernels[task->kernel]->name
                                           : task_own_name(task_own_number(task));
    return (duite_ready){.kernel = name,
                         .number = task->number,
                         .block = task->block,
                         .priority = task->priority,
                         .cost = task->cost,
                         .path = task_path(task),
                         .affinity = plan_task_affinity(task)};
}

__attribute__((noinline)) static void ready_put(struct worker *worker, struct task *task,
                                                unsigned queue)
{
    struct work_pool *pool = worker->pool;
    work_bump(&worker->counts.placed, 1);
    /* Forks of the main program go to the inbox, where others take all at once. That costs both
     * sides less than a deque that one fills while the other empties it. A body mostly waits for
     * its forks itself. */
    if (queue == worker->index && (worker->finishing || work_in_body(worker)))
        work_queue_push(&worker->queue, task);
    else if (queue < pool->setup.threads)
        work_queue_put(&pool->worker[queue].queue, task);
    else
        work_queue_put(&pool->shared, task);
    work_wake_one(pool, queue);
}

/* The queue that the scheduler names. */
static unsigned ready_place(const struct worker *worker, const duite_ready *ready)
{
    base_mark_begin(worker->mark, BASE_SCHEDULER_PLACE);
    const unsigned queue = worker->pool->setup.scheduler->place(worker->state, ready);
    base_mark_end(worker->mark);
    return queue;
}

/* True if the scheduler wants the task inline after the one that made it ready. */
static bool ready_runs_inline(const struct worker *worker, const duite_ready *ready)
{
    base_mark_begin(worker->mark, BASE_SCHEDULER_CHAIN);
    const int is_inline = worker->pool->setup.scheduler->chain(worker->state, ready);
    base_mark_end(worker->mark);
    return is_inline;
}

/* True if the scheduler need not be asked: the task stays. */
static bool ready_stays(const struct worker *worker, const struct task *task)
{
    return worker->pool->by_affinity && work_keeps(worker, task);
}

/* True if no body waits, or the task may run on top of it. */
static inline bool ready_fits(const struct worker *worker, const struct task *task)
{
    return !worker->waits || task->scope == worker->waits ||
           (work_nests_freely(worker) && task_may_run_other(worker->waits, task));
}

/* Apart from the rest, since most tasks stay and need no description. */
__attribute__((noinline)) static void ready_ask(struct worker *worker, struct task *task,
                                                bool may_run)
{
    const duite_ready ready = ready_describe(worker->pool->setup.graph, task);
    if (may_run && ready_runs_inline(worker, &ready) && ready_fits(worker, task))
        worker->next = task;
    else
        ready_put(worker, task, ready_place(worker, &ready));
}

/* Returns whether the task went to another rank. */
static bool ready_goes_away(struct worker *worker, struct task *task)
{
    if (task->type == TASK_OFFLOADED)
        work_offloaded_came(worker->pool->balance, task);
    return work_placed_away(worker, task);
}

/* True if no policy is asked where the task goes, as for most. */
static inline bool ready_is_straight(const struct work_pool *pool, const struct task *task)
{
    return task->type == TASK_BODY && task->state == TASK_LOCAL && pool->by_affinity &&
           !pool->balance;
}

__attribute__((noinline)) static void ready_any(struct work_pool *pool, struct worker *worker,
                                                struct task *task)
{
    if (task_to_send(task)) {
        comm_send(pool->setup.comm, task->send);
        return;
    }
    if (task_is_channel(task)) {
        comm_channel_ready(pool->setup.comm, worker, task->node->channel);
        return;
    }
    if (pool->balance && ready_goes_away(worker, task))
        return;
    const bool may_run = worker->may_chain && !worker->next;
    if (!ready_stays(worker, task))
        ready_ask(worker, task, may_run);
    else if (may_run && ready_fits(worker, task))
        worker->next = task;
    else
        ready_put(worker, task, worker->index);
}

/* A body waits below: the task goes to a queue if it may not run on top. */
__attribute__((noinline)) static void ready_on_top(struct worker *worker, struct task *task)
{
    if (ready_fits(worker, task))
        worker->next = task;
    else
        ready_put(worker, task, worker->index);
}

/* All calls are tail calls: for most tasks, which become next, no register is saved. */
void work_ready(struct work_pool *pool, struct worker *worker, struct task *task)
{
    if (!ready_is_straight(pool, task))
        ready_any(pool, worker, task);
    else if (!worker->may_chain || worker->next)
        ready_put(worker, task, worker->index);
    else if (worker->waits)
        ready_on_top(worker, task);
    else
        worker->next = task;
}

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
    work_bump(&worker->counts.stolen, 1);
    work_bump(&worker->counts.far, work_near_is_far(near, worker->index, victim));
    trace_mark(worker->ring, TRACE_STEAL, victim, 0);
}

/* Takes a task from its own queue, the shared one, or a victim's; NULL: none. */
static struct task *worker_find(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    base_mark_begin(worker->mark, BASE_SCHEDULER_SERVE);
    duite_end end = pool->setup.scheduler->serve(worker->state);
    base_mark_end(worker->mark);
    struct work_queue *queue = &worker->queue;
    struct task *task = work_queue_take(queue, end);
    if (!task)
        task = work_queue_take_shared(queue = &pool->shared, end);
    for (unsigned attempt = 0; !task; attempt++) {
        unsigned victim = work_victim(worker, attempt);
        if (victim >= pool->setup.threads || work_is_endless(pool, attempt))
            break;
        if (victim == worker->index)
            continue;
        task = work_queue_steal(queue = &pool->worker[victim].queue, &worker->queue);
        if (task)
            steal_count(worker, victim);
    }
    worker->left_some = task && work_queue_ranks(queue);
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
    return worker->index && !worker->waits && work_queue_is_empty(&worker->queue) &&
           work_queue_is_empty(&worker->pool->shared);
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
    work_bump(&worker->counts.tasks, body);
    work_bump(&worker->counts.busy, body ? own : 0);
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
        work_wake_one(worker->pool, DUITE_NO_QUEUE);
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
