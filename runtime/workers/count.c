/* What workers count, above all how many tasks are over: each worker counts its own on its own
 * cache lines, and who wants to know adds them up. So a task costs no line that workers share.
 *
 * The main thread, which waits for a number of tasks to be over, may sleep. It says what it waits
 * for: all of them (`awaited`), or, while it is throttled, fewer (`wanted`). It is woken by a
 * worker that runs out of work and finds one of these reached; and by one that does so at the end
 * of a task, if it is throttled. */
#include "runtime/workers/internal.h"

static uint64_t over(const struct work_pool *pool)
{
    uint64_t sum = 0;
    for (unsigned i = 0; i < pool->setup.threads; i++)
        sum += atomic_load_explicit(&pool->worker[i].counts.over, memory_order_acquire);
    return sum;
}

void work_over(void *context, void *who, int tasks)
{
    struct work_pool *pool = context;
    struct work_worker *worker = who;
    uint64_t before = atomic_load_explicit(&worker->counts.over, memory_order_relaxed);
    atomic_store_explicit(&worker->counts.over, before + (uint64_t)tasks, memory_order_release);
    uint64_t wanted = atomic_load_explicit(&pool->wanted, memory_order_relaxed);
    if (wanted && over(pool) >= wanted)
        work_notify(pool);
}

void work_ran_out(struct work_worker *worker)
{
    struct work_pool *pool = worker->pool;
    if (!worker->index)
        return;
    /* Against the main thread, which says what it waits for and then adds up. */
    atomic_thread_fence(memory_order_seq_cst);
    uint64_t awaited = atomic_load_explicit(&pool->awaited, memory_order_relaxed);
    uint64_t wanted = atomic_load_explicit(&pool->wanted, memory_order_relaxed);
    uint64_t least = wanted ? wanted : awaited;
    if ((least && over(pool) >= least) || graph_has_given_up(pool->setup.graph))
        work_notify(pool);
}

void work_idles(struct work_worker *worker, uint64_t now)
{
    const struct comm *comm = worker->pool->setup.comm;
    worker->idle_since = now;
    worker->awaited_then = comm ? comm_awaited_ticks(comm) : 0;
}

void work_stir(struct work_worker *worker)
{
    const struct comm *comm = worker->pool->setup.comm;
    if (worker->idle_since) {
        uint64_t idle = base_ticks() - worker->idle_since;
        work_bump(&worker->counts.idle, idle);
        worker->within += idle;
        if (comm)
            work_bump(&worker->counts.exposed, comm_awaited_ticks(comm) - worker->awaited_then);
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
    return over(pool) >= atomic_load_explicit(&pool->wanted, memory_order_relaxed);
}

void work_throttle(struct work_pool *pool, uint64_t most)
{
    const struct graph *graph = pool->setup.graph;
    if (graph->tasks < pool->look)
        return;
    uint64_t left = work_unfinished(pool);
    if (left > most) {
        atomic_store(&pool->wanted, graph->tasks - (most - most / 4));
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
