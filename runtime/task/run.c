/* Running, the fourth stage of a task: a ready task alone accesses the bytes of its outputs. Poison
 * in its inputs goes on to its outputs, and its body does not run. Publishing comes later:
 * finish.c. */
#include "runtime/task/call.h"
#include "runtime/task/event.h"

#include "runtime/base/memory.h"
#include "runtime/data/object.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- The parameters of a body ---- */

/* Gives the written version bytes if it has none that fit. */
static const struct data_failure *version_make_room(const struct task *task,
                                                    struct data_version *out, bool keep)
{
    const size_t room = data_version_room(out);
    if (out->packet && out->sized)
        out->packet = data_packet_room(out->packet, room, keep);
    if (!out->packet)
        out->packet = room <= BASE_LINE ? data_packet_line(room) : data_packet_new(room, false);
    return out->packet ? NULL : task_fail_memory(task);
}

/* Makes sure that the written version has enough bytes; it may have those of the version before it.
 * Returns the poison in place of bytes, or NULL. */
static inline const struct data_failure *version_prepare(const struct task *task,
                                                         const struct task_access *access)
{
    struct data_version *out = access->waiter.version;
    if (out->poisoned)
        return out->failure;
    return out->packet && !out->sized
               ? NULL
               : version_make_room(task, out, access->waiter.mode == DUITE_RW);
}

/* True for most versions: with bytes behind their header, without poison, and with a fixed number
 * of elements. */
static inline bool version_is_usual(const struct data_version *version)
{
    return !version->sized && !version->adopted && !version->poisoned && version->packet;
}

/* The parameter for a version with bytes here. */
static inline void param_describe(duite_param *param, const struct data_version *version,
                                  void *data)
{
    param->data = data;
    param->count = version->max;
    param->type = (duite_type)version->type;
    param->max = version->max;
}

/* The parameter for any version; under w the bytes are unspecified. Returns the poison in place of
 * bytes, or NULL. */
static const struct data_failure *
param_prepare_version(const struct task *task, const struct task_access *access, duite_param *param)
{
    struct data_version *version = access->waiter.version;
    const duite_mode mode = (duite_mode)access->waiter.mode;
    const struct data_failure *failure =
        mode == DUITE_R ? data_version_failure(version) : version_prepare(task, access);
    if (failure)
        return failure;
    param_describe(param, version, data_payload(version->packet));
    if (version->sized && mode != DUITE_W)
        param->count = version->packet->bytes / data_type_size(param->type);
    return NULL;
}

static const struct data_failure *leaf_open(const struct task *task,
                                            const struct task_access *access, duite_param *param)
{
    const struct data_sum *sum = access->leaf->sum;
    const struct data_failure *failure =
        data_sum_open(sum, access->leaf) ? NULL : task_fail_memory(task);
    struct data_packet *packet = access->leaf->packet;
    *param = (duite_param){.data = packet ? data_payload(packet) : NULL,
                           .count = sum->count,
                           .type = sum->type,
                           .max = sum->count};
    return failure;
}

/* Slow path: other versions, contributions, postponed parameters. */
__attribute__((noinline)) static const struct data_failure *
param_prepare_other(const struct task *task, const struct task_access *access, duite_param *param)
{
    if (access->waiter.mode <= DUITE_RW)
        return param_prepare_version(task, access, param);
    if (access->waiter.mode == DUITE_CW)
        return leaf_open(task, access, param);
    const struct data_object *lent = task_lent_object(task->inner, access->lent);
    *param = (duite_param){.count = lent->max, .type = lent->type, .max = lent->max};
    return NULL;
}

/* Gives the body its parameters; returns the poison among them, or NULL. *other: some are no usual
 * versions. */
__attribute__((always_inline)) static inline const struct data_failure *
params_prepare(struct task *task, duite_param *param, bool *other)
{
    const struct data_failure *failure = NULL;
    struct task_access *access = task->access, *const end = access + task->n;
    duite_object name = {TASK_LOCAL_NAME, access < end ? task_new_stamp() : 0};
    for (; access < end; access++, param++, name.slot++) {
        if (access->waiter.mode <= DUITE_RW && version_is_usual(access->waiter.version)) {
            struct data_version *version = access->waiter.version;
            param_describe(param, version, version->packet + 1); /* without a look at the header */
        } else {
            const struct data_failure *new = param_prepare_other(task, access, param);
            *other = true;
            if (new)
                failure = data_failure_first(failure, new);
        }
        param->object = name;
    }
    return failure;
}

/* ---- The body ---- */

int duite_fail(const duite_call *call, int code, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(call->own->text, sizeof call->own->text, format, list);
    va_end(list);
    return code;
}

int duite_fail_text(const duite_call *call, int code, const char *text)
{
    snprintf(call->own->text, sizeof call->own->text, "%s", text);
    return code;
}

/* The message is the body's own, or that of the call whose code it returns. */
const struct data_failure *task_body_failure(const struct duite_call_private *body, int code)
{
    struct data_failure failure = {.code = code};
    const bool holds_mpi = task_holds_mpi(body);
    if (holds_mpi)
        comm_guests_let_go(&body->graph->guests);
    if (holds_mpi && !body->text[0])
        snprintf(failure.text, sizeof failure.text,
                 "it returned between duite_mpi_begin and duite_mpi_end");
    else if (!body->text[0] && code == body->remembered)
        memcpy(failure.text, body->message, sizeof failure.text);
    else
        memcpy(failure.text, body->text, sizeof failure.text);
    return task_fail_task(body->task, body->scope, &failure);
}

void task_poison_outputs(struct task *task, const struct data_failure *failure)
{
    for (uint32_t i = 0; i < task->n; i++) {
        const struct task_access *access = &task->access[i];
        struct data_version *out = task_written(access);
        if (out)
            data_version_poison(out, failure);
        if (access->waiter.mode == DUITE_CW)
            access->leaf->failure = failure;
    }
    if (task->inner)
        task_scope_fail(task->inner, failure);
}

/* Gives the outputs the sizes that the body set. */
static void outputs_resize(struct task *task, const duite_param *param)
{
    for (uint32_t i = 0; i < task->n; i++) {
        struct data_version *out = task_written(&task->access[i]);
        if (out && out->sized)
            data_packet_resize(out->packet, param[i].count * data_type_size(param[i].type));
    }
}

/* The results of a body that another rank ran: `take` fills the parameters with them. */
struct body_elsewhere {
    task_take_result *take;
    struct data_packet *result;
};

/* Returns true if the body ran here, in the frame; `elsewhere` is NULL unless another rank ran it.
 * Inline because its callers pass constants. */
__attribute__((always_inline)) static inline bool body_run(struct task_graph *graph,
                                                           struct task_frame *frame,
                                                           struct task *task, duite_param *param,
                                                           const struct body_elsewhere *elsewhere)
{
    bool other = false; /* it may write an object that changes its size */
    const struct data_failure *failure = params_prepare(task, param, &other);
    if (!failure && !elsewhere)
        failure = task_given_up(graph);
    const bool runs = !failure && !elsewhere;
    if (runs) {
        const bool has_args = frame->body.graph->kernels[task->kernel]->args_size != 0;
        frame->call.round = task->later ? task_later_round(task) : 0;
        failure = task_frame_call(frame, task, has_args ? task_rest(task, task->n) : NULL, param,
                                  &task->inner);
    } else if (!failure) {
        failure = elsewhere->take(task, param, elsewhere->result);
    }
    if (failure && task->state == TASK_HELD)
        task_held_fail(frame->body.held, failure);
    else if (failure)
        task_poison_outputs(task, failure);
    else if (other)
        outputs_resize(task, param);
    return runs;
}

/* The same with memory for any number of parameters. */
static bool body_run_any(struct task_graph *graph, struct task_frame *frame, struct task *task,
                         const struct body_elsewhere *elsewhere)
{
    const size_t bytes = (task->n ? task->n : 1) * sizeof(duite_param);
    duite_param *param = base_pool_take(bytes);
    if (!param) {
        task_poison_outputs(task, task_fail_memory(task));
        return false;
    }
    bool ran = body_run(graph, frame, task, param, elsewhere);
    base_pool_give(param, bytes);
    return ran;
}

bool task_run_body(struct task_frame *frame, struct task *task)
{
    enum { FEW = 8 };
    duite_param param[FEW];
    if (task->n > FEW)
        return body_run_any(frame->body.graph, frame, task, NULL);
    return body_run(frame->body.graph, frame, task, param, NULL);
}

void task_run_result(struct task_graph *graph, struct task *task, task_take_result *take,
                     struct data_packet *result)
{
    body_run_any(graph, NULL, task, &(struct body_elsewhere){take, result});
}

/* ---- By type ---- */

static void copy_run(struct task_graph *graph, struct task *task)
{
    struct task_copy *copy = task->copy;
    const struct data_version *version = task->access[0].waiter.version;
    copy->failure = data_version_failure(version);
    if (!copy->failure)
        copy->bytes = version->packet->bytes;
    if (!copy->failure && copy->values)
        memcpy(copy->values, data_payload(version->packet), copy->bytes);
    atomic_store_explicit(&copy->done, 1, memory_order_release);
    queue_notify(graph->pool);
}

static const struct data_failure fork_no_memory = {
    .code = DUITE_E_MEMORY, .kernel = UINT32_MAX, .text = "there was no memory to fork it"};

bool task_run(struct task_graph *graph, struct worker *worker, struct task *task,
              const duite_call *call)
{
    if (task->state == TASK_VOID) {
        task_poison_outputs(task, &fork_no_memory);
        return false;
    }
    if (task->state == TASK_ENDED)
        return false;
    struct task_frame frame; /* of a body; not set otherwise */
    switch (task->type) {
    case TASK_BODY:
        task_frame_init(&frame, graph, worker, call);
        if (task->state == TASK_HELD)
            task_held_start(frame.body.held = task_held_of(graph, task));
        return task_run_body(&frame, task);
    case TASK_COMBINE:
        task_run_combine(task);
        break;
    case TASK_PIECES:
        task_run_pieces(task);
        break;
    case TASK_GATHER:
        task_run_gather(task);
        break;
    case TASK_COPY:
        copy_run(graph, task);
        break;
    case TASK_LEAVE:
        task_run_leave(task);
        break;
    default: /* nothing is left to do: a MOVE has come, a SEND is sent */
        break;
    }
    return false;
}
