/* The end of a task that forked, and waiting for those it forked. When the body is over, the last
 * version that the children make of a lent object gets an `exit` as its heir. The exit passes the
 * bytes on to the version that the scope above has waited for since the fork. An exit belongs to
 * the thread that releases the last hold on its version. The scope is freed with the last count of
 * `unfinished`. */
#include "runtime/task/ready.h"
#include "runtime/task/scope.h"

#include "runtime/base/memory.h"

#include <string.h>

/* ---- The end ---- */

void task_left_last(struct task_graph *graph, struct task_scope *scope, struct worker *worker)
{
    struct task_scope *parent;
    while ((parent = scope->parent)) {
        struct task_nest *nest = task_nest_of(scope);
        if (nest->moved)
            base_pool_give(nest->local, nest->room * sizeof *nest->local);
        base_pool_give(nest, nest->size);
        scope = parent;
        if (scope == &graph->root) {
            queue_over(graph->pool, worker);
            return;
        }
        if (scope->parent &&
            atomic_fetch_sub_explicit(&scope->unfinished, 1, memory_order_acq_rel) != 1)
            return;
    }
    graph->offloaded_over(scope, worker);
}

const struct data_failure task_scope_no_memory = {
    .code = DUITE_E_MEMORY, .kernel = UINT32_MAX, .text = "no memory for what a task leaves"};

/* Gives the maximum number of zeros, as no child wrote the version. */
static void exit_give_zeros(const struct task_exit *exit)
{
    struct data_version *out = exit->out;
    if (out->packet && out->packet->bytes == exit->bytes) {
        memset(data_payload(out->packet), 0, exit->bytes);
        return;
    }
    if (out->packet)
        data_packet_free(out->packet);
    out->packet = data_packet_new(exit->bytes, true);
    if (!out->packet)
        data_version_poison(
            out, task_fail(exit->scope->graph, &task_scope_no_memory, &exit->scope->graph->root));
}

struct data_waiter *task_pass(struct worker *worker, struct data_waiter *waiter)
{
    struct task_exit *exit = (struct task_exit *)waiter;
    struct task_scope *scope = exit->scope;
    struct data_version *out = exit->out;
    const struct data_failure *failure =
        data_failure_first(exit->untouched ? NULL : data_version_failure(exit->in), exit->failure);
    out->packet = data_version_packet(exit->in);
    data_version_free(exit->in);
    data_version_poison(out, failure);
    if (exit->untouched && !failure)
        exit_give_zeros(exit);
    struct data_waiter *heir = ready_produced(scope->graph, worker, out);
    task_left(scope->graph, scope, worker);
    return heir;
}

/* A written parameter goes back to the scope above. */
static void exit_give_back(struct task_exit *exit, struct worker *worker,
                           struct data_object *object, const struct data_failure *failure)
{
    struct task_scope *scope = exit->scope;
    exit->in = object->current;
    exit->failure = failure;
    if (!exit->in) {
        data_version_poison(exit->out, failure);
        if (!failure)
            exit_give_zeros(exit);
        ready_publish(scope->graph, worker, exit->out);
        return;
    }
    exit->in->heir = &exit->waiter;
    atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    ready_release(scope->graph, worker, exit->in);
}

/* The children's contributions, or none, are this task's. */
static void exit_contribute(struct task_exit *exit, struct worker *worker,
                            struct data_object *object, const struct data_failure *failure)
{
    struct task_scope *scope = exit->scope;
    exit->leaf->failure = data_failure_first(failure, exit->leaf->failure);
    if (object->leaves) {
        if (!task_gather(scope, worker, object, exit->leaf))
            return;
        exit->leaf->failure = &task_scope_no_memory;
    }
    ready_wake(scope->graph, worker, data_sum_release(exit->sum));
}

void task_scope_fail(struct task_scope *scope, const struct data_failure *failure)
{
    task_nest_of(scope)->failure = failure;
}

void task_scope_end(struct task_scope *scope, struct worker *worker)
{
    struct task_nest *nest = task_nest_of(scope);
    const struct data_failure *failure = nest->failure;
    struct task_graph *graph = scope->graph;
    for (uint32_t i = 0; i < nest->n_local; i++) {
        struct data_object *object = &nest->local[i];
        struct task_exit *exit = i < nest->n_lent ? &nest->exit[i] : NULL;
        if (exit && exit->sum) {
            exit_contribute(exit, worker, object, failure);
            continue;
        }
        bool lost = object->leaves && task_reduce(scope, worker, object);
        if (exit && exit->out) {
            exit->untouched = exit->overwrites && !object->number;
            exit_give_back(exit, worker, object, lost ? &task_scope_no_memory : failure);
        } else if (object->current) {
            ready_release(graph, worker, object->current);
        }
    }
    task_left(graph, scope, worker);
}

/* ---- Waiting: whether the children are over, their first failure, and which tasks may run on top
 * of the waiting body ---- */

bool task_alone(struct task_scope *scope)
{
    return atomic_load_explicit(&scope->unfinished, memory_order_acquire) == (scope->depth > 0);
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

/* True if a comes before b, or is the same; both are offloaded or descend from such. A task that
 * was sent has a place that is not cut off (offload_may_go). So this is right for a task that just
 * came, under any waiting body. */
static bool place_is_earlier(const struct task *a, const struct task *b)
{
    struct data_failure left = {0}, right = {0};
    task_failure_place(&left, a, NULL);
    task_failure_place(&right, b, NULL);
    return left.number != right.number ? left.number < right.number
                                       : memcmp(left.path, right.path, right.path_length) <= 0;
}

/* True if number a_number of scope a comes before b_number of b, or is the same; both scopes have
 * the same top. */
static bool number_is_earlier(const struct task_scope *a, uint64_t a_number,
                              const struct task_scope *b, uint64_t b_number)
{
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

bool task_is_earlier(const struct task *a, const struct task *b)
{
    const struct task_scope *root = &a->scope->graph->root;
    if (a->scope->top == b->scope->top)
        return number_is_earlier(a->scope, a->number, b->scope, b->number);
    return a->scope->top != root && (b->scope->top == root || place_is_earlier(a, b));
}

bool task_descends(const struct task_scope *scope, const struct task *task)
{
    const struct task_scope *a = task->scope;
    while (a->depth > scope->depth)
        a = a->parent;
    return a == scope;
}

bool task_may_run_other(const struct task_scope *scope, const struct task *task)
{
    const struct task_scope *top = task->scope->top, *root = &scope->graph->root;
    if (task_descends(scope, task) || (scope->top == root && top != root))
        return true;
    if (top != scope->top)
        return top != root && place_is_earlier(task, ((const struct task_nest *)scope)->body->task);
    return (scope->outward || scope->top != root) &&
           number_is_earlier(task->scope, task->number, scope->parent, scope->number);
}
