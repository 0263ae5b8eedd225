/* Waiting: a thread that waits works meanwhile.
 *
 * The main thread is worker 0. It works while the main program waits, is throttled, or forks, and
 * it waits for tasks to be over. Each worker counts its own tasks on its own cache lines, and
 * readers add them up: so a task costs no shared line. Before the main thread sleeps it says how
 * many tasks it forked (`awaited`) and, if throttled, how many may be left (`wanted`). A worker
 * that runs out of work wakes it if that is reached; if it is throttled, so does a worker that ends
 * a task.
 *
 * Only tasks that come before a waiting body's next step run on top of it: see below. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/workers/internal.h"

#include <sched.h>
#include <stdlib.h>
#include <time.h>

/* ---- Tasks that are over ---- */

uint64_t work_unfinished(const struct work_pool *pool)
{
    return pool->setup.graph->tasks - queue_all_over(&pool->queues);
}

bool work_is_drained(void *context)
{
    const struct work_pool *pool = context;
    /* A task in its own queue is not over: no need to read the others' counters. */
    return queue_is_empty(&pool->queues.worker[0].queue) && !work_unfinished(pool);
}

void work_ran_out(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    if (!worker->index)
        return;
    /* Pairs with the main thread, which says what it waits for and then adds up. */
    atomic_thread_fence(memory_order_seq_cst);
    if (queue_main_has_enough(&pool->queues) || task_has_given_up(pool->setup.graph))
        queue_notify(&pool->queues);
}

/* ---- Waiting ---- */

bool work_wish_is_true(const struct work_pool *pool, const struct work_wish *wish)
{
    struct comm *comm = wish->unheard ? NULL : pool->setup.comm;
    return wish->done && (wish->done(wish->context) || (comm && comm_is_broken(comm)));
}

static void main_drain(struct work_pool *pool, const struct work_wish *wish)
{
    atomic_store(&pool->queues.awaited, pool->setup.graph->tasks);
    while (!work_wish_is_true(pool, wish))
        work_look(&pool->queues.worker[0], wish);
    atomic_store_explicit(&pool->queues.awaited, 0, memory_order_relaxed);
    work_busy_again(&pool->queues.worker[0]);
}

void work_drain(struct work_pool *pool, bool (*done)(void *), void *context)
{
    main_drain(pool, &(struct work_wish){.done = done, .context = context, .unheard = true});
}

void work_until(struct work_pool *pool, const struct work_why *why, bool (*done)(void *),
                void *context)
{
    if (pool->setup.comm && comm_has_posts(pool->setup.comm))
        work_poll(&pool->queues.worker[0]);
    work_waits(pool, why);
    main_drain(pool, &(struct work_wish){.done = done, .context = context});
    work_waits(pool, NULL);
}

static bool window_has_room(void *context)
{
    const struct work_pool *pool = context;
    return work_unfinished(pool) < atomic_load_explicit(&pool->queues.wanted, memory_order_relaxed);
}

void work_throttle(struct work_pool *pool, uint64_t max)
{
    const struct task_graph *graph = pool->setup.graph;
    if (graph->tasks < pool->look)
        return;
    uint64_t left = work_unfinished(pool);
    if (left > max) {
        atomic_store(&pool->queues.wanted, max - max / 4 + 1);
        work_until(pool, &(struct work_why){"duite_fork", "room in its window", NULL},
                   window_has_room, pool);
        atomic_store(&pool->queues.wanted, 0);
        left = work_unfinished(pool);
    }
    /* More than `max` are possible only after so many more forks. */
    pool->look = graph->tasks + (left < max ? max - left : 0) + 1;
}

/* ---- Calls that do not wait ---- */

void work_serve(struct worker *worker, uint64_t now)
{
    const struct work_pool *pool = worker->pool;
    struct comm *comm = pool->setup.comm;
    if (now - worker->polled < pool->poll_ticks && !(comm && comm_has_posts(comm)))
        return;
    worker->polled = now;
    if (work_poll(worker))
        work_stir(worker); /* a task may have ended: the worker runs out anew (work_ran_out) */
    if (pool->balance)
        work_grant(worker);
}

void work_tick(struct work_pool *pool)
{
    if (pool->setup.comm)
        work_serve(&pool->queues.worker[0], base_ticks());
}

void work_turn(struct work_pool *pool)
{
    struct worker *worker = &pool->queues.worker[0];
    struct task *task = work_find(worker);
    if (task)
        work_run(worker, task);
    else
        work_poll(worker);
}

struct worker *work_main(struct work_pool *pool)
{
    return pool->queues.worker; /* the first; NULL after a start that failed */
}

bool work_may_fork(struct work_pool *pool)
{
    return pthread_equal(pthread_self(), pool->main) && !task_running(pool->setup.graph);
}

/* ---- A body that waits ---- */

/* A waiting body's worker runs on top of it only tasks that come before the body's next step. So
 * nothing can wait for ever for a body that is buried on a stack. Proof: take the first unfinished
 * task or body in the reference order. It waits for nothing. If it is a task, every waiting worker
 * may run it, or waits for its own descendants alone, which end without it. If it is a waiting
 * body, all bodies above it on its stack would come even earlier. Hence it is on top, and its
 * descendants are over. A task that a worker finds and may not run goes where others look.
 *
 * Nodes of an open replay whose tasks were never forked have the number of the next fork
 * (plan_node_renumber), and come before it and after the replay's last task. They wait only for
 * each other and for earlier tasks, and have no body. So they may run on top of any later body, and
 * the proof holds for them, too.
 *
 * On all ranks, offloaded tasks and their descendants wait only for one another. The proof holds
 * for them alone: their order spans all ranks, and a descendant of a waiting body may have come
 * from another rank. Local bodies may run any of them on top, as they never wait for local bodies;
 * offloaded bodies run no local task. */
enum {
    NOT_BARREN = -1,
    LOOKED_AT = 16, /* tasks of a queue's new end, if one may run: the earliest is taken */
    MAX_REFUSED = 4 /* tasks taken from others in vain between two pauses */
};
#define LONGEST_INSIDE_SECONDS 2e-4

/* A body on top may wait, too, and have further ones on top of it. To keep these few, children come
 * first, then the earliest other task at hand, which has most of its inputs. If more than
 * QUEUE_NESTED_FREELY bodies wait on a stack, it is the earliest of the whole own and shared
 * queues. That adds one level, and no more until a new task becomes ready. Children that wait for
 * children nest until the stack is full: the wait then is an error. */

/* The state of a waiting worker. */
struct inside_wait {
    const struct task_scope *scope;
    unsigned look;    /* at so many tasks of a queue, even after one that may run */
    unsigned refused; /* tasks taken from others in vain since the last pause */
    bool paused;      /* just now */
    int64_t barren;   /* mark of its own queue when no task in it might run, or NOT_BARREN */
};

/* The result of a look through a queue: the task to run, and those that go back, newest last. */
struct inside_look {
    const struct task_scope *scope;
    struct task *best;
    struct queue_link *aside;
    bool child; /* it is a descendant of the body */
};

/* Sorts in a task taken from the queue. */
static void inside_look_at(struct inside_look *look, struct task *task)
{
    struct task *other = task;
    if (task->scope == look->scope || task_descends(look->scope, task))
        look->child = true;
    else if (!task_may_run_other(look->scope, task) ||
             (look->best && task_is_earlier(look->best, task)))
        task = NULL;
    if (task) {
        other = look->best;
        look->best = task;
    }
    if (other) {
        other->link.next = look->aside;
        look->aside = &other->link;
    }
}

/* Looks from the new end at up to `most` tasks, at only wait->look if one of these may run; then at
 * the oldest. The others go back, and a worker is woken, since they could not be found
 * meanwhile. */
static struct task *inside_dig(struct work_pool *pool, struct queue *queue,
                               const struct inside_wait *wait, unsigned most)
{
    struct inside_look look = {.scope = wait->scope};
    struct task *task = NULL;
    for (unsigned i = 0; i < most && !look.child && !(look.best && i >= wait->look); i++) {
        if (!(task = queue_take(queue, DUITE_NEWEST)))
            break;
        inside_look_at(&look, task);
    }
    if (!look.child && (task = queue_take(queue, DUITE_OLDEST)))
        inside_look_at(&look, task);
    const bool hidden = look.aside;
    while (look.aside) {
        struct queue_link *next = look.aside->next;
        queue_push(queue, queue_task(look.aside));
        look.aside = next;
    }
    if (hidden)
        queue_wake_one(&pool->queues, DUITE_NO_QUEUE);
    return look.best;
}

/* The same for the shared queue: a few at its new end, and one at the old end, which goes back to
 * the new one, so that all come by. */
static struct task *inside_dig_shared(struct work_pool *pool, const struct inside_wait *wait)
{
    struct queue *queue = &pool->queues.shared;
    if (atomic_flag_test_and_set_explicit(&queue->token, memory_order_acquire))
        return NULL;
    struct task *task = inside_dig(pool, queue, wait, wait->look);
    atomic_flag_clear_explicit(&queue->token, memory_order_release);
    return task;
}

/* Takes from another worker; a task that may not run here goes to the shared queue. */
static struct task *inside_steal_from(struct worker *worker, unsigned victim,
                                      struct inside_wait *wait)
{
    struct work_pool *pool = worker->pool;
    if (victim == worker->index)
        return NULL;
    struct task *task = queue_steal(&pool->queues.worker[victim].queue, &worker->queue);
    if (!task)
        return NULL;
    work_count_stolen(worker, victim);
    if (task_may_run(wait->scope, task))
        return task;
    wait->refused++;
    queue_put(&pool->queues.shared, task);
    queue_wake_one(&pool->queues, DUITE_NO_QUEUE);
    return NULL;
}

/* Steals from the scheduler's victims; after a pause from all workers, as two waiting workers may
 * hold the tasks that each other needs. */
static struct task *inside_steal(struct worker *worker, struct inside_wait *wait)
{
    struct work_pool *pool = worker->pool;
    struct task *task = NULL;
    for (unsigned attempt = 0; !task && wait->refused < MAX_REFUSED; attempt++) {
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

/* Idles for a moment. A worker that waits in a body is never woken: it sleeps briefly. */
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
        if (worker->pause < LONGEST_INSIDE_SECONDS)
            worker->pause *= 2;
        wait->refused = 0;
        wait->paused = true;
    }
}

static struct task *inside_find(struct worker *worker, struct inside_wait *wait)
{
    struct work_pool *pool = worker->pool;
    struct task *task = NULL;
    if (wait->barren < 0 || wait->barren != queue_mark(&worker->queue)) {
        task = inside_dig(pool, &worker->queue, wait, UINT32_MAX);
        wait->barren = task ? NOT_BARREN : queue_mark(&worker->queue);
    }
    if (!task)
        task = inside_dig_shared(pool, wait);
    if (!task)
        task = inside_steal(worker, wait);
    worker->left_some = task && (queue_ranks(&worker->queue) || queue_ranks(&pool->queues.shared));
    return task;
}

/* The body waits for more than children in its worker's own queue. */
__attribute__((noinline)) static void inside_wait(struct worker *worker,
                                                  const struct task_scope *scope,
                                                  bool (*done)(void *context), void *context)
{
    struct comm *comm = worker->pool->setup.comm;
    const struct inside_wait begin = {.scope = scope,
                                      .barren = NOT_BARREN,
                                      .look = queue_nests_freely(worker) ? LOOKED_AT : UINT32_MAX};
    struct inside_wait wait = begin;
    while (!done(context) && !(comm && comm_is_broken(comm))) {
        struct task *task = inside_find(worker, &wait);
        if (task) {
            work_busy_again(worker);
            work_run(worker, task);
            wait = begin;
        } else if (work_poll(worker)) {
            work_busy_again(worker);
        } else {
            inside_idle(worker, &wait);
        }
    }
    work_busy_again(worker);
}

__attribute__((noinline, cold)) static int inside_is_full(const struct worker *worker)
{
    return base_error(
        DUITE_E_DEPTH,
        "%u bodies wait on top of one another on worker %u, and three quarters of its "
        "stack of %zu kB are used: nest tasks less deeply, or allow a larger stack "
        "(ulimit -s)",
        worker->nested, worker->index, worker->stack.bytes / 1024);
}

int work_inside(struct worker *worker, const struct task_scope *scope, bool (*done)(void *context),
                void *context)
{
    const struct task_scope *outer = worker->waits;
    if ((const char *)__builtin_frame_address(0) < worker->stack.floor)
        return inside_is_full(worker);
    worker->waits = scope;
    worker->nested++;
    if (worker->pool->plain && worker->pool->queues.by_affinity)
        work_run_children(worker, done, context);
    if (!done(context))
        inside_wait(worker, scope, done, context);
    worker->nested--;
    worker->waits = outer;
    return DUITE_OK;
}
