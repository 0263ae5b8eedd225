/* What the main program or a body that waits for its children needs to know: whether they are over,
 * what failed among them, and which tasks may run on top of it meanwhile. */
#include "runtime/task/task.h"

bool task_alone(struct task_scope *scope)
{
    return atomic_load_explicit(&scope->unfinished, memory_order_acquire) == (scope->depth > 0);
}

void task_close_segment(struct task_scope *scope)
{
    scope->segment = ++scope->forks;
}

const struct data_failure *task_first_failure(struct task_scope *scope)
{
    struct task_graph *graph = scope->graph;
    pthread_mutex_lock(&graph->lock);
    const struct data_failure *failure = scope->failure;
    scope->failure = NULL;
    pthread_mutex_unlock(&graph->lock);
    return failure;
}

bool task_may_run(const struct task_scope *scope, const struct task *task)
{
    const struct task_scope *a = task->scope, *b = scope->parent;
    uint64_t a_number = task->number, b_number = scope->number;
    for (; a->depth > scope->depth; a = a->parent)
        a_number = a->number;
    if (a == scope)
        return true;
    if (a->top != scope->top) /* guests wait for nothing of ours, so they must not wait for us */
        return scope->top == &scope->graph->root;
    if (!scope->outward)
        return false;
    for (; a->depth > b->depth; a = a->parent)
        a_number = a->number;
    for (; b->depth > a->depth; b = b->parent)
        b_number = b->number;
    for (; a != b; a = a->parent, b = b->parent) {
        a_number = a->number;
        b_number = b->number;
    }
    return a_number <= b_number;
}
