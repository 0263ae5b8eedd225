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
static const struct data_failure *inherit(struct graph *graph, struct graph_task *task,
                                          struct graph_access *access)
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
        failure = graph_fail_memory(graph, task);
    return failure;
}

/* Gives the body its parameters; returns the poison among them, or NULL. */
static const struct data_failure *prepare(struct graph *graph, struct graph_task *task)
{
    const struct data_failure *failure = NULL;
    for (uint32_t i = 0; i < task->n; i++) {
        struct graph_access *access = &task->access[i];
        struct data_packet *packet = NULL;
        if (access->mode == DUITE_R) {
            failure = data_first(failure, access->in->failure);
            packet = access->in->packet;
        } else if (access->mode == DUITE_CW) {
            if (!data_sum_open(access->sum, access->leaf))
                failure = data_first(failure, graph_fail_memory(graph, task));
            packet = access->leaf->packet;
        } else {
            failure = data_first(failure, inherit(graph, task, access));
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
    for (uint32_t i = 0; i < task->n; i++) {
        if (task->access[i].out)
            task->access[i].out->failure = failure;
        if (task->access[i].leaf)
            task->access[i].leaf->failure = failure;
    }
}

/* Calls the body; returns its failure, or NULL. */
static const struct data_failure *call_body(struct graph *graph, struct graph_task *task,
                                            duite_call *call)
{
    call->args = task->args;
    call->param = task->param;
    call->n_params = task->n;
    *call->own = (struct duite_call_private){.task = task};
    const duite_kernel *kernel = graph->kernels[task->kernel];
    int code = graph->hooks.body
                   ? graph->hooks.body(graph->hooks.context, kernel, task->number, call)
                   : kernel->body(call);
    if (!code)
        code = call->own->refused;
    if (!code) {
        graph_size_close(task);
        return NULL;
    }
    struct data_failure failure = {
        .code = code, .rank = graph->rank, .number = task->number, .kernel = task->kernel};
    memcpy(failure.text, call->own->text, sizeof failure.text);
    return graph_fail(graph, &failure, true);
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

bool graph_run(struct graph *graph, struct graph_task *task, duite_call *call)
{
    const struct data_failure *failure;
    bool ran = false;
    switch (task->kind) {
    case GRAPH_BODY:
        failure = prepare(graph, task);
        if (!failure)
            failure = graph_given_up(graph);
        ran = !failure;
        if (!failure)
            failure = call_body(graph, task, call);
        if (failure)
            poison(task, failure);
        break;
    case GRAPH_VOID:
        prepare(graph, task);
        poison(task, &no_memory);
        break;
    case GRAPH_COMBINE:
        graph_run_combine(graph, task);
        break;
    case GRAPH_PIECES:
        graph_run_pieces(graph, task);
        break;
    case GRAPH_COPY:
        run_copy(graph, task);
        break;
    case GRAPH_REPLAY:
        graph_replay_run(graph, task);
        break;
    case GRAPH_NODE:
    case GRAPH_NODE_SET:
    case GRAPH_NODE_SUM:
    case GRAPH_NODE_FLAG:
        return graph_node_run(graph, task, call);
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
        else
            graph_release(graph, worker, access->in);
    }
    base_pool_give(task, task->size);
    uint64_t left = atomic_fetch_sub_explicit(&graph->unfinished, 1, memory_order_acq_rel) - 1;
    if (left == 0 || left == graph->resume)
        graph->hooks.notify(graph->hooks.context);
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
