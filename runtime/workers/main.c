/* The main thread works too, while the main program waits, is throttled or forks: it is worker 0.
 */
#include "runtime/base/clock.h"
#include "runtime/workers/internal.h"

void work_drain(struct work_pool *pool, bool (*done)(void *), void *context)
{
    const struct work_wish wish = {.done = done, .context = context};
    atomic_store(&pool->awaited, pool->setup.graph->tasks);
    while (!done(context))
        work_look(&pool->worker[0], &wish);
    atomic_store_explicit(&pool->awaited, 0, memory_order_relaxed);
    work_busy_again(&pool->worker[0]);
}

struct until {
    bool (*done)(void *context);
    void *context;
    struct comm *comm;
};

static bool done_or_broken(void *context)
{
    const struct until *until = context;
    return until->done(until->context) || (until->comm && comm_broken(until->comm));
}

void work_until(struct work_pool *pool, const struct work_why *why, bool (*done)(void *),
                void *context)
{
    struct until until = {done, context, pool->setup.comm};
    if (until.comm && comm_posted(until.comm))
        work_poll(&pool->worker[0]);
    work_waits(pool, why);
    work_drain(pool, done_or_broken, &until);
    work_waits(pool, NULL);
}

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
