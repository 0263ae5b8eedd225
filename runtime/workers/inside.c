/* A body that waits: its worker runs, on top of it, tasks that come before what the body does next,
 * and no others, so that nothing can wait for a body that is buried on a stack. (Of all that is not
 * over, take what comes first in the reference order: it waits for nothing. If it is a task, every
 * waiting worker may run it, or waits for its own descendants alone, which will be over without it.
 * If it is a body that waits, all above it on its stack would come even earlier: so it is on top,
 * and its descendants are over.) What a worker finds and may not run goes where others look. */
#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

#include <sched.h>
#include <time.h>

enum {
    NOT_BARREN = -1,
    SHARED_DEPTH = 16, /* of the shared queue's new end, that are looked at */
    MOST_REFUSED = 4   /* tasks taken from others in vain between two pauses */
};
#define LONGEST_PAUSE_SECONDS 2e-4

/* What a waiting worker knows. */
struct inside_wait {
    const struct task_scope *scope;
    unsigned refused; /* tasks taken from others in vain since the last pause */
    bool paused;      /* just now */
    int64_t barren;   /* the mark of its own queue when nothing in it might run, or NOT_BARREN */
};

/* The newest of a queue of this worker that may run; the others keep their places, and those who
 * did not find them meanwhile look again. */
static struct task *inside_dig(struct work_pool *pool, struct work_queue *queue,
                               const struct task_scope *scope, unsigned depth)
{
    struct task *aside = NULL, *task = NULL;
    bool hidden = false;
    while (depth-- && (task = work_queue_take(queue, DUITE_NEWEST)) && !task_may_run(scope, task)) {
        task->next = aside;
        aside = task;
        task = NULL;
        hidden = true;
    }
    while (aside) {
        struct task *next = aside->next;
        work_queue_push(queue, aside);
        aside = next;
    }
    if (hidden)
        work_wake_one(pool, DUITE_NO_QUEUE);
    return task;
}

/* The same of the shared queue, a few at its new end; and one at the old end, which goes to the
 * new one, so that all come by. */
static struct task *inside_dig_shared(struct work_pool *pool, const struct task_scope *scope)
{
    struct work_queue *queue = &pool->shared;
    struct task *task = NULL;
    if (atomic_flag_test_and_set_explicit(&queue->token, memory_order_acquire))
        return NULL;
    task = inside_dig(pool, queue, scope, SHARED_DEPTH);
    if (!task) {
        task = work_queue_take(queue, DUITE_OLDEST);
        if (task && !task_may_run(scope, task)) {
            work_queue_push(queue, task);
            task = NULL;
        }
    }
    atomic_flag_clear_explicit(&queue->token, memory_order_release);
    return task;
}

/* Takes from another; what may not run here is left where everybody looks. */
static struct task *inside_steal_from(struct worker *worker, unsigned victim,
                                      struct inside_wait *wait)
{
    struct work_pool *pool = worker->pool;
    if (victim == worker->index)
        return NULL;
    struct task *task = work_queue_steal(&pool->worker[victim].queue, &worker->queue);
    if (!task)
        return NULL;
    work_bump(&worker->counts.stolen, 1);
    trace_mark(worker->ring, TRACE_STEAL, victim, 0);
    if (task_may_run(wait->scope, task))
        return task;
    wait->refused++;
    work_queue_put(&pool->shared, task);
    work_wake_one(pool, DUITE_NO_QUEUE);
    return NULL;
}

/* Of the scheduler's victims; of all, when it has waited for long: what it waits for may lie with
 * one that waits for what lies here. */
static struct task *inside_steal(struct worker *worker, struct inside_wait *wait)
{
    struct work_pool *pool = worker->pool;
    struct task *task = NULL;
    for (unsigned attempt = 0; !task && wait->refused < MOST_REFUSED; attempt++) {
        unsigned victim = work_victim(worker, attempt);
        if (victim >= pool->setup.threads || work_is_endless(pool, attempt))
            break;
        task = inside_steal_from(worker, victim, wait);
    }
    for (unsigned i = 0; !task && wait->paused && i < pool->setup.threads; i++)
        task = inside_steal_from(worker, i, wait);
    wait->paused = false;
    return task;
}

/* Nothing to do for a moment. Nobody wakes a worker that waits in a body: it sleeps briefly. */
static void inside_idle(struct worker *worker, struct inside_wait *wait)
{
    const struct work_pool *pool = worker->pool;
    uint64_t now = base_ticks();
    if (!worker->idle_since)
        work_idles(worker, now);
    const bool crowded = work_is_crowded(worker, now);
    uint64_t since = now - worker->idle_since;
    if (since < pool->spin_ticks) {
        work_pause_core();
    } else if (since < pool->spin_ticks + pool->yield_ticks && !crowded) {
        sched_yield();
    } else {
        struct timespec pause = {.tv_nsec = (long)(1e9 * worker->pause)};
        nanosleep(&pause, NULL);
        worker->looked = base_ticks();
        if (worker->pause < LONGEST_PAUSE_SECONDS)
            worker->pause *= 2;
        wait->refused = 0;
        wait->paused = true;
    }
}

static struct task *inside_find(struct worker *worker, struct inside_wait *wait)
{
    struct work_pool *pool = worker->pool;
    struct task *task = NULL;
    if (wait->barren < 0 || wait->barren != work_queue_mark(&worker->queue)) {
        task = inside_dig(pool, &worker->queue, wait->scope, UINT32_MAX);
        wait->barren = task ? NOT_BARREN : work_queue_mark(&worker->queue);
    }
    if (!task)
        task = inside_dig_shared(pool, wait->scope);
    if (!task)
        task = inside_steal(worker, wait);
    worker->left_some =
        task && (work_queue_ranks(&worker->queue) || work_queue_ranks(&pool->shared));
    return task;
}

void work_inside(struct worker *worker, const struct task_scope *scope, bool (*done)(void *context),
                 void *context)
{
    const struct task_scope *outer = worker->waits;
    struct comm *comm = worker->pool->setup.comm;
    struct inside_wait wait = {.scope = scope, .barren = NOT_BARREN};
    worker->waits = scope;
    while (!done(context) && !(comm && comm_broken(comm))) {
        struct task *task = inside_find(worker, &wait);
        if (task) {
            work_busy_again(worker);
            work_run(worker, task);
            wait = (struct inside_wait){.scope = scope, .barren = NOT_BARREN};
        } else if (work_poll(worker)) {
            work_busy_again(worker);
        } else {
            inside_idle(worker, &wait);
        }
    }
    work_busy_again(worker);
    worker->waits = outer;
}
