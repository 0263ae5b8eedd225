/* Ready, the third stage of a task. `pending` counts the accesses that the task waits for, and one
 * hold of the fork itself; at 0 the task may run. Whoever takes the last one hands the task to the
 * workers, which run it: run.c. A version wakes its readers when its value is there, and its heir
 * when nobody holds it any more. */
#include "runtime/task/internal.h"

#include "runtime/base/memory.h"

static void pending_take(struct task_graph *graph, struct worker *worker, struct task *task,
                         uint32_t taken)
{
    if (atomic_load_explicit(&task->pending, memory_order_acquire) == taken ||
        atomic_fetch_sub_explicit(&task->pending, taken, memory_order_acq_rel) == taken)
        work_ready(graph->pool, worker, task);
}

void task_settled(struct task_graph *graph, struct worker *worker, struct task *task, uint32_t done)
{
    pending_take(graph, worker, task, done + 1);
}

static struct task *waiter_task(struct data_waiter *waiter)
{
    return (struct task *)(void *)((char *)waiter - waiter->back);
}

void task_wake(struct task_graph *graph, struct worker *worker, struct data_waiter *waiter)
{
    if (waiter)
        pending_take(graph, worker, waiter_task(waiter), 1);
}

/* An heir that is no task passes the value on to the scope above, whose heir may again be no task.
 */
static void heir_wake(struct task_graph *graph, struct worker *worker, struct data_waiter *heir)
{
    while (heir && !heir->back)
        heir = task_pass(worker, heir);
    if (heir) /* an access: another core wrote what its task will need next */
        base_prefetch(((struct task_access *)(void *)heir)->out);
    task_wake(graph, worker, heir);
}

void task_release(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    struct data_waiter *heir = data_version_release(version);
    if (heir)
        heir_wake(graph, worker, heir);
}

struct data_waiter *task_produced(struct task_graph *graph, struct worker *worker,
                                  struct data_version *version)
{
    struct data_waiter *waiter = data_version_produced(version);
    while (waiter) {
        struct data_waiter *next = waiter->next; /* the task may run and be freed once woken */
        task_wake(graph, worker, waiter);
        waiter = next;
    }
    return data_version_release(version);
}

void task_publish(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    heir_wake(graph, worker, task_produced(graph, worker, version));
}
