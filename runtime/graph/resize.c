/* Objects whose size changes: the body works in room for the maximum and says how many elements
 * there are; the packet it leaves has just these, and so have its readers and messages. */
#include "runtime/graph/internal.h"

#include "runtime/base/error.h"

#include <string.h>

void graph_size_open(struct graph_task *task, size_t i, struct data_packet *packet)
{
    duite_param *param = &task->param[i];
    if (packet && task->access[i].mode != DUITE_W)
        param->count = packet->bytes / data_type_size(param->type);
}

void graph_size_close(struct graph_task *task)
{
    for (uint32_t i = 0; i < task->n; i++)
        if (task->access[i].sized && task->access[i].out)
            data_packet_resize(task->access[i].out->packet,
                               task->param[i].count * data_type_size(task->param[i].type));
}

static int refuse(const duite_call *call, size_t i, bool sized, size_t count)
{
    if (i >= call->n_params)
        duite_fail(call, 0, "duite_resize: there is no parameter %zu, only %zu", i, call->n_params);
    else if (!sized)
        duite_fail(call, 0, "duite_resize: the object of parameter %zu has a fixed size", i);
    else if (graph_postponed(call->own->task->access[i].mode))
        duite_fail(call, 0, "duite_resize: parameter %zu is its children's alone", i);
    else if (!call->own->task->access[i].out)
        duite_fail(call, 0, "duite_resize: parameter %zu is only read", i);
    else
        duite_fail(call, 0, "duite_resize: parameter %zu: %zu elements are more than %zu at most",
                   i, count, call->param[i].most);
    call->own->refused = DUITE_E_SIZE;
    return base_error(DUITE_E_SIZE, "%s", call->own->text);
}

int duite_resize(const duite_call *call, size_t i, size_t count)
{
    struct graph_task *task = call->own->task;
    bool plain = task->kind == GRAPH_BODY; /* objects of a plan have fixed sizes */
    bool sized = plain && i < call->n_params && task->access[i].sized;
    if (!sized || !task->access[i].out || count > call->param[i].most)
        return refuse(call, i, sized, count);
    duite_param *param = (duite_param *)&call->param[i]; /* ours to write */
    size_t size = data_type_size(param->type);
    if (count > param->count)
        memset((char *)param->data + param->count * size, 0, (count - param->count) * size);
    param->count = count;
    return DUITE_OK;
}
