/* This rank runs offloaded tasks. The body works on the incoming message and on the outgoing
 * result, without versions. The task has a top of its scopes of its own, so that failures get their
 * place from home and are told there. It is over when all its descendants are; then its result is
 * sent. */
#include "runtime/offload/message.h"

#include "runtime/base/memory.h"
#include "runtime/data/law.h"
#include "runtime/task/call.h"

#include <string.h>

static const struct offload_message *message_of(const struct offload_task *own)
{
    return data_payload(own->message);
}

static const struct offload_param *param_of(const struct offload_task *own)
{
    return (const void *)(message_of(own) + 1);
}

int offload_home(const struct task *task)
{
    return (int)task->offloaded->message->key.slot;
}

/* ---- Arriving ---- */

static bool access_is_postponed(const struct task *task, size_t i)
{
    return task_postponed((duite_mode)task->access[i].waiter.mode);
}

static void offloaded_init(struct offload_task *own, struct task_graph *graph,
                           struct data_packet *packet)
{
    const struct offload_message *message = data_payload(packet);
    *own = (struct offload_task){
        .above = {.graph = graph, .top = &own->above},
        .place = {.number = message->number, .path_length = message->path_length},
        .message = packet};
    memcpy(own->place.path, message->path, sizeof message->path);
    own->above.place = &own->place;
}

bool offload_arrived(void *context, struct worker *worker, struct data_packet *packet)
{
    struct task_graph *graph = context;
    const struct offload_message *message = data_payload(packet);
    struct offload_task *own = base_pool_take(sizeof *own);
    if (!own)
        return false;
    offloaded_init(own, graph, packet);
    struct task *task = task_make(&own->above, TASK_OFFLOADED, message->n, 0);
    if (!task) {
        base_pool_give(own, sizeof *own);
        return false;
    }
    own->task = task;
    task->offloaded = own;
    task->number = message->index;
    task->kernel = message->kernel;
    task->block = message->block;
    task->priority = message->priority;
    task->cost = message->cost;
    for (uint32_t i = 0; i < task->n; i++) {
        task->access[i].waiter.mode = data_mode_of(graph->kernels[task->kernel], i);
        if (!access_is_postponed(task, i))
            task->access[i].sized = param_of(own)[i].sized;
    }
    atomic_fetch_add_explicit(&graph->offloaded, 1, memory_order_relaxed);
    task_ready(graph, worker, task);
    return true;
}

/* ---- Running ---- */

static size_t result_lines(const struct task *task, size_t i)
{
    return message_lines(message_room(task->access[i].waiter.mode, &param_of(task->offloaded)[i]));
}

/* Sets the value that the body finds: unspecified under w, the one that came under rw, the law's
 * neutral element under cw. */
static void result_fill(const struct task *task, size_t i, const void *came, void *data)
{
    const struct offload_param *param = &param_of(task->offloaded)[i];
    const duite_kernel *kernel = task->scope->graph->kernels[task->kernel];
    if (task->access[i].waiter.mode == DUITE_RW && param->bytes)
        memcpy(data, came, param->bytes);
    else if (task->access[i].waiter.mode == DUITE_CW)
        data_law_neutral(data_law_of(kernel, i), data, param->max, (duite_type)param->type);
}

/* Lends the parameter to the children; the body does not see it. False without memory. */
static bool param_lend(struct task *task, size_t i, const void *came, duite_param *param)
{
    const struct offload_param *from = &param_of(task->offloaded)[i];
    const duite_kernel *kernel = task->scope->graph->kernels[task->kernel];
    const size_t room = from->max * data_type_size((duite_type)from->type);
    const struct data_object object = {
        .type = (duite_type)from->type,
        .sized = from->sized,
        .count = from->max,
        .bytes = room,
        .max = from->max,
        .room = room,
        .block = task->block,
        .law = task->access[i].waiter.mode == DUITE_CWP ? data_law_of(kernel, i) : NULL};
    *param = (duite_param){.count = from->max, .type = object.type, .max = from->max};
    return task_lend_value(task->offloaded->inner, &task->access[i], &object, came, from->bytes);
}

/* Makes the scope of a task with postponed parameters. False without memory. */
static bool scope_make(const struct task *task)
{
    size_t n = 0;
    for (size_t i = 0; i < task->n; i++)
        n += access_is_postponed(task, i);
    if (n)
        task->offloaded->inner = task_scope_new(task, n);
    return !n || task->offloaded->inner;
}

/* Gives the body its parameters. False without memory. */
static bool params_lay_out(struct task *task, duite_param *param, const void **args)
{
    struct offload_task *own = task->offloaded;
    uint32_t stamp = task->n ? task_new_stamp() : 0;
    size_t bytes = message_values_at(task->n) + 2 * message_lines(sizeof(struct data_failure));
    for (size_t i = 0; i < task->n; i++)
        bytes += result_lines(task, i);
    own->result = data_packet_new(bytes, false);
    if (!own->result || !scope_make(task))
        return false;
    char *in = (char *)data_payload(own->message) + message_args_at(task->n);
    char *out = (char *)data_payload(own->result) + message_values_at(task->n);
    *args = in;
    in += message_lines(task->scope->graph->kernels[task->kernel]->args_size);
    for (uint32_t i = 0; i < task->n; i++) {
        const struct offload_param *came = &param_of(own)[i];
        duite_type type = (duite_type)came->type;
        duite_mode mode = (duite_mode)task->access[i].waiter.mode;
        bool fresh = !came->sized || mode == DUITE_W;
        if (task_postponed(mode)) {
            if (!param_lend(task, i, in, &param[i]))
                return false;
        } else {
            param[i] =
                (duite_param){.data = mode == DUITE_R ? in : out,
                              .count = fresh ? came->max : came->bytes / data_type_size(type),
                              .type = type,
                              .max = came->max};
            result_fill(task, i, in, out);
            out += result_lines(task, i);
        }
        param[i].object = (duite_object){TASK_LOCAL_NAME | i, stamp};
        in += message_value(mode, came->bytes);
    }
    return true;
}

/* The values move together: those of objects that change their size may be smaller than their room.
 * The children's values follow later. A body that failed left none. */
static void result_close_up(const struct task *task, const duite_param *param)
{
    struct data_packet *result = task->offloaded->result;
    struct offload_left *answer = data_payload(result);
    size_t at = message_values_at(task->n);
    memset(answer, 0, at);
    for (uint32_t i = 0; i < task->n; i++) {
        const duite_mode mode = (duite_mode)task->access[i].waiter.mode;
        answer[i].what = LEFT_NOTHING;
        if (mode == DUITE_R || task_postponed(mode) || task->offloaded->failure)
            continue;
        const size_t bytes = param[i].count * data_type_size(param[i].type);
        answer[i] = (struct offload_left){.bytes = bytes, .what = LEFT_VALUE};
        at = offload_message_put(result, at, param[i].data, bytes);
    }
    data_packet_resize(result, at);
}

static bool offloaded_run_body(struct task_graph *graph, struct worker *worker, struct task *task,
                               duite_param *param, const duite_call *call)
{
    struct offload_task *own = task->offloaded;
    const void *args = NULL;
    own->failure = task_given_up(graph);
    if (!own->failure && !params_lay_out(task, param, &args))
        own->failure = task_fail_memory(task);
    if (own->failure)
        return false;
    if (!graph->kernels[task->kernel]->args_size)
        args = NULL;
    struct task_frame frame;
    task_frame_init(&frame, graph, worker, call);
    frame.call.round = message_of(own)->round;
    own->failure = task_frame_call(&frame, task, args, param, &own->inner);
    result_close_up(task, param);
    if (own->failure && own->inner)
        task_scope_fail(own->inner, own->failure);
    own->ran = true;
    return true;
}

bool offload_run(struct task_graph *graph, struct worker *worker, struct task *task,
                 const duite_call *call)
{
    enum { FEW = 8 };
    duite_param few[FEW];
    size_t bytes = task->n * sizeof few[0];
    duite_param *param = task->n <= FEW ? few : base_pool_take(bytes);
    if (!param) {
        task->offloaded->failure = task_fail_memory(task);
        return false;
    }
    bool ran = offloaded_run_body(graph, worker, task, param, call);
    if (param != few)
        base_pool_give(param, bytes);
    return ran;
}

/* ---- Going home ---- */

void offload_body_over(struct worker *worker, struct task *task)
{
    struct offload_task *own = task->offloaded;
    if (own->inner)
        task_scope_end(own->inner, worker);
    else
        offload_over(&own->above, worker);
}

/* The body did not run: its failure is all there is. `told`: the scopes at home are to know it,
 * too. NULL without memory. */
static struct data_packet *result_failure(const struct data_failure *failure, bool told)
{
    struct data_packet *packet = data_packet_new(sizeof *failure, true);
    if (!packet)
        return NULL;
    *(struct data_failure *)data_payload(packet) = *failure;
    packet->pieces = MESSAGE_FAILED | (told ? MESSAGE_FAILED_BELOW : 0);
    return packet;
}

/* There is room. */
static void result_append(struct data_packet *packet, const void *from, size_t bytes)
{
    const size_t at = packet->bytes;
    data_packet_resize(packet, at + message_lines(bytes));
    offload_message_put(packet, at, from, bytes);
}

/* Appends the values that the children left of the parameters lent to them. */
static void result_append_lent(const struct task *task, struct data_packet *result)
{
    struct offload_left *answer = data_payload(result);
    for (uint32_t i = 0; i < task->n; i++) {
        if (!access_is_postponed(task, i))
            continue;
        const struct task_left_value left = task_lent_left(&task->access[i]);
        struct offload_left *to = &answer[i];
        if (left.failure)
            *to = (struct offload_left){sizeof *left.failure, LEFT_POISON};
        else if (left.values)
            *to = (struct offload_left){left.bytes, LEFT_VALUE};
        if (left.failure || left.values)
            result_append(result, left.failure ? left.failure : left.values, to->bytes);
    }
}

/* Drops the lent values, which are no longer needed. */
static void lent_drop(struct task *task)
{
    for (uint32_t i = 0; i < task->n; i++)
        if (access_is_postponed(task, i))
            task_lent_drop(&task->access[i]);
}

void offload_over(struct task_scope *above, struct worker *worker)
{
    struct offload_task *own = (struct offload_task *)above;
    struct task_graph *graph = above->graph;
    struct task *task = own->task;
    const struct data_failure *below = task_first_failure(above);
    if (own->ran) {
        result_append_lent(task, own->result);
        if (below)
            result_append(own->result, below, sizeof *below);
        if (own->failure)
            result_append(own->result, own->failure, sizeof *own->failure);
        own->result->pieces =
            MESSAGE_RAN | (below ? MESSAGE_FAILED_BELOW : 0) | (own->failure ? MESSAGE_FAILED : 0);
    } else {
        data_packet_free(own->result);
        own->result = result_failure(own->failure, below != NULL);
    }
    lent_drop(task);
    struct data_packet *result = own->result;
    own->send = (struct comm_letter){
        .key = own->message->key, .sender = task, .to = offload_home(task), .packet = result};
    if (result) {
        result->kind = DATA_RESULT;
        result->key = own->send.key;
    }
    task->state = TASK_LEAVES;
    task->n = 0; /* no value that it read is sent */
    task->send = &own->send;
    task_ready(graph, worker, task);
}

void offload_answered(struct task_graph *graph, struct task *task)
{
    struct offload_task *own = (struct offload_task *)task->scope;
    data_packet_free(own->message);
    base_pool_give(own, sizeof *own);
    base_pool_give(task, (size_t)task->grains * TASK_GRAIN);
    atomic_fetch_sub_explicit(&graph->offloaded, 1, memory_order_acq_rel);
}
