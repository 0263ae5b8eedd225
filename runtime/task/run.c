/* Running: a ready task alone touches the bytes of what it writes; when it is over they are
 * published once. */
#include "runtime/task/internal.h"

#include "runtime/base/pool.h"
#include "runtime/data/view.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int duite_fail(const duite_call *call, int code, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(call->own->text, sizeof call->own->text, format, list);
    va_end(list);
    return code;
}

/* The new version takes over the bytes of the old one. */
static const struct data_failure *inherit(const struct task *task, struct task_access *access)
{
    const struct data_failure *failure = NULL;
    struct data_version *in = access->in, *out = access->out;
    bool keep = access->waiter.mode == DUITE_RW;
    if (in) {
        out->packet = data_version_packet(in);
        failure = keep ? data_version_failure(in) : NULL;
        data_version_free(in);
        access->in = NULL;
    }
    if (out->sized && out->packet)
        out->packet = data_packet_room(out->packet, data_version_room(out), keep);
    if (!out->packet && !failure && !(out->packet = data_packet_new(data_version_room(out), false)))
        failure = task_fail_memory(task);
    return failure;
}

/* What the body gets of a version; `fresh`: it finds unspecified bytes there. */
static void describe(duite_param *param, const struct data_version *version, bool fresh)
{
    duite_type type = (duite_type)version->type;
    struct data_packet *packet = data_version_packet(version);
    param->data = packet ? data_payload(packet) : NULL;
    param->count =
        version->sized && packet && !fresh ? packet->bytes / data_type_size(type) : version->most;
    param->type = type;
    param->most = version->most;
}

static void describe_lent(duite_param *param, const struct data_object *object)
{
    *param = (duite_param){.count = object->most, .type = object->type, .most = object->most};
}

static const struct data_failure *open_leaf(const struct task *task,
                                            const struct task_access *access, duite_param *param)
{
    const struct data_sum *sum = access->sum;
    const struct data_failure *failure =
        data_sum_open(sum, access->leaf) ? NULL : task_fail_memory(task);
    struct data_packet *packet = access->leaf->packet;
    *param = (duite_param){.data = packet ? data_payload(packet) : NULL,
                           .count = sum->count,
                           .type = sum->type,
                           .most = sum->count};
    return failure;
}

/* Gives the body its parameters; returns the poison among them, or NULL. */
static const struct data_failure *prepare(struct task *task, duite_param *param, bool *sized)
{
    const struct data_failure *failure = NULL, *new = NULL;
    uint32_t stamp = task->n ? task_new_stamp() : 0;
    for (uint32_t i = 0; i < task->n; i++) {
        struct task_access *access = &task->access[i];
        switch (access->waiter.mode) {
        case DUITE_R:
            new = data_version_failure(access->in);
            describe(&param[i], access->in, false);
            break;
        case DUITE_W:
        case DUITE_RW:
            new = inherit(task, access);
            *sized |= access->out->sized;
            describe(&param[i], access->out, access->waiter.mode == DUITE_W);
            break;
        case DUITE_CW:
            new = open_leaf(task, access, &param[i]);
            break;
        default:
            new = NULL;
            describe_lent(&param[i], task_lent_object(task->inner, access->lent));
        }
        if (new)
            failure = data_first(failure, new);
        param[i].object = (duite_object){TASK_LOCAL_NAME | i, stamp};
    }
    return failure;
}

/* What it writes is poisoned, and the bytes of what it overwrites are taken over. */
static void poison(struct task *task, const struct data_failure *failure)
{
    for (uint32_t i = 0; i < task->n; i++) {
        struct task_access *access = &task->access[i];
        struct data_version *out = task_written(access);
        if (out && access->in) {
            out->packet = data_version_packet(access->in);
            data_version_free(access->in);
            access->in = NULL;
        }
        if (out)
            data_version_poison(out, failure);
        if (access->waiter.mode == DUITE_CW)
            access->leaf->failure = failure;
    }
    if (task->inner)
        task_scope_fail(task->inner, failure);
}

/* What the body says of its failure: its own sentence, or that of the call whose code it returns.
 */
static const struct data_failure *body_failed(const struct duite_call_private *body, int code)
{
    struct data_failure failure = {.code = code};
    if (!body->text[0] && code == body->remembered)
        memcpy(failure.text, body->sentence, sizeof failure.text);
    else
        memcpy(failure.text, body->text, sizeof failure.text);
    return task_fail_task(body->task, body->scope, &failure);
}

const struct data_failure *task_call_body(struct task_graph *graph, struct worker *worker,
                                          struct task *task, const void *args,
                                          const duite_param *param, struct task_scope **scope,
                                          const duite_call *template)
{
    struct duite_call_private body;
    const duite_kernel *kernel = graph->kernels[task->kernel];
    duite_call call = *template;
    body.graph = graph;
    body.worker = worker;
    body.task = task;
    body.param = param;
    body.scope = *scope;
    body.refused = DUITE_OK;
    body.remembered = DUITE_OK;
    body.text[0] = '\0';
    call.args = args;
    call.param = param;
    call.n_params = task->n;
    call.own = &body;
    task_body_begins(&body);
    int code = graph->checks ? work_check_body(graph->pool, kernel, task->number, &call)
                             : kernel->body(&call);
    task_body_ends(&body);
    *scope = body.scope;
    if (!code)
        code = body.refused;
    if (!code)
        code = body.remembered;
    return code ? body_failed(&body, code) : NULL;
}

static const struct data_failure no_memory = {
    .code = DUITE_E_MEMORY, .kernel = UINT32_MAX, .text = "there was no memory to fork it"};
static const struct data_failure lost = {
    .code = DUITE_E_MPI, .kernel = UINT32_MAX, .text = "communication between the ranks broke"};

const struct data_failure *task_lost_failure(void)
{
    return &lost;
}

const struct data_failure *task_given_up(struct task_graph *graph)
{
    return atomic_load_explicit(&graph->given_up, memory_order_relaxed) ? &lost : NULL;
}

static void run_view(struct task *task)
{
    struct data_version *in = task->access[0].in, *out = task->access[1].out;
    const struct data_failure *failure =
        data_first(data_version_failure(in), inherit(task, &task->access[1]));
    if (!failure)
        data_view_gather(task->view, data_type_size((duite_type)in->type), data_payload(in->packet),
                         data_payload(out->packet));
    data_version_poison(out, failure);
    data_view_release(task->view);
}

static void run_copy(struct task_graph *graph, struct task *task)
{
    struct task_copy *copy = task->copy;
    const struct data_version *version = task->access[0].in;
    copy->failure = data_version_failure(version);
    if (!copy->failure)
        copy->bytes = version->packet->bytes;
    if (!copy->failure && copy->values)
        memcpy(copy->values, data_payload(version->packet), copy->bytes);
    atomic_store_explicit(&copy->done, 1, memory_order_release);
    work_notify(graph->pool);
}

/* What is done instead of a body's work. */
struct stand_in {
    struct data_packet *result; /* what it left on another rank; NULL: it is lost */
};

/* Whether the body ran; `instead` NULL: it is to run here. */
static bool run_body(struct task_graph *graph, struct worker *worker, struct task *task,
                     duite_param *param, const duite_call *call, const struct stand_in *instead)
{
    bool sized = false; /* it writes an object that changes its size */
    const struct data_failure *failure = prepare(task, param, &sized);
    if (!failure && !instead)
        failure = task_given_up(graph);
    bool runs = !failure && !instead;
    size_t args_size = graph->kernels[task->kernel]->args_size;
    if (runs)
        failure = task_call_body(graph, worker, task, args_size ? task_rest(task, task->n) : NULL,
                                 param, &task->inner, call);
    else if (!failure)
        failure = offload_take_result(task, param, instead->result);
    if (failure)
        poison(task, failure);
    else if (sized)
        task_size_close(task, param);
    return runs;
}

/* The same with memory for the parameters. */
static bool run_task(struct task_graph *graph, struct worker *worker, struct task *task,
                     const duite_call *call, const struct stand_in *instead)
{
    enum { FEW = 8 };
    duite_param few[FEW];
    if (task->n <= FEW)
        return run_body(graph, worker, task, few, call, instead);
    duite_param *param = base_pool_take(task->n * sizeof *param);
    if (!param) {
        poison(task, task_fail_memory(task));
        return false;
    }
    bool ran = run_body(graph, worker, task, param, call, instead);
    base_pool_give(param, task->n * sizeof *param);
    return ran;
}

void offload_run_result(struct task_graph *graph, struct task *task, struct data_packet *result)
{
    run_task(graph, NULL, task, NULL, &(struct stand_in){result});
}

bool task_run(struct task_graph *graph, struct worker *worker, struct task *task,
              const duite_call *call)
{
    switch (task->kind) {
    case TASK_BODY:
        return run_task(graph, worker, task, call, NULL);
    case TASK_VOID:
        poison(task, &no_memory);
        break;
    case TASK_COMBINE:
        task_run_combine(task);
        break;
    case TASK_PIECES:
        task_run_pieces(task);
        break;
    case TASK_GATHER:
        task_run_gather(task);
        break;
    case TASK_VIEW:
        run_view(task);
        break;
    case TASK_COPY:
        run_copy(graph, task);
        break;
    case TASK_MOVE:
        break;
    case TASK_REPLAY:
        plan_replay_run(task);
        break;
    case TASK_NODE:
    case TASK_NODE_SET:
    case TASK_NODE_SUM:
    case TASK_NODE_PARTIAL:
    case TASK_NODE_COPY:
    case TASK_NODE_VIEW:
    case TASK_NODE_FLAG:
        return plan_node_run(graph, worker, task, call);
    case TASK_GUEST:
        return offload_guest_run(graph, worker, task, call);
    case TASK_SEND:
    case TASK_AWAY:
    case TASK_RESULT:
    case TASK_NODE_SEND:
    case TASK_NODE_RECEIVE:
        break;
    }
    return false;
}

const char *task_own_name(uint32_t kind)
{
    static const char *const own[] = {
        [TASK_COMBINE] = "duite_sum",      [TASK_PIECES] = "duite_sum",
        [TASK_GATHER] = "duite_sum",       [TASK_VIEW] = "duite_view",
        [TASK_COPY] = "duite_get",         [TASK_MOVE] = "duite_replay",
        [TASK_VOID] = "duite_fork",        [TASK_REPLAY] = "duite_replay",
        [TASK_NODE_SET] = "duite_set",     [TASK_NODE_SUM] = "duite_sum",
        [TASK_NODE_PARTIAL] = "duite_sum", [TASK_NODE_COPY] = "duite_replay",
        [TASK_NODE_VIEW] = "duite_view",   [TASK_NODE_FLAG] = "duite_replay_while"};
    const char *name = kind < sizeof own / sizeof own[0] ? own[kind] : NULL;
    return name ? name : "duite";
}

void task_finish(struct task_graph *graph, struct worker *worker, struct task *task)
{
    if (task->kind > TASK_REPLAY)
        plan_node_finish(graph, worker, task);
    else if (task->kind == TASK_REPLAY)
        plan_replay_start(graph, worker, task);
    else if (task->kind == TASK_GUEST)
        offload_guest_finish(worker, task);
    else if (task->kind == TASK_RESULT)
        offload_guest_gone(graph, task);
    else if (task->kind == TASK_AWAY)
        offload_away_sent(graph, worker, task);
    else
        task_over(graph, worker, task);
}

static void release(struct task_graph *graph, struct worker *worker,
                    const struct task_access *access)
{
    switch (access->waiter.mode) {
    case DUITE_R:
        task_release(graph, worker, access->in);
        break;
    case DUITE_W:
    case DUITE_RW:
        task_publish(graph, worker, access->out);
        break;
    case DUITE_CW:
        task_wake(graph, worker, data_sum_release(access->sum));
        break;
    default: /* postponed: the scope's */
        break;
    }
}

void task_over(struct task_graph *graph, struct worker *worker, struct task *task)
{
    for (uint32_t i = 0; i < task->n; i++)
        release(graph, worker, &task->access[i]);
    struct task_scope *scope = task->scope;
    struct task_scope *inner =
        task->kind == TASK_BODY || task->kind == TASK_VOID ? task->inner : NULL;
    base_pool_give(task, (size_t)task->grains * TASK_GRAIN);
    if (inner)
        task_scope_end(inner, worker); /* it leaves `scope` when its children have */
    else
        task_left(graph, scope, worker);
}

void task_lost(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    data_version_poison(version, &lost);
    task_publish(graph, worker, version);
}

void task_pieces_lost(struct task_graph *graph, struct worker *worker, struct data_sum *sum)
{
    atomic_store_explicit(&sum->lost, &lost, memory_order_relaxed);
    task_wake(graph, worker, data_sum_release(sum));
}

void task_arrived(struct task_graph *graph, struct worker *worker, struct data_version *version,
                  struct data_packet *packet)
{
    if (packet->kind == DATA_POISON) {
        data_version_poison(version, task_fail(graph, data_payload(packet), false));
        data_packet_free(packet);
    } else {
        version->packet = packet;
    }
    task_publish(graph, worker, version);
}
