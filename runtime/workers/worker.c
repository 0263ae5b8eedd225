/* A worker owns its queue, its scheduler's state and its counters; others reach it through its
 * inbox and its park only. One turn of its loop: it finds a task in its own queue, the shared one,
 * or that of a victim named by the scheduler. It runs the task and those inline after it, and looks
 * for messages in between. Without a task it idles (idle.c). */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/workers/internal.h"

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
        comm_send(pool->setup.comm, task);
        return;
    }
    if (task_is_channel(task)) {
        const bool noted = work_note_messages_begin(worker);
        comm_channel_ready(pool->setup.comm, worker, task);
        work_note_messages_end(worker, noted);
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

struct task *work_find(struct worker *worker)
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

/* ---- The loop ---- */

bool work_poll(struct worker *worker)
{
    struct comm *comm = worker->pool->setup.comm;
    if (!comm)
        return false;
    const bool noted = work_note_messages_begin(worker), came = comm_poll(comm, worker);
    work_note_messages_end(worker, noted);
    return came;
}

void work_look(struct worker *worker, const struct work_wish *wish)
{
    struct task *task = work_find(worker);
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
