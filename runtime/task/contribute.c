/* Contributions to a sum that is open. Leaves run wherever their tasks do, without waiting for one
 * another or for the object. */
#include "runtime/task/internal.h"

/* ---- Contributing: at forks ---- */

/* Gives the object a sum. False without memory. */
static bool sum_open(const struct task_graph *graph, struct data_object *object)
{
    if (!object->sum)
        object->sum = data_sum_new(graph->n_ranks, object->law, object->type, object->count);
    return object->sum;
}

int task_contribute(struct task_graph *graph, struct task *task, size_t i,
                    struct data_object *object, const duite_law *law, int at)
{
    bool adder = object->holder == graph->rank;
    object->law = law;
    if ((adder || task) && !sum_open(graph, object))
        return task_break(graph, "contributions");
    uint64_t first = object->leaves++;
    if (adder && !task)
        data_sum_sender(object->sum, at);
    if (!task)
        return DUITE_OK;
    struct task_access *access = &task->access[i];
    access->leaf = data_sum_leaf(object->sum, first);
    if (access->leaf)
        return DUITE_OK;
    atomic_store_explicit(&object->sum->lost, &task_sum_no_memory, memory_order_relaxed);
    return task_break(graph, "a contribution");
}

/* ---- Contributing without a child: in a body that holds cwp ---- */

static void *contribute_refuse(const duite_call *call, size_t i, int code)
{
    if (code == DUITE_E_MEMORY)
        duite_fail(call, 0, "duite_contribute: no memory for a contribution");
    else if (i >= call->n_params)
        duite_fail(call, 0, "duite_contribute: there is no parameter %zu, only %zu", i,
                   call->n_params);
    else
        duite_fail(
            call, 0, "duite_contribute: the task holds %s on parameter %zu, cwp is wanted",
            task_mode_name(data_mode_of(call->own->graph->kernels[call->own->task->kernel], i)), i);
    call->own->refused = code;
    base_error(code, "%s", call->own->text);
    return NULL;
}

/* The sum stays open until the body is over: under cwp the children may only contribute. So the
 * leaf is not counted among those that the sum waits for. */
void *duite_contribute(const duite_call *call, size_t i)
{
    const struct duite_call_private *body = call->own;
    const struct task *task = body->task;
    const duite_kernel *kernel = body->graph->kernels[task->kernel];
    if (i >= call->n_params || data_mode_of(kernel, i) != DUITE_CWP)
        return contribute_refuse(call, i, DUITE_E_RIGHT);
    struct data_object *object = task_lent_object(body->scope, task->access[i].lent);
    object->law = data_law_of(kernel, i);
    struct data_piece *leaf =
        sum_open(body->graph, object) ? data_sum_leaf(object->sum, object->leaves++) : NULL;
    if (leaf)
        data_sum_release(object->sum);
    if (!leaf || !data_sum_open(object->sum, leaf))
        return contribute_refuse(call, i, DUITE_E_MEMORY);
    return leaf->value;
}
