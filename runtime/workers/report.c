/* What workers report: counts for the program, events for the trace. Each worker writes its own
 * counts and its own ring alone; whoever reads the counts of all adds them up. */
#include "runtime/workers/internal.h"

/* ---- Counts ---- */

void work_count(struct work_pool *pool, duite_counters *counters)
{
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        struct work_counts *counts = &pool->worker[i].counts;
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

/* ---- The trace ---- */

void work_note_task(struct worker *worker, const struct task *task, const struct work_ran *ran)
{
    if (task_has_body(task) && !ran->body)
        return; /* poison kept it from running */
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
        event.flags |= TRACE_GUEST;
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

bool work_note_messages_begin(struct worker *worker)
{
    if (!worker->ring || worker->idle_since || worker->messaging)
        return false;
    worker->messaging = base_ticks();
    return true;
}

void work_note_messages_end(struct worker *worker, bool begun)
{
    const double least = 1e-6; /* s: an event for each look would cost as much as the look */
    if (!begun)
        return;
    const uint64_t took = base_ticks() - worker->messaging;
    if (worker->pool->tick * (double)took >= least) {
        worker->within += took;
        trace_put(worker->ring, &(struct trace_event){.begin = worker->messaging,
                                                      .took = took,
                                                      .kind = TRACE_MESSAGES});
    }
    worker->messaging = 0;
}

void work_note_message(struct worker *worker, bool sends, int peer, size_t bytes)
{
    if (worker)
        trace_mark(worker->ring, sends ? TRACE_SEND : TRACE_RECEIVE, (uint32_t)peer, bytes);
}

void work_note(struct work_pool *pool, const struct trace_event *event)
{
    trace_put(pool->worker[0].ring, event);
}

void work_note_counters(struct work_pool *pool, struct trace_counters *counters)
{
    for (unsigned i = 0; i < pool->setup.threads; i++) {
        struct work_counts *from = &pool->worker[i].counts;
        counters[i] = (struct trace_counters){
            .tasks = atomic_load_explicit(&from->tasks, memory_order_relaxed),
            .stolen = atomic_load_explicit(&from->stolen, memory_order_relaxed),
            .chained = atomic_load_explicit(&from->chained, memory_order_relaxed),
            .delegated = atomic_load_explicit(&from->delegated, memory_order_relaxed),
            .busy = atomic_load_explicit(&from->busy, memory_order_relaxed),
            .idle = atomic_load_explicit(&from->idle, memory_order_relaxed)};
    }
    if (pool->setup.comm)
        comm_count(pool->setup.comm, &counters[0].messages, &counters[0].bytes);
}
