/* Objects whose size changes: the body works in room for the maximum and says how many elements
 * there are; the packet it leaves has just these, and so have its readers and messages. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"

#include <string.h>

void task_size_close(struct task *task, const duite_param *param)
{
    for (uint32_t i = 0; i < task->n; i++) {
        struct data_version *out = task_written(&task->access[i]);
        if (out && out->sized)
            data_packet_resize(out->packet, param[i].count * data_type_size(param[i].type));
    }
}

/* Of parameter i; false in a plan, whose objects have fixed sizes. */
static bool is_sized(const struct task *task, size_t i)
{
    const struct task_access *access = &task->access[i];
    if (task->kind == TASK_GUEST)
        return offload_guest_sized(task, i);
    if (task->kind != TASK_BODY || access->waiter.mode == DUITE_CW)
        return false;
    if (task_postponed((duite_mode)access->waiter.mode))
        return task_lent_object(task->inner, access->lent)->sized;
    return access->out ? access->out->sized : access->in->sized;
}

static bool is_written(const struct task *task, size_t i)
{
    duite_mode mode = (duite_mode)task->access[i].waiter.mode;
    return mode == DUITE_W || mode == DUITE_RW;
}

static int refuse(const duite_call *call, size_t i, bool sized, size_t count)
{
    if (i >= call->n_params)
        duite_fail(call, 0, "duite_resize: there is no parameter %zu, only %zu", i, call->n_params);
    else if (!sized)
        duite_fail(call, 0, "duite_resize: the object of parameter %zu has a fixed size", i);
    else if (task_postponed((duite_mode)call->own->task->access[i].waiter.mode))
        duite_fail(call, 0, "duite_resize: parameter %zu is its children's alone", i);
    else if (!is_written(call->own->task, i))
        duite_fail(call, 0, "duite_resize: parameter %zu is only read", i);
    else
        duite_fail(call, 0, "duite_resize: parameter %zu: %zu elements are more than %zu at most",
                   i, count, call->param[i].most);
    call->own->refused = DUITE_E_SIZE;
    return base_error(DUITE_E_SIZE, "%s", call->own->text);
}

int duite_resize(const duite_call *call, size_t i, size_t count)
{
    struct task *task = call->own->task;
    bool sized = i < call->n_params && is_sized(task, i);
    if (!sized || !is_written(task, i) || count > call->param[i].most)
        return refuse(call, i, sized, count);
    duite_param *param = (duite_param *)&call->param[i]; /* ours to write */
    size_t size = data_type_size(param->type);
    if (count > param->count)
        memset((char *)param->data + param->count * size, 0, (count - param->count) * size);
    param->count = count;
    return DUITE_OK;
}
