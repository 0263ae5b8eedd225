/* A worker owns its queue, its scheduler's state and its counters; others reach it through its
 * inbox and its park only. One turn of its loop: it finds a task in its own queue, the shared one,
 * or that of a victim named by the scheduler. It runs the task and those inline after it, and looks
 * for messages in between. Without a task it idles (idle.c). */
#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/workers/internal.h"

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

void work_count_stolen(struct worker *worker, unsigned victim)
{
    const struct work_near *near = &worker->pool->near;
    queue_bump(&worker->counts.stolen, 1);
    queue_bump(&worker->counts.far, work_near_is_far(near, worker->index, victim));
    trace_mark(worker->ring, TRACE_STEAL, victim, 0);
}

struct task *work_find(struct worker *worker)
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
            work_count_stolen(worker, victim);
    }
    worker->left_some = task && queue_ranks(queue);
    return task;
}

/* ---- The loop ---- */

bool work_poll(struct worker *worker)
{
    const struct work_setup *setup = &worker->pool->setup;
    struct comm_guests *guests = &setup->graph->guests;
    const bool any = comm_guests_are_here(guests) && comm_guests_poll(guests, worker);
    return (setup->comm && comm_poll(setup->comm, worker)) || any;
}

void work_look(struct worker *worker, const struct work_wish *wish)
{
    if (comm_guests_are_here(&worker->pool->setup.graph->guests))
        work_serve(worker, base_ticks());
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
