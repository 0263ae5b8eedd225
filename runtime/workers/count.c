/* What workers count, above all how many tasks are over: each worker counts its own on its own
 * cache lines, and who wants to know adds them up. So a task costs no line that workers share.
 *
 * The main thread, which waits for tasks to be over, may sleep. It says how many it forked
 * (`awaited`), and, while it is throttled, how many may be left (`wanted`). It is woken by a
 * worker that runs out of work and finds one of these reached; and by one that does so at the end
 * of a task, if it is throttled. */
#include "runtime/workers/internal.h"

#include <stdlib.h>

/* Never more than there are: what is waited for beside the forked tasks is counted in `more` before
 * it can be over, and here it is the ends that are looked at first. */
static uint64_t over(const struct work_pool *pool)
{
    uint64_t sum = 0;
    for (unsigned i = 0; i < pool->setup.threads; i++)
        sum += atomic_load_explicit(&pool->worker[i].counts.over, memory_order_acquire);
    for (unsigned i = 0; i < pool->setup.threads; i++)
        sum -= atomic_load_explicit(&pool->worker[i].counts.more, memory_order_acquire);
    return sum;
}

/* Whether the main thread waits, and for no more than is over. */
static bool is_enough(const struct work_pool *pool)
{
    uint64_t awaited = atomic_load_explicit(&pool->awaited, memory_order_relaxed);
    uint64_t wanted = atomic_load_explicit(&pool->wanted, memory_order_relaxed);
    return awaited && awaited - over(pool) < (wanted ? wanted : 1);
}

void work_over(struct work_pool *pool, struct worker *worker, int tasks)
{
    _Atomic uint64_t *count = tasks < 0 ? &worker->counts.more : &worker->counts.over;
    uint64_t before = atomic_load_explicit(count, memory_order_relaxed);
    atomic_store_explicit(count, before + (uint64_t)abs(tasks), memory_order_release);
    if (atomic_load_explicit(&pool->wanted, memory_order_relaxed) && is_enough(pool))
        work_notify(pool);
}

void work_ran_out(struct worker *worker)
{
    struct work_pool *pool = worker->pool;
    if (!worker->index)
        return;
    /* Against the main thread, which says what it waits for and then adds up. */
    atomic_thread_fence(memory_order_seq_cst);
    if (is_enough(pool) || task_has_given_up(pool->setup.graph))
        work_notify(pool);
}

void work_idles(struct worker *worker, uint64_t now)
{
    const struct comm *comm = worker->pool->setup.comm;
    worker->idle_since = worker->looked = now;
    worker->awaited_then = comm ? comm_awaited_ticks(comm) : 0;
}

void work_stir(struct worker *worker)
{
    const struct comm *comm = worker->pool->setup.comm;
    if (worker->idle_since) {
        uint64_t idle = base_ticks() - worker->idle_since;
        uint64_t exposed = comm ? comm_awaited_ticks(comm) - worker->awaited_then : 0;
        work_bump(&worker->counts.idle, idle);
        work_bump(&worker->counts.exposed, exposed);
        worker->within += idle;
        work_note_idle(worker, idle, exposed);
    }
    worker->idle_since = 0;
    worker->pause = WORK_FIRST_PAUSE_SECONDS;
}

uint64_t work_unfinished(const struct work_pool *pool)
{
    return pool->setup.graph->tasks - over(pool);
}

static bool is_reached(void *context)
{
    const struct work_pool *pool = context;
    return work_unfinished(pool) < atomic_load_explicit(&pool->wanted, memory_order_relaxed);
}

void work_throttle(struct work_pool *pool, uint64_t most)
{
    const struct task_graph *graph = pool->setup.graph;
    if (graph->tasks < pool->look)
        return;
    uint64_t left = work_unfinished(pool);
    if (left > most) {
        atomic_store(&pool->wanted, most - most / 4 + 1);
        work_until(pool, &(struct work_why){"duite_fork", "room in its window", NULL}, is_reached,
                   pool);
        atomic_store(&pool->wanted, 0);
        left = work_unfinished(pool);
    }
    /* There cannot be more than `most` before so many are added. */
    pool->look = graph->tasks + (left < most ? most - left : 0) + 1;
}

void work_count(struct work_pool *pool, duite_counters *counters)
{
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        struct counts *counts = &pool->worker[i].counts;
        counters->tasks += atomic_load_explicit(&counts->tasks, memory_order_relaxed);
        counters->placed += atomic_load_explicit(&counts->placed, memory_order_relaxed);
        counters->stolen += atomic_load_explicit(&counts->stolen, memory_order_relaxed);
        counters->stolen_far += atomic_load_explicit(&counts->far, memory_order_relaxed);
        counters->chained += atomic_load_explicit(&counts->chained, memory_order_relaxed);
        counters->delegated += atomic_load_explicit(&counts->delegated, memory_order_relaxed);
        counters->busy +=
            pool->tick * (double)atomic_load_explicit(&counts->busy, memory_order_relaxed);
        counters->idle +=
            pool->tick * (double)atomic_load_explicit(&counts->idle, memory_order_relaxed);
        counters->exposed +=
            pool->tick * (double)atomic_load_explicit(&counts->exposed, memory_order_relaxed);
    }
    if (pool->setup.comm)
        counters->awaited =
            pool->setup.threads * pool->tick * (double)comm_awaited_ticks(pool->setup.comm);
}

const char *work_endless(const struct work_pool *pool)
{
    bool endless = atomic_load_explicit(&pool->endless, memory_order_relaxed);
    return endless ? pool->setup.scheduler->name : NULL;
}
