/* The main thread is worker 0: it works while the main program waits, is throttled, or forks.
 *
 * It waits for tasks to be over. Each worker counts its own on its own cache lines, and who wants
 * to know adds them up: so a task costs no line that workers share. While the main thread sleeps,
 * it has said how many tasks it forked (`awaited`), and, while it is throttled, how many may be
 * left
 * (`wanted`). A worker wakes it that runs out of work and finds one of these reached; if it is
 * throttled, also one that does so at the end of a task. */
#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

#include <stdlib.h>

/* ---- Tasks that are over ---- */

/* Never more than there are: what is waited for beside the forked tasks is counted in `more` before
 * it can be over, and here it is the ends that are looked at first. */
static uint64_t tasks_over(const struct work_pool *pool)
{
    uint64_t sum = 0;
    for (unsigned i = 0; i < pool->setup.threads; i++)
        sum += atomic_load_explicit(&pool->worker[i].counts.over, memory_order_acquire);
    for (unsigned i = 0; i < pool->setup.threads; i++)
        sum -= atomic_load_explicit(&pool->worker[i].counts.more, memory_order_acquire);
    return sum;
}

uint64_t work_unfinished(const struct work_pool *pool)
{
    return pool->setup.graph->tasks - tasks_over(pool);
}

/* Whether the main thread waits, and for no more than is over. */
static bool main_has_enough(const struct work_pool *pool)
{
    uint64_t awaited = atomic_load_explicit(&pool->awaited, memory_order_relaxed);
    uint64_t wanted = atomic_load_explicit(&pool->wanted, memory_order_relaxed);
    return awaited && awaited - tasks_over(pool) < (wanted ? wanted : 1);
}

void work_over(struct work_pool *pool, struct worker *worker, int tasks)
{
    _Atomic uint64_t *count = tasks < 0 ? &worker->counts.more : &worker->counts.over;
    uint64_t before = atomic_load_explicit(count, memory_order_relaxed);
    atomic_store_explicit(count, before + (uint64_t)abs(tasks), memory_order_release);
    if (atomic_load_explicit(&pool->wanted, memory_order_relaxed) && main_has_enough(pool))
        work_notify(pool);
}

void work_ran_out(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    if (!worker->index)
        return;
    /* Against the main thread, which says what it waits for and then adds up. */
    atomic_thread_fence(memory_order_seq_cst);
    if (main_has_enough(pool) || task_has_given_up(pool->setup.graph))
        work_notify(pool);
}

/* ---- Waiting ---- */

void work_drain(struct work_pool *pool, bool (*done)(void *), void *context)
{
    const struct work_wish wish = {.done = done, .context = context};
    atomic_store(&pool->awaited, pool->setup.graph->tasks);
    while (!done(context))
        work_look(&pool->worker[0], &wish);
    atomic_store_explicit(&pool->awaited, 0, memory_order_relaxed);
    work_busy_again(&pool->worker[0]);
}

struct main_until {
    bool (*done)(void *context);
    void *context;
    struct comm *comm;
};

static bool main_is_done(void *context)
{
    const struct main_until *until = context;
    return until->done(until->context) || (until->comm && comm_broken(until->comm));
}

void work_until(struct work_pool *pool, const struct work_why *why, bool (*done)(void *),
                void *context)
{
    struct main_until until = {done, context, pool->setup.comm};
    if (until.comm && comm_posted(until.comm))
        work_poll(&pool->worker[0]);
    work_waits(pool, why);
    work_drain(pool, main_is_done, &until);
    work_waits(pool, NULL);
}

static bool window_has_room(void *context)
{
    const struct work_pool *pool = context;
    return work_unfinished(pool) < atomic_load_explicit(&pool->wanted, memory_order_relaxed);
}

void work_throttle(struct work_pool *pool, uint64_t max)
{
    const struct task_graph *graph = pool->setup.graph;
    if (graph->tasks < pool->look)
        return;
    uint64_t left = work_unfinished(pool);
    if (left > max) {
        atomic_store(&pool->wanted, max - max / 4 + 1);
        work_until(pool, &(struct work_why){"duite_fork", "room in its window", NULL},
                   window_has_room, pool);
        atomic_store(&pool->wanted, 0);
        left = work_unfinished(pool);
    }
    /* There cannot be more than `max` before so many are added. */
    pool->look = graph->tasks + (left < max ? max - left : 0) + 1;
}

/* ---- Calls that do not wait ---- */

void work_once(struct work_pool *pool)
{
    work_look(&pool->worker[0], &(struct work_wish){.unheard = true});
}

void work_idle_ends(struct work_pool *pool)
{
    work_busy_again(&pool->worker[0]);
}

void work_tick(struct work_pool *pool)
{
    struct worker *worker = &pool->worker[0];
    struct comm *comm = pool->setup.comm;
    if (!comm)
        return;
    uint64_t now = base_ticks();
    if (!comm_posted(comm) && now - worker->polled < pool->poll_ticks)
        return;
    worker->polled = now;
    work_poll(worker);
    if (pool->balance)
        work_serve(worker);
}

struct worker *work_main(struct work_pool *pool)
{
    return &pool->worker[0];
}

bool work_may_fork(struct work_pool *pool)
{
    return pthread_equal(pthread_self(), pool->main) && !task_running(pool->setup.graph);
}
