#ifndef DUITE_TASK_READY_H
#define DUITE_TASK_READY_H

#include "runtime/task/internal.h"

#include "runtime/base/memory.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Ready, the third stage of a task. `pending` counts the accesses that the task waits for, and one
 * hold of the fork itself; at 0 the task may run. The taker of the last one hands the task to the
 * workers, which run it: run.c. A version wakes its readers when its value is there, and its heir
 * when nobody holds it any more. */

/* An heir that is no task passes the value on to the scope above. Not inline: it is rare. */
void task_wake_heir(struct task_graph *graph, struct worker *worker, struct data_waiter *heir);

/* Takes so many from `pending`; at 0 the task is ready. */
__attribute__((always_inline)) static inline void
ready_take(struct task_graph *graph, struct worker *worker, struct task *task, uint32_t taken)
{
    if (atomic_load_explicit(&task->pending, memory_order_acquire) == taken ||
        atomic_fetch_sub_explicit(&task->pending, taken, memory_order_acq_rel) == taken)
        task_ready(graph, worker, task);
}

static inline struct task *ready_waiter_task(struct data_waiter *waiter)
{
    return (struct task *)(void *)((char *)waiter - waiter->back);
}

/* Wakes a waiter of a task: it waited for this. NULL is fine. */
static inline void ready_wake(struct task_graph *graph, struct worker *worker,
                              struct data_waiter *waiter)
{
    if (waiter)
        ready_take(graph, worker, ready_waiter_task(waiter), 1);
}

/* Wakes an heir of any kind. */
static inline void ready_wake_heir(struct task_graph *graph, struct worker *worker,
                                   struct data_waiter *heir)
{
    if (!heir)
        return;
    if (!heir->back) {
        task_wake_heir(graph, worker, heir);
        return;
    }
    ready_take(graph, worker, ready_waiter_task(heir), 1);
}

/* Releases a hold. */
static inline void ready_release(struct task_graph *graph, struct worker *worker,
                                 struct data_version *version)
{
    ready_wake_heir(graph, worker, data_version_release(version));
}

/* The value is there: wakes the readers, and releases the producer's hold. Returns the heir if it
 * may take the version over. */
static inline struct data_waiter *ready_produced(struct task_graph *graph, struct worker *worker,
                                                 struct data_version *version)
{
    struct data_waiter *waiter = data_version_produced(version);
    while (waiter) {
        struct data_waiter *next = waiter->next; /* the task may run and be freed once woken */
        /* Mostly the two lines of a task that another core forked; behind the last one is none. */
        base_prefetch(next);
        base_prefetch((const void *)((uintptr_t)next - BASE_LINE));
        waiter->version = version;
        ready_take(graph, worker, ready_waiter_task(waiter), 1);
        waiter = next;
    }
    return data_version_release(version);
}

/* The same, and wakes the heir. */
static inline void ready_publish(struct task_graph *graph, struct worker *worker,
                                 struct data_version *version)
{
    ready_wake_heir(graph, worker, ready_produced(graph, worker, version));
}

#pragma GCC visibility pop

#endif
