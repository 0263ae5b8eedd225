/* Finishing, the last stage of a task: its outputs are published once, its inputs released, and the
 * task is freed. */
#include "runtime/task/ready.h"

/* The heir of the version that the value is passed on to may again be no task. */
void task_wake_heir(struct task_graph *graph, struct worker *worker, struct data_waiter *heir)
{
    while (heir && !heir->back)
        heir = task_pass(worker, heir);
    ready_wake_heir(graph, worker, heir);
}

static inline void access_release(struct task_graph *graph, struct worker *worker,
                                  const struct task_access *access)
{
    if (access->waiter.mode == DUITE_R) { /* most */
        ready_wake_heir(graph, worker, data_version_was_read(access->waiter.version));
        return;
    }
    switch (access->waiter.mode) {
    case DUITE_W:
    case DUITE_RW:
        ready_publish(graph, worker, access->waiter.version);
        break;
    case DUITE_CW:
        ready_wake(graph, worker, data_sum_release(access->leaf->sum));
        break;
    default: /* postponed: the scope's */
        break;
    }
}

void task_finish(struct task_graph *graph, struct worker *worker, struct task *task)
{
    const uint32_t n = task->n;
    for (uint32_t i = 0; i < n; i++)
        access_release(graph, worker, &task->access[i]);
    struct task_scope *scope = task->scope;
    struct task_scope *inner =
        task->type == TASK_BODY || task->state == TASK_VOID ? task->inner : NULL;
    base_pool_give(task, (size_t)task->grains * TASK_GRAIN);
    if (inner)
        task_scope_end(inner, worker); /* it leaves `scope` when its children have */
    else
        task_left(graph, scope, worker);
}
