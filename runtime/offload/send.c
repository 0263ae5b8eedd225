/* Delegated tasks, at home. The versions that such a task reads and takes over stay here, held by
 * it as before, so nothing changes for the tasks that wait for it. Its result is expected like any
 * other packet, under a name: a number, never an address, which no other task gets. The task goes
 * on when two things happened, in any order: its packet is sent, and the result came. */
#include "runtime/offload/message.h"

#include "runtime/base/memory.h"
#include "runtime/data/law.h"

#include <string.h>

/* ---- Going ---- */

size_t offload_message_put(struct data_packet *packet, size_t at, const void *from, size_t bytes)
{
    char *to = (char *)data_payload(packet) + at;
    size_t end = message_lines(at + bytes);
    if (bytes)
        memmove(to, from, bytes);
    memset(to + bytes, 0, end - at - bytes);
    return end;
}

/* The object lent for access i if it is postponed, else NULL. */
static const struct data_object *access_lent(const struct task *task, size_t i)
{
    const struct task_access *access = &task->access[i];
    return task_postponed((duite_mode)access->waiter.mode)
               ? task_lent_object(task->inner, access->lent)
               : NULL;
}

/* The value that is sent along, if the body or a child may read it, else NULL. The version that a
 * ready task changes has the value already. */
static const struct data_version *access_value(const struct task *task, size_t i)
{
    const struct data_object *lent = access_lent(task, i);
    if (!data_order_reads(task_immediate((duite_mode)task->access[i].waiter.mode)))
        return NULL;
    return lent ? lent->current : task->access[i].waiter.version;
}

/* A body waits for the values that it reads, but not for those that its children read. */
static bool value_may_go(const struct task *task, size_t i, const struct data_version *value)
{
    return (!access_lent(task, i) || data_version_ready(value)) && data_version_packet(value);
}

static struct offload_param access_param(const struct task *task, size_t i)
{
    const struct task_access *access = &task->access[i];
    const struct data_object *lent = access_lent(task, i);
    const struct data_version *in = access_value(task, i), *out = task_written(access);
    const struct data_version *version = in ? in : out;
    if (lent)
        return (struct offload_param){.bytes = in ? in->packet->bytes : 0,
                                      .max = lent->max,
                                      .type = lent->type,
                                      .sized = lent->sized};
    if (!version)
        return (struct offload_param){.max = access->leaf->sum->count,
                                      .type = access->leaf->sum->type};
    return (struct offload_param){.bytes = in ? in->packet->bytes : 0,
                                  .max = version->max,
                                  .type = version->type,
                                  .sized = version->sized};
}

/* True if the task's place is not cut off: places tell the ranks which task comes first. */
static bool place_is_whole(const struct task *task)
{
    struct data_failure place = {0};
    if (task->scope == &task->scope->graph->root)
        return true;
    task_failure_place(&place, task, NULL);
    return place.path_length < sizeof place.path;
}

bool offload_may_go(const struct task_graph *graph, const struct task *task, size_t *bytes)
{
    if (task->type != TASK_BODY || task->state != TASK_LOCAL || task->at_rank)
        return false;
    const duite_kernel *kernel = graph->kernels[task->kernel];
    if (kernel->side_effects || kernel->fixed || kernel->replicated)
        return false;
    size_t there = message_args_at(task->n) + kernel->args_size, back = message_values_at(task->n);
    for (uint32_t i = 0; i < task->n; i++) {
        const struct data_version *in = access_value(task, i);
        if (in && !value_may_go(task, i, in))
            return false;
        const struct offload_param param = access_param(task, i);
        there += in ? message_lines(in->packet->bytes) + 64 : 0;
        back += message_lines(message_room(task->access[i].waiter.mode, &param));
    }
    *bytes = there + back + 2 * sizeof(struct data_packet);
    return there < DATA_MAX_BYTES && back < DATA_MAX_BYTES && place_is_whole(task);
}

static struct offload_message message_of_task(const struct task *task)
{
    struct data_failure place = {0};
    task_failure_place(&place, task, NULL);
    struct offload_message message = {.number = place.number,
                                      .index = task->number,
                                      .round = task->later ? task_later_round(task) : 0,
                                      .kernel = task->kernel,
                                      .n = task->n,
                                      .block = task->block,
                                      .priority = task->priority,
                                      .cost = task->cost,
                                      .path_length = place.path_length};
    memcpy(message.path, place.path, sizeof message.path);
    return message;
}

/* NULL without memory. */
static struct data_packet *message_pack(const struct task_graph *graph, struct task *task)
{
    const struct offload_message message = message_of_task(task);
    size_t args = graph->kernels[task->kernel]->args_size, n = task->n;
    size_t bytes = message_args_at(n) + message_lines(args);
    for (size_t i = 0; i < n; i++)
        bytes += message_value(task->access[i].waiter.mode, access_param(task, i).bytes);
    struct data_packet *packet = data_packet_new(bytes, false);
    if (!packet)
        return NULL;
    struct offload_param *param = (void *)((char *)data_payload(packet) + sizeof message);
    memset(data_payload(packet), 0, message_args_at(n));
    memcpy(data_payload(packet), &message, sizeof message);
    size_t at = offload_message_put(packet, message_args_at(n), task_rest(task, n), args);
    for (size_t i = 0; i < n; i++) {
        const struct data_version *in = access_value(task, i);
        param[i] = access_param(task, i);
        if (in)
            offload_message_put(packet, at, data_payload(in->packet), in->packet->bytes);
        at += message_value(task->access[i].waiter.mode, param[i].bytes);
    }
    return packet;
}

/* At home: a delegated task, until its result came. */
struct offload_pending {
    struct comm_letter send;    /* first: the task's */
    struct task_scope *inner;   /* the task's, while `send` has its place */
    _Atomic int left;           /* it is sent; it came back */
    struct data_packet *result; /* NULL: lost */
};

static struct offload_pending *pending_of(struct task *task)
{
    return (struct offload_pending *)task->send;
}

/* The task is here again. */
static void pending_end(struct offload_pending *pending)
{
    struct task *task = pending->send.sender;
    task->state = TASK_LOCAL;
    task->inner = pending->inner;
    base_pool_give(pending, sizeof *pending);
}

static comm_arrived result_arrived;

bool offload_send(struct task_graph *graph, struct worker *worker, struct task *task, int to)
{
    struct data_packet *packet = message_pack(graph, task);
    struct offload_pending *pending = packet ? base_pool_take(sizeof *pending) : NULL;
    if (!pending) {
        data_packet_free(packet);
        return false;
    }
    packet->kind = DATA_OFFLOADED;
    packet->key = (struct data_key){.slot = (uint32_t)graph->rank,
                                    .number = 1 + atomic_fetch_add(&graph->delegated, 1)};
    *pending = (struct offload_pending){
        .send = {.key = packet->key, .packet = packet, .sender = task, .to = to},
        .inner = task->inner,
        .left = 2};
    task->state = TASK_DELEGATED;
    task->send = &pending->send;
    const struct comm_target home = {
        .arrived = result_arrived, .what = task, .from = to, .result = true};
    if (comm_expect(graph->comm, worker, packet->key, home, 1)) {
        pending_end(pending);
        data_packet_free(packet);
        return false;
    }
    task_ready(graph, worker, task);
    return true;
}

/* ---- Coming home ---- */

/* The body failed: as if it had failed here. */
static const struct data_failure *result_unpack_failure(const struct task *task,
                                                        struct data_packet *packet)
{
    struct task_graph *graph = task->scope->graph;
    const size_t bytes = message_lines(sizeof(struct data_failure));
    const bool ran = packet->pieces & MESSAGE_RAN;
    const char *last = (const char *)data_payload(packet) + (ran ? packet->bytes - bytes : 0);
    const struct data_failure *failure = task_fail(graph, (const void *)last, NULL);
    if (!ran && packet->pieces & MESSAGE_FAILED_BELOW)
        task_fail(graph, failure, task->scope);
    return failure;
}

/* Gives the parameters the values that the body left. Returns its failure, if it failed. */
static const struct data_failure *result_unpack(const struct task *task, duite_param *param,
                                                struct data_packet *packet)
{
    const struct offload_left *answer = data_payload(packet);
    const char *from = (const char *)answer + message_values_at(task->n);
    if (packet->pieces & MESSAGE_FAILED)
        return result_unpack_failure(task, packet);
    for (uint32_t i = 0; i < task->n; i++) {
        const uint64_t bytes = answer[i].bytes;
        if (access_lent(task, i))
            continue;
        if (bytes)
            memcpy(param[i].data, from, bytes);
        if (task->access[i].waiter.mode != DUITE_R)
            param[i].count = bytes / data_type_size(param[i].type);
        from += message_lines(bytes);
    }
    return NULL;
}

static struct task_left_value left_unpack(struct task_graph *graph, const struct offload_left *left,
                                          const char *from)
{
    if (left->what == LEFT_NOTHING)
        return (struct task_left_value){0};
    if (left->what == LEFT_POISON)
        return (struct task_left_value){.failure = task_fail(graph, (const void *)from, NULL)};
    return (struct task_left_value){.values = from, .bytes = left->bytes};
}

/* Takes the values that the descendants left, and the first failure. The task's own scope is there
 * again. */
static void result_unpack_below(struct task *task, struct worker *worker,
                                struct data_packet *packet)
{
    struct task_graph *graph = task->scope->graph;
    const struct offload_left *answer = data_payload(packet);
    const char *from = (const char *)answer + message_values_at(task->n);
    for (uint32_t i = 0; i < task->n; i++)
        from += access_lent(task, i) ? 0 : message_lines(answer[i].bytes);
    for (uint32_t i = 0; i < task->n; i++) {
        if (!access_lent(task, i))
            continue;
        const struct task_left_value left = left_unpack(graph, &answer[i], from);
        if (task->access[i].waiter.mode != DUITE_RP)
            task_lent_comes_home(task->inner, worker, task->access[i].lent, &left);
        from += message_lines(answer[i].bytes);
    }
    if (packet->pieces & MESSAGE_FAILED_BELOW)
        task_fail(graph, (const void *)from, task->scope);
}

static const struct data_failure *result_take(const struct task *task, duite_param *param,
                                              struct data_packet *result)
{
    return result ? result_unpack(task, param, result) : &task_lost_failure;
}

/* One of two things happened; `pending` may be gone afterwards, and the task. */
static void pending_one_less(struct task_graph *graph, struct worker *worker,
                             struct offload_pending *pending)
{
    struct task *task = pending->send.sender;
    if (atomic_fetch_sub_explicit(&pending->left, 1, memory_order_acq_rel) != 1)
        return;
    struct data_packet *result = pending->result;
    pending_end(pending);
    task_run_result(graph, task, result_take, result);
    if (result && result->pieces & MESSAGE_RAN)
        result_unpack_below(task, worker, result);
    data_packet_free(result);
    task_finish(graph, worker, task);
}

void offload_sent(struct task_graph *graph, struct worker *worker, struct task *task)
{
    pending_one_less(graph, worker, pending_of(task));
}

/* The result came; NULL: it will not. */
static void result_arrived(void *graph, struct worker *worker, void *what,
                           struct data_packet *packet)
{
    struct offload_pending *pending = pending_of(what);
    pending->result = packet;
    pending_one_less(graph, worker, pending);
}
