/* Starts and stops the workers of a rank, and passes its graph's calls on to checking mode, which
 * the graph does not know. A pool that failed half-way stops by the same path as a whole one. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/thread.h"
#include "runtime/offload/offload.h"
#include "runtime/sched/sched.h"
#include "runtime/workers/internal.h"

#include <sched.h>
#include <stdio.h>
/* Between polls while there is work. */
#define POLL_SECONDS 5e-6
/* A poller without a core of its own gives way so long before it pauses. */
#define YIELD_SECONDS 1e-4
/* In the middle of a replay a poller gives way longer: neighbours that each sleep until the other
 * wakes would go on doing so. */
#define AWAIT_SECONDS 1e-2
/* Tasks that take less run sixteen between two looks at the clock: that delays a waiter by less
 * than a millisecond. */
#define BRIEF_SECONDS 1e-5

/* ---- Start ---- */

static int pool_check_body(struct queue_pool *queues, const duite_kernel *kernel, uint64_t number,
                           duite_call *call)
{
    const struct work_pool *pool = (const struct work_pool *)(const void *)queues;
    return check_call(pool->setup.check, &(struct check_task){kernel, number}, call);
}

static void worker_start_scheduler(struct worker *worker)
{
    const struct work_setup *setup = &worker->pool->setup;
    const duite_scheduler *scheduler = setup->scheduler;
    worker->mark = base_mark_of(setup->marks, BASE_SCHEDULER, worker->index);
    base_mark_begin(worker->mark, BASE_SCHEDULER_START);
    if (scheduler->start)
        scheduler->start(worker->state, worker->index, setup->threads, setup->seed);
    base_mark_end(worker->mark);
    base_mark_begin(worker->mark, BASE_SCHEDULER_LOCATE);
    if (scheduler->locate)
        scheduler->locate(worker->state, &worker->pool->near.of[worker->index]);
    base_mark_end(worker->mark);
}

static bool worker_prepare(struct work_pool *pool, unsigned index, int unit)
{
    const struct work_setup *setup = &pool->setup;
    struct worker *worker = &pool->queues.worker[index];
    size_t lines = (setup->scheduler->state_size + BASE_LINE - 1) / BASE_LINE + 1;
    worker->pool = pool;
    worker->queues = &pool->queues;
    worker->index = index;
    worker->unit = unit;
    worker->state = pool->states + index * lines * BASE_LINE;
    worker->ring = trace_ring(setup->trace, index);
    worker->pause = WORK_FIRST_PAUSE_SECONDS;
    worker->switches = -1;
    worker->call = (duite_call){
        .context = setup->context, .rt = setup->rt, .rank = setup->graph->rank, .worker = index};
    worker_start_scheduler(worker);
    bool queue = queue_start(&worker->queue, task_rank);
    return queue_park_start(&worker->park) && queue;
}

static int pool_start_threads(struct work_pool *pool)
{
    sched_getaffinity(0, sizeof pool->queues.worker[0].binding, &pool->queues.worker[0].binding);
    for (pool->started = 1; pool->started < pool->setup.threads; pool->started++) {
        struct worker *worker = &pool->queues.worker[pool->started];
        char what[64];
        snprintf(what, sizeof what, "worker thread %u of %u", pool->started, pool->setup.threads);
        const int code = base_thread_start(&worker->thread, what, work_thread, worker);
        if (code)
            return code;
    }
    work_cores_bind(pool->queues.worker[0].unit);
    pool->queues.worker[0].stack = base_stack_here();
    return DUITE_OK;
}

static void pool_set_ticks(struct work_pool *pool)
{
    pool->queues.tick = base_tick_seconds();
    pool->poll_ticks = (uint64_t)(POLL_SECONDS / pool->queues.tick);
    pool->spin_ticks = (uint64_t)(pool->setup.spin_seconds / pool->queues.tick);
    pool->yield_ticks = (uint64_t)(YIELD_SECONDS / pool->queues.tick);
    pool->await_ticks = (uint64_t)(AWAIT_SECONDS / pool->queues.tick);
    pool->brief_ticks = (uint64_t)(BRIEF_SECONDS / pool->queues.tick);
    const uint64_t affinity = (uint64_t)(PLAN_AFFINITY_SECONDS / pool->queues.tick);
    pool->affinity_ticks =
        pool->queues.by_affinity && pool->setup.threads == 1 ? UINT64_MAX : affinity;
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
    pool->queues.n = n;
    pool->queues.scheduler = setup->scheduler;
    pool->queues.by_affinity = setup->scheduler->chain == sched_chain_affinity &&
                               setup->scheduler->place == sched_place_affinity;
    pool->queues.straight = pool->queues.by_affinity;
    pool->plain = !setup->comm && !setup->trace;
    pool->plain_nodes = pool->queues.by_affinity && pool->plain;
    pool_set_ticks(pool);
    pool->queues.worker = base_alloc_zero(n * sizeof pool->queues.worker[0]);
    pool->states = base_alloc_zero(n * lines * BASE_LINE);
    setup->graph->paths = setup->scheduler->paths;
    bool fine = pool->queues.worker && pool->states &&
                work_near_start(&pool->near, n, setup->cores) &&
                queue_start(&pool->queues.shared, task_rank);
    const int watched = work_standstill_start(pool, fine ? setup->stuck_seconds : 0);
    for (unsigned i = 0; i < n && fine; i++)
        fine = worker_prepare(pool, i, setup->cores ? setup->cores[i] : -1);
    if (fine)
        fine = !work_balance_start(&pool->balance, pool);
    setup->graph->pool = &pool->queues;
    setup->graph->comm = setup->comm;
    setup->graph->check = setup->check ? pool_check_body : NULL;
    setup->graph->offloaded_over = offload_over;
    int code = fine ? pool_start_threads(pool) : base_no_memory("the workers");
    return code ? code : watched;
}

/* ---- Stop ---- */

void work_stop(struct work_pool *pool)
{
    static const struct work_why end = {.call = "duite_stop", .what = "the workers of this rank"};
    if (!pool)
        return;
    if (pool->setup.comm)
        comm_workers_end(pool->setup.comm);
    pool->setup.graph->pool = NULL;
    atomic_store(&pool->stop, 1);
    work_waits(pool, &end);
    for (unsigned i = 1; i < pool->started; i++) {
        atomic_thread_fence(memory_order_seq_cst);
        queue_park_wake(&pool->queues.worker[i].park);
        pthread_join(pool->queues.worker[i].thread, NULL);
    }
    work_standstill_stop(pool);
    if (pool->started && pool->queues.worker[0].unit >= 0)
        sched_setaffinity(0, sizeof pool->queues.worker[0].binding,
                          &pool->queues.worker[0].binding);
    for (unsigned i = 0; pool->queues.worker && i < pool->setup.threads; i++) {
        queue_stop(&pool->queues.worker[i].queue);
        if (pool->queues.worker[i].pool)
            queue_park_stop(&pool->queues.worker[i].park);
    }
    queue_stop(&pool->queues.shared);
    work_balance_stop(pool);
    work_near_stop(&pool->near);
    base_free(pool->queues.worker);
    base_free(pool->states);
    base_free(pool);
}

/* ---- Counts ---- */

void work_count(struct work_pool *pool, duite_counters *counters)
{
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        struct queue_counts *counts = &pool->queues.worker[i].counts;
        counters->tasks += atomic_load(&counts->tasks);
        counters->placed += atomic_load(&counts->placed);
        counters->stolen += atomic_load(&counts->stolen);
        counters->stolen_far += atomic_load(&counts->far);
        counters->chained += atomic_load(&counts->chained);
        counters->delegated += atomic_load(&counts->delegated);
        counters->busy += pool->queues.tick * (double)atomic_load(&counts->busy);
        counters->idle += pool->queues.tick * (double)atomic_load(&counts->idle);
        counters->exposed += pool->queues.tick * (double)atomic_load(&counts->exposed);
    }
    if (pool->setup.comm)
        counters->awaited =
            pool->setup.threads * pool->queues.tick * (double)comm_awaited_ticks(pool->setup.comm);
}

const char *work_endless(const struct work_pool *pool)
{
    bool endless = atomic_load(&pool->endless);
    return endless ? pool->setup.scheduler->name : NULL;
}

/* ---- The trace ---- */

void work_note_task(struct worker *worker, const struct task *task, const struct work_ran *ran)
{
    if (task->state == TASK_ENDED || (task_has_body(task) && !ran->body))
        return; /* its body ran before, or poison kept it from running */
    bool nested;
    struct trace_event event = {.begin = ran->start,
                                .took = ran->took,
                                .within = ran->within,
                                .number = task_main_number(task, &nested),
                                .kernel = ran->body ? task->kernel : task_own_number(task),
                                .kind = ran->body ? TRACE_TASK : TRACE_OWN};
    if (nested)
        event.flags |= TRACE_NESTED;
    if (task->type == TASK_OFFLOADED)
        event.flags |= TRACE_OFFLOADED;
    if (ran->inlined)
        event.flags |= TRACE_CHAINED;
    trace_put(worker->ring, &event);
}

bool work_note_relieve(struct worker *worker)
{
    bool full = trace_is_full(worker->ring);
    if (full)
        trace_relieve(worker->pool->setup.trace, worker->ring);
    return full;
}

void work_note_idle(struct worker *worker, uint64_t idle, uint64_t exposed)
{
    trace_put(worker->ring, &(struct trace_event){.begin = worker->idle_since,
                                                  .took = idle,
                                                  .within = exposed < idle ? exposed : idle,
                                                  .kind = TRACE_IDLE});
}

static bool note_messages_begin(struct worker *worker)
{
    if (!worker || !worker->ring || worker->idle_since || worker->messaging)
        return false;
    worker->messaging = base_ticks();
    return true;
}

static void note_messages_end(struct worker *worker)
{
    const double least = 1e-6; /* s: to note each look would cost as much as the look */
    const uint64_t took = base_ticks() - worker->messaging;
    if (worker->pool->queues.tick * (double)took >= least) {
        worker->within += took;
        trace_put(worker->ring, &(struct trace_event){.begin = worker->messaging,
                                                      .took = took,
                                                      .kind = TRACE_MESSAGES});
    }
    worker->messaging = 0;
}

static void note_message(struct worker *worker, bool sends, int peer, size_t bytes)
{
    if (worker)
        trace_mark(worker->ring, sends ? TRACE_SEND : TRACE_RECEIVE, (uint32_t)peer, bytes);
}

const struct comm_report work_report = {
    .message = note_message, .begins = note_messages_begin, .ends = note_messages_end};

void work_note_counters(struct work_pool *pool, struct trace_counters *counters)
{
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        struct queue_counts *from = &pool->queues.worker[i].counts;
        counters[i] = (struct trace_counters){.tasks = atomic_load(&from->tasks),
                                              .stolen = atomic_load(&from->stolen),
                                              .chained = atomic_load(&from->chained),
                                              .delegated = atomic_load(&from->delegated),
                                              .busy = atomic_load(&from->busy),
                                              .idle = atomic_load(&from->idle)};
    }
    if (pool->setup.comm)
        comm_count(pool->setup.comm, &counters[0].messages, &counters[0].bytes);
}
