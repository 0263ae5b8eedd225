/* Ready, the third stage of a task. `pending` counts the accesses that the task waits for, and one
 * hold of the fork itself; at 0 the task may run. The taker of the last one hands the task to the
 * workers, which run it: run.c. A version wakes its readers when its value is there, and its heir
 * when nobody holds it any more. */
#include "runtime/task/ready.h"

void task_settled(struct task_graph *graph, struct worker *worker, struct task *task, uint32_t done)
{
    ready_take(graph, worker, task, done + 1);
}

void task_wake(struct task_graph *graph, struct worker *worker, struct data_waiter *waiter)
{
    ready_wake(graph, worker, waiter);
}

/* The heir of the version that the value is passed on to may again be no task. */
void task_wake_heir(struct task_graph *graph, struct worker *worker, struct data_waiter *heir)
{
    while (heir && !heir->back)
        heir = task_pass(worker, heir);
    ready_wake_heir(graph, worker, heir);
}

void task_release(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    ready_release(graph, worker, version);
}

struct data_waiter *task_produced(struct task_graph *graph, struct worker *worker,
                                  struct data_version *version)
{
    return ready_produced(graph, worker, version);
}

void task_publish(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    ready_publish(graph, worker, version);
}
