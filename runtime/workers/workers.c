/* A worker owns its queue, its scheduler's state and its counters; others reach it through its
 * inbox and its park only. */
#include "runtime/workers/workers.h"

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/pool.h"
#include "runtime/base/thread.h"
#include "runtime/sched/front.h"
#include "runtime/workers/cores.h"
#include "runtime/workers/internal.h"

#include <sched.h>
#include <stdio.h>
#include <string.h>

/* Tasks run one after another without a look at the queues while something lies there; and among
 * these, those before which the clock is read. */
enum { LONGEST_CHAIN = 64, CLOCKED = 16 };

/* Tries of a scheduler that names victims, in one round. */
enum { MOST_ATTEMPTS = 64, MOST_ATTEMPTS_A_WORKER = 16 };

/* Seconds between polls while there is work; while there is none, the longest pause. */
#define POLL_SECONDS          5e-6
#define LONGEST_PAUSE_SECONDS 1e-3

/* ---- Ready tasks ---- */

static duite_ready describe(const struct task_graph *graph, const struct task *task)
{
    const char *name =
        task_has_body(task) ? graph->kernels[task->kernel]->name : task_own_name(task->kind);
    return (duite_ready){.kernel = name,
                         .number = task->number,
                         .block = task->block,
                         .priority = task->priority,
                         .cost = task->cost,
                         .path = task_path(task),
                         .warm = plan_task_warm(task)};
}

void work_wake_one(struct work_pool *pool, unsigned queue)
{
    if (!atomic_load_explicit(&pool->parked, memory_order_seq_cst))
        return;
    unsigned n = pool->setup.threads, first = queue < n ? queue : 0;
    for (unsigned i = 0; i < n; i++)
        if (work_park_wake(&pool->worker[(first + i) % n].park))
            return;
}

static void place(struct worker *worker, struct task *task, const duite_ready *ready)
{
    struct work_pool *pool = worker->pool;
    unsigned queue = pool->setup.scheduler->place(worker->state, ready);
    work_bump(&worker->counts.placed, 1);
    /* What the main thread forks is left for others to take all at once, which costs both sides
     * less than a deque that one fills as the other empties it. */
    if (queue == worker->index && worker->finishing)
        work_queue_push(&worker->queue, task);
    else if (queue < pool->setup.threads)
        work_queue_put(&pool->worker[queue].queue, task);
    else
        work_queue_put(&pool->shared, task);
    work_wake_one(pool, queue);
}

/* Whether the task goes to another rank. */
static bool moves(struct worker *worker, struct task *task)
{
    if (task->kind == TASK_GUEST)
        work_guest_came(worker->pool->balance, task);
    return work_placed_away(worker, task);
}

void work_ready(struct work_pool *pool, struct worker *worker, struct task *task)
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
    if (pool->balance && moves(worker, task))
        return;
    duite_ready ready = describe(pool->setup.graph, task);
    if (worker->may_chain && !worker->next && pool->setup.scheduler->chain(worker->state, &ready) &&
        (!worker->waits || task_may_run(worker->waits, task)))
        worker->next = task;
    else
        place(worker, task, &ready);
}

void work_notify(struct work_pool *pool)
{
    if (!pool)
        return;
    atomic_thread_fence(memory_order_seq_cst);
    work_park_wake(&pool->worker[0].park);
}

/* ---- One worker's work ---- */

bool work_is_endless(struct work_pool *pool, unsigned attempt)
{
    if (attempt < MOST_ATTEMPTS + MOST_ATTEMPTS_A_WORKER * pool->setup.threads)
        return false;
    atomic_store_explicit(&pool->endless, 1, memory_order_relaxed);
    return true;
}

static void count_steal(struct worker *worker, unsigned victim)
{
    const struct work_near *near = &worker->pool->near;
    work_bump(&worker->counts.stolen, 1);
    work_bump(&worker->counts.far, work_near_is_far(near, worker->index, victim));
    trace_mark(worker->ring, TRACE_STEAL, victim, 0);
}

static struct task *find(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    const duite_scheduler *scheduler = pool->setup.scheduler;
    duite_end end = scheduler->serve(worker->state);
    struct work_queue *queue = &worker->queue;
    struct task *task = work_queue_take(queue, end);
    if (!task)
        task = work_queue_take_shared(queue = &pool->shared, end);
    for (unsigned attempt = 0; !task; attempt++) {
        unsigned victim = scheduler->victim(worker->state, attempt);
        if (victim >= pool->setup.threads || work_is_endless(pool, attempt))
            break;
        if (victim == worker->index)
            continue;
        task = work_queue_steal(queue = &pool->worker[victim].queue, &worker->queue);
        if (task)
            count_steal(worker, victim);
    }
    worker->left_some = task && work_queue_ranks(queue);
    return task;
}

/* A chain moved to another worker takes all its data along: it stays as long as this one has
 * nothing else to do. */
static bool may_chain(struct worker *worker, unsigned length)
{
    return length % LONGEST_CHAIN ||
           (worker->index && !worker->waits && work_queue_is_empty(&worker->queue) &&
            work_queue_is_empty(&worker->pool->shared));
}

/* When the chained task after this one begins: reading the clock costs as much as all else that
 * lies between two short tasks, so mostly that time is taken to be what it was before. */
static uint64_t next_start(struct worker *worker, unsigned length, uint64_t end)
{
    if (!worker->pool->setup.comm && length % CLOCKED)
        return end + worker->gap;
    uint64_t now = base_ticks();
    worker->gap = now - end;
    return now;
}

void work_run(struct worker *worker, struct task *task)
{
    struct work_pool *pool = worker->pool;
    struct task_graph *graph = pool->setup.graph;
    struct comm *comm = pool->setup.comm;
    if (worker->left_some) {
        atomic_thread_fence(memory_order_seq_cst);
        work_wake_one(pool, DUITE_NO_QUEUE);
    }
    worker->left_some = false;
    uint64_t start = base_ticks();
    for (unsigned length = 1; task; length++) {
        if (pool->balance && work_begins(worker, task))
            start = base_ticks();
        uint64_t outer = worker->within;
        worker->within = 0;
        const struct task *below = work_enters(worker, task);
        uint32_t kind = task->kind;
        bool body = task_run(graph, worker, task, &worker->call);
        work_leaves(worker, below);
        uint64_t end = base_ticks(), took = end > start ? end - start : 0;
        uint64_t own = took > worker->within ? took - worker->within : 0;
        work_warms(worker, task, took);
        if (worker->ring)
            work_note_task(worker, task,
                           &(struct work_ran){start, took, took - own, kind, body, length > 1});
        worker->within = outer + took;
        work_bump(&worker->counts.tasks, body);
        work_bump(&worker->counts.busy, body ? own : 0);
        if (pool->balance && body)
            work_learn(worker, task, own);
        worker->finishing = true;
        worker->may_chain = may_chain(worker, length);
        if (task_to_send(task))
            comm_send(comm, task);
        else
            task_finish(graph, worker, task);
        worker->finishing = false;
        worker->may_chain = false;
        if (comm && (comm_posted(comm) || end - worker->polled > pool->poll_ticks)) {
            worker->polled = end;
            work_poll(worker);
            if (pool->balance)
                work_serve(worker);
        }
        task = worker->next;
        worker->next = NULL;
        work_bump(&worker->counts.chained, task != NULL);
        bool wrote = worker->ring && work_note_relieve(worker);
        start = wrote ? base_ticks() : next_start(worker, length, end);
    }
}

/* ---- Idling ---- */

/* Among idle workers one keeps polling: it holds the seat until it gets busy. Returns whether that
 * is this one. */
static bool take_seat(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    if (pool->setup.comm && !worker->polls &&
        !atomic_load_explicit(&pool->seat, memory_order_relaxed))
        worker->polls = !atomic_exchange_explicit(&pool->seat, 1, memory_order_relaxed);
    return worker->polls;
}

void work_busy_again(struct worker *worker)
{
    work_stir(worker);
    if (!worker->polls)
        return;
    worker->polls = false;
    atomic_exchange_explicit(&worker->pool->seat, 0, memory_order_seq_cst);
    work_wake_one(worker->pool, DUITE_NO_QUEUE);
}

/* Sleeps until woken, or for so many seconds if they are > 0. Returns a task if there was one at
 * the last look; does not sleep if nobody polls. */
static struct task *doze(struct worker *worker, double seconds, const struct work_wish *wish)
{
    struct work_pool *pool = worker->pool;
    bool polled = worker->polls;
    atomic_fetch_add(&pool->parked, 1);
    work_park_announce(&worker->park);
    struct task *task = find(worker);
    if (task || atomic_load(&pool->stop) || (wish->done && wish->done(wish->context)) ||
        (!polled && take_seat(worker)))
        work_park_cancel(&worker->park);
    else
        work_park_sleep(&worker->park, seconds);
    worker->looked = base_ticks();
    atomic_fetch_sub(&pool->parked, 1);
    return task;
}

/* Nothing to do: one moment of idling. */
static void idle(struct worker *worker, const struct work_wish *wish)
{
    struct work_pool *pool = worker->pool;
    bool polls = take_seat(worker);
    if (polls && pool->balance && worker->idle_since)
        work_beg(worker, base_ticks() - worker->idle_since);
    if (work_spins(worker))
        return;
    struct task *task = doze(worker, polls || wish->unheard ? worker->pause : 0, wish);
    if (worker->pause < LONGEST_PAUSE_SECONDS)
        worker->pause *= 2;
    if (!task)
        return;
    work_busy_again(worker);
    work_run(worker, task);
}

void work_look(struct worker *worker, const struct work_wish *wish)
{
    struct task *task = find(worker);
    if (task) {
        work_busy_again(worker);
        work_run(worker, task);
    } else if (work_poll(worker)) {
        work_stir(worker);
    } else {
        idle(worker, wish);
    }
}

/* From now on this caller of the guard asks the worker's scheduler. */
static void be_caller(struct worker *worker, unsigned caller)
{
    const struct work_setup *setup = &worker->pool->setup;
    sched_front_state(setup->scheduler, worker->state, base_guard_caller(setup->guard, caller));
}

static void *thread_main(void *argument)
{
    struct worker *worker = argument;
    struct work_pool *pool = worker->pool;
    work_cores_bind(worker->unit);
    base_guard_here(base_guard_caller(pool->setup.guard, worker->index));
    be_caller(worker, worker->index);
    work_balance_caller(worker, worker->index);
    while (!atomic_load_explicit(&pool->stop, memory_order_acquire))
        work_look(worker, &(struct work_wish){0});
    base_pool_thread_end();
    return NULL;
}

/* ---- Start and stop ---- */

static bool prepare(struct work_pool *pool, unsigned index, int unit)
{
    const struct work_setup *setup = &pool->setup;
    struct worker *worker = &pool->worker[index];
    size_t lines = (setup->scheduler->state_size + BASE_LINE - 1) / BASE_LINE + 1;
    worker->pool = pool;
    worker->index = index;
    worker->unit = unit;
    worker->state = pool->states + index * lines * BASE_LINE;
    worker->ring = trace_ring(setup->trace, index);
    worker->pause = WORK_FIRST_PAUSE_SECONDS;
    worker->switches = -1;
    worker->call = (duite_call){
        .context = setup->context, .rt = setup->rt, .rank = setup->graph->rank, .worker = index};
    be_caller(worker, 0);
    if (setup->scheduler->start)
        setup->scheduler->start(worker->state, index, setup->threads, setup->seed);
    if (setup->scheduler->look)
        setup->scheduler->look(worker->state, work_near_of(&pool->near, index));
    bool queue = work_queue_start(&worker->queue);
    return work_park_start(&worker->park) && queue;
}

static int start_threads(struct work_pool *pool)
{
    sched_getaffinity(0, sizeof pool->worker[0].binding, &pool->worker[0].binding);
    for (pool->started = 1; pool->started < pool->setup.threads; pool->started++) {
        struct worker *worker = &pool->worker[pool->started];
        char what[64];
        snprintf(what, sizeof what, "worker thread %u of %u", pool->started, pool->setup.threads);
        const int code = base_thread_start(&worker->thread, what, thread_main, worker);
        if (code)
            return code;
    }
    work_cores_bind(pool->worker[0].unit);
    return DUITE_OK;
}

int work_start(struct work_pool **out, const struct work_setup *setup)
{
    unsigned n = setup->threads;
    size_t lines = (setup->scheduler->state_size + BASE_LINE - 1) / BASE_LINE + 1;
    struct work_pool *pool = *out = base_alloc_zero(sizeof *pool);
    if (!pool)
        return base_no_memory("the workers");
    pool->setup = *setup;
    pool->setup.cores = NULL; /* the caller's: copied to the workers */
    pool->main = pthread_self();
    pool->tick = base_tick_seconds();
    pool->poll_ticks = (uint64_t)(POLL_SECONDS / pool->tick);
    pool->spin_ticks = (uint64_t)(setup->spin_seconds / pool->tick);
    pool->yield_ticks = (uint64_t)(WORK_YIELD_SECONDS / pool->tick);
    pool->await_ticks = (uint64_t)(WORK_AWAIT_SECONDS / pool->tick);
    pool->worker = base_alloc_zero(n * sizeof pool->worker[0]);
    pool->states = base_alloc_zero(n * lines * BASE_LINE);
    setup->graph->paths = setup->scheduler->paths;
    bool fine = pool->worker && pool->states && work_near_start(&pool->near, n, setup->cores) &&
                work_queue_start(&pool->shared);
    for (unsigned i = 0; i < n && fine; i++)
        fine = prepare(pool, i, setup->cores ? setup->cores[i] : -1);
    if (fine)
        fine = !work_balance_start(&pool->balance, pool);
    setup->graph->pool = pool;
    setup->graph->checks = setup->check != NULL;
    if (setup->trace && setup->comm)
        comm_tell(setup->comm, work_note_message);
    int code = fine ? start_threads(pool) : base_no_memory("the workers");
    int watched = work_watch_start(pool, code ? 0 : setup->stuck_seconds);
    return code ? code : watched;
}

void work_stop(struct work_pool *pool)
{
    if (!pool)
        return;
    pool->setup.graph->pool = NULL; /* communication may break later still */
    atomic_store(&pool->stop, 1);
    work_watch_stop(pool);
    for (unsigned i = 1; i < pool->started; i++) {
        atomic_thread_fence(memory_order_seq_cst);
        work_park_wake(&pool->worker[i].park);
        pthread_join(pool->worker[i].thread, NULL);
    }
    if (pool->started && pool->worker[0].unit >= 0)
        sched_setaffinity(0, sizeof pool->worker[0].binding, &pool->worker[0].binding);
    for (unsigned i = 0; pool->worker && i < pool->setup.threads; i++) {
        work_queue_stop(&pool->worker[i].queue);
        if (pool->worker[i].pool)
            work_park_stop(&pool->worker[i].park);
    }
    work_queue_stop(&pool->shared);
    work_balance_stop(pool);
    work_near_stop(&pool->near);
    base_free(pool->worker);
    base_free(pool->states);
    base_free(pool);
}
