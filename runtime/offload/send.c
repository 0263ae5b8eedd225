/* Delegated tasks, at home. The versions that such a task reads and takes over stay here, held by
 * it as before, so nothing changes for the tasks that wait for it. The task goes on when two things
 * happened, in any order: its packet is sent, and the answer came. */
#include "runtime/offload/message.h"

#include "runtime/base/memory.h"
#include "runtime/data/law.h"

#include <string.h>

/* ---- Names ---- */

uint64_t offload_name_give(struct offload_names *names, struct offload_pending *pending)
{
    uint32_t i = names->free - 1;
    if (!names->free) {
        i = names->n;
        struct offload_name *slot =
            base_grow(names->slot, &names->capacity, (size_t)i + 1, sizeof *slot);
        if (!slot)
            return 0;
        names->slot = slot;
        names->slot[i] = (struct offload_name){.generation = 1};
        names->n++;
    }
    struct offload_name *slot = &names->slot[i];
    names->free = slot->next;
    slot->pending = pending;
    return (uint64_t)slot->generation << 32 | i;
}

struct offload_pending *offload_name_take(struct offload_names *names, uint64_t name)
{
    uint32_t i = (uint32_t)name;
    struct offload_name *slot = i < names->n ? &names->slot[i] : NULL;
    if (!slot || !slot->pending || slot->generation != name >> 32) {
        names->refused++;
        return NULL;
    }
    struct offload_pending *pending = slot->pending;
    slot->pending = NULL;
    slot->generation += slot->generation == UINT32_MAX ? 2 : 1; /* never 0 */
    slot->next = names->free;
    names->free = i + 1;
    return pending;
}

void offload_names_free(struct offload_names *names)
{
    base_free(names->slot);
    *names = (struct offload_names){0};
}

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

static bool access_reads(const struct task_access *access)
{
    const duite_mode mode = task_immediate((duite_mode)access->waiter.mode);
    return mode == DUITE_R || mode == DUITE_RW;
}

/* The value that is sent along, if the body or a child may read it, else NULL. The version that a
 * ready task changes has the value already. */
static const struct data_version *access_value(const struct task *task, size_t i)
{
    const struct data_object *lent = access_lent(task, i);
    if (!access_reads(&task->access[i]))
        return NULL;
    return lent ? lent->current : task->access[i].waiter.version;
}

/* A body waits for the values that it reads, but not for those that its children read. */
static bool value_may_go(const struct task *task, size_t i, const struct data_version *value)
{
    return (!access_lent(task, i) || data_version_ready(value)) && data_version_packet(value);
}

static size_t access_room(const struct task *task, size_t i)
{
    const struct task_access *access = &task->access[i];
    const struct data_object *lent = access_lent(task, i);
    const struct data_version *out = task_written(access);
    if (lent)
        return access->waiter.mode == DUITE_RP ? 0 : lent->room;
    if (out)
        return data_version_room(out);
    return access->waiter.mode == DUITE_CW ? data_sum_bytes(access->leaf->sum) : 0;
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
        there += in ? message_lines(in->packet->bytes) + 64 : 0;
        back += message_lines(access_room(task, i));
    }
    *bytes = there + back + 2 * sizeof(struct data_packet);
    return there < DATA_MAX_BYTES && back < DATA_MAX_BYTES && place_is_whole(task);
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

/* Gives the task the name under which its result will come back; 0 without memory, or if
 * communication broke. */
static uint64_t pending_enter(struct task_graph *graph, struct offload_pending *pending)
{
    uint64_t name = 0;
    pthread_mutex_lock(&graph->lock);
    if (!graph->offload_names && !graph->offload_closed)
        graph->offload_names = base_alloc_zero(sizeof *graph->offload_names);
    if (graph->offload_names)
        name = offload_name_give(graph->offload_names, pending);
    pthread_mutex_unlock(&graph->lock);
    return name;
}

bool offload_send(struct task_graph *graph, struct worker *worker, struct task *task, int to)
{
    struct data_packet *packet = message_pack(graph, task);
    struct offload_pending *pending = packet ? base_pool_take(sizeof *pending) : NULL;
    if (!pending) {
        data_packet_free(packet);
        return false;
    }
    *pending = (struct offload_pending){.send = {.sender = task, .to = to, .packet = packet},
                                        .task = task,
                                        .inner = task->inner,
                                        .left = 2};
    uint64_t name = pending_enter(graph, pending);
    if (!name) {
        data_packet_free(packet);
        base_pool_give(pending, sizeof *pending);
        return false;
    }
    packet->kind = DATA_OFFLOADED;
    packet->key = (struct data_key){.slot = (uint32_t)graph->rank, .number = name};
    pending->send.key = packet->key;
    task->state = TASK_DELEGATED;
    task->send = &pending->send;
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
    const struct data_failure *failure = task_fail(graph, (const void *)last, false);
    if (!ran && packet->pieces & MESSAGE_FAILED_BELOW)
        task_fail_below(graph, failure, task->scope);
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
        return (struct task_left_value){.failure = task_fail(graph, (const void *)from, false)};
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
        task_fail_below(graph, (const void *)from, task->scope);
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
    struct task *task = pending->task;
    struct data_packet *result;
    if (atomic_fetch_sub_explicit(&pending->left, 1, memory_order_acq_rel) != 1)
        return;
    result = pending->result;
    task->state = TASK_LOCAL;
    task->inner = pending->inner;
    base_pool_give(pending, sizeof *pending);
    task_run_result(graph, task, result_take, result);
    if (result && result->pieces & MESSAGE_RAN)
        result_unpack_below(task, worker, result);
    data_packet_free(result);
    task_finish(graph, worker, task);
}

void offload_sent(struct task_graph *graph, struct worker *worker, struct task *task)
{
    pending_one_less(graph, worker, (struct offload_pending *)task->send);
}

void offload_result_arrived(struct task_graph *graph, struct worker *worker,
                            struct data_packet *packet)
{
    struct offload_pending *pending = NULL;
    pthread_mutex_lock(&graph->lock);
    if (graph->offload_names)
        pending = offload_name_take(graph->offload_names, packet->key.number);
    pthread_mutex_unlock(&graph->lock);
    if (!pending) { /* it was given up; or the name is none of ours, which was counted */
        data_packet_free(packet);
        return;
    }
    pending->result = packet;
    pending_one_less(graph, worker, pending);
}

void offload_lost(struct task_graph *graph, struct worker *worker)
{
    pthread_mutex_lock(&graph->lock);
    struct offload_names *names = graph->offload_names;
    graph->offload_names = NULL;
    graph->offload_closed = true;
    pthread_mutex_unlock(&graph->lock);
    for (uint32_t i = 0; names && i < names->n; i++)
        if (names->slot[i].pending)
            pending_one_less(graph, worker, names->slot[i].pending);
    if (names)
        offload_names_free(names);
    base_free(names);
}

uint64_t offload_look(struct task_graph *graph,
                      void (*look)(void *context, const struct task *task, int rank), void *context)
{
    pthread_mutex_lock(&graph->lock);
    for (uint32_t i = 0; graph->offload_names && i < graph->offload_names->n; i++) {
        const struct offload_pending *pending = graph->offload_names->slot[i].pending;
        if (pending)
            look(context, pending->task, pending->send.to);
    }
    const uint64_t refused = graph->offload_names ? graph->offload_names->refused : 0;
    pthread_mutex_unlock(&graph->lock);
    return refused;
}

void offload_stop(struct task_graph *graph)
{
    if (graph->offload_names)
        offload_names_free(graph->offload_names);
    base_free(graph->offload_names);
    graph->offload_names = NULL;
}
