/* Running: a ready task alone touches the bytes of what it writes; when it is over they are
 * published once. */
#include "runtime/graph/internal.h"

#include "runtime/base/pool.h"

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
static const struct data_failure *inherit(struct graph_task *task, struct graph_access *access)
{
    const struct data_failure *failure = NULL;
    if (access->in) {
        access->out->packet = access->in->packet;
        failure = access->mode == DUITE_RW ? access->in->failure : NULL;
        data_version_free(access->in);
        access->in = NULL;
    }
    if (access->sized && access->out->packet)
        access->out->packet =
            data_packet_room(access->out->packet, access->bytes, access->mode == DUITE_RW);
    if (!access->out->packet && !failure &&
        !(access->out->packet = data_packet_new(access->bytes, false)))
        failure = graph_fail_memory(task);
    return failure;
}

/* Gives the body its parameters; returns the poison among them, or NULL. */
static const struct data_failure *prepare(struct graph_task *task)
{
    const struct data_failure *failure = NULL;
    for (uint32_t i = 0; i < task->n; i++) {
        struct graph_access *access = &task->access[i];
        struct data_packet *packet = NULL;
        if (graph_postponed(access->mode))
            continue;
        if (access->mode == DUITE_R) {
            failure = data_first(failure, access->in->failure);
            packet = access->in->packet;
        } else if (access->mode == DUITE_CW) {
            if (!data_sum_open(access->sum, access->leaf))
                failure = data_first(failure, graph_fail_memory(task));
            packet = access->leaf->packet;
        } else {
            failure = data_first(failure, inherit(task, access));
            packet = access->out->packet;
        }
        task->param[i].data = packet ? data_payload(packet) : NULL;
        if (access->sized)
            graph_size_open(task, i, packet);
    }
    return failure;
}

static void poison(struct graph_task *task, const struct data_failure *failure)
{
    task->failure = failure;
    for (uint32_t i = 0; i < task->n; i++) {
        if (task->access[i].out)
            task->access[i].out->failure = failure;
        if (task->access[i].leaf)
            task->access[i].leaf->failure = failure;
    }
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
    return graph_fail_task(body->task, &failure);
}

const struct data_failure *graph_call_body(struct graph *graph, void *worker,
                                           struct graph_task *task, const void *args,
                                           const duite_call *template)
{
    struct duite_call_private body;
    const duite_kernel *kernel = graph->kernels[task->kernel];
    duite_call call = *template;
    body.graph = graph;
    body.worker = worker;
    body.task = task;
    body.refused = DUITE_OK;
    body.remembered = DUITE_OK;
    body.text[0] = '\0';
    call.args = args;
    call.param = task->param;
    call.n_params = task->n;
    call.own = &body;
    graph_body_begins(&body);
    int code = graph->hooks.body
                   ? graph->hooks.body(graph->hooks.context, kernel, task->number, &call)
                   : kernel->body(&call);
    graph_body_ends(&body);
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

const struct data_failure *graph_given_up(struct graph *graph)
{
    return atomic_load_explicit(&graph->given_up, memory_order_relaxed) ? &lost : NULL;
}

static void run_copy(struct graph *graph, struct graph_task *task)
{
    struct graph_copy *copy = task->copy;
    const struct data_version *version = task->access[0].in;
    copy->failure = version->failure;
    if (!version->failure)
        copy->bytes = version->packet->bytes;
    if (!version->failure && copy->values)
        memcpy(copy->values, data_payload(version->packet), copy->bytes);
    atomic_store_explicit(&copy->done, 1, memory_order_release);
    graph->hooks.notify(graph->hooks.context);
}

bool graph_run(struct graph *graph, void *worker, struct graph_task *task, const duite_call *call)
{
    const struct data_failure *failure;
    bool ran = false;
    switch (task->kind) {
    case GRAPH_BODY:
        failure = prepare(task);
        if (!failure)
            failure = graph_given_up(graph);
        ran = !failure;
        if (!failure)
            failure = graph_call_body(graph, worker, task, task->args, call);
        if (!failure)
            graph_size_close(task);
        if (failure)
            poison(task, failure);
        break;
    case GRAPH_VOID:
        prepare(task);
        poison(task, &no_memory);
        break;
    case GRAPH_COMBINE:
        graph_run_combine(task);
        break;
    case GRAPH_PIECES:
        graph_run_pieces(task);
        break;
    case GRAPH_GATHER:
        graph_run_gather(task);
        break;
    case GRAPH_COPY:
        run_copy(graph, task);
        break;
    case GRAPH_REPLAY:
        graph_replay_run(task);
        break;
    case GRAPH_NODE:
    case GRAPH_NODE_SET:
    case GRAPH_NODE_SUM:
    case GRAPH_NODE_FLAG:
        return graph_node_run(graph, worker, task, call);
    case GRAPH_SEND:
        break;
    }
    return ran;
}

void graph_finish(struct graph *graph, void *worker, struct graph_task *task)
{
    if (task->kind > GRAPH_REPLAY)
        graph_node_finish(graph, worker, task);
    else if (task->kind == GRAPH_REPLAY)
        graph_replay_start(graph, worker, task);
    else
        graph_over(graph, worker, task);
}

void graph_over(struct graph *graph, void *worker, struct graph_task *task)
{
    for (uint32_t i = 0; i < task->n; i++) {
        struct graph_access *access = &task->access[i];
        if (access->out)
            graph_publish(graph, worker, access->out);
        else if (access->sum)
            graph_wake(graph, worker, data_sum_release(access->sum));
        else if (access->in)
            graph_release(graph, worker, access->in);
    }
    struct graph_scope *scope = task->scope, *inner = task->inner;
    const struct data_failure *failure = task->failure;
    base_pool_give(task, task->size);
    if (inner)
        graph_scope_end(inner, worker, failure); /* it leaves `scope` when its children have */
    else
        graph_left(graph, scope, worker);
}

void graph_lost(struct graph *graph, void *worker, struct data_version *version)
{
    version->failure = &lost;
    graph_publish(graph, worker, version);
}

void graph_pieces_lost(struct graph *graph, void *worker, struct data_sum *sum)
{
    atomic_store_explicit(&sum->lost, &lost, memory_order_relaxed);
    graph_wake(graph, worker, data_sum_release(sum));
}

void graph_arrived(struct graph *graph, void *worker, struct data_version *version,
                   struct data_packet *packet)
{
    if (packet->kind == DATA_POISON) {
        version->failure = graph_fail(graph, data_payload(packet), false);
        data_packet_free(packet);
    } else {
        version->packet = packet;
    }
    graph_publish(graph, worker, version);
}
