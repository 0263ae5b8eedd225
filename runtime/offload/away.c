/* Tasks that are away. The versions that such a task reads and takes over stay here, held by it as
 * before, so nothing else changes for those who wait for it. It goes on when two things happened,
 * in whichever order: the packet is gone, and the answer came. */
#include "runtime/offload/parcel.h"

#include "runtime/base/pool.h"
#include "runtime/data/mode.h"

#include <string.h>

/* ---- Going ---- */

size_t parcel_put(struct data_packet *packet, size_t at, const void *from, size_t bytes)
{
    char *to = (char *)data_payload(packet) + at;
    size_t end = parcel_lines(at + bytes);
    if (bytes)
        memmove(to, from, bytes);
    memset(to + bytes, 0, end - at - bytes);
    return end;
}

/* What the body finds: under r and rw, unless it is poisoned. */
static const struct data_version *found(const struct task_access *access)
{
    bool reads = access->waiter.mode == DUITE_R || access->waiter.mode == DUITE_RW;
    return reads ? access->in : NULL;
}

static size_t room(const struct task_access *access)
{
    const struct data_version *out = task_written(access);
    if (out)
        return data_version_room(out);
    return access->waiter.mode == DUITE_CW ? access->sum->count * data_type_size(access->sum->type)
                                           : 0;
}

bool offload_may_go(const struct task_graph *graph, const struct task *task, size_t *bytes)
{
    if (task->kind != TASK_BODY || task->inner || task->pinned)
        return false;
    /* What a guest forks stays with it: nothing that it waits for is on another rank. */
    if (task->scope->top != &graph->root)
        return false;
    const duite_kernel *kernel = graph->kernels[task->kernel];
    if (kernel->side_effects || kernel->stays || kernel->replicated)
        return false;
    size_t there = parcel_head(task->n) + kernel->args_size, back = parcel_counts(task->n);
    for (uint32_t i = 0; i < task->n; i++) {
        const struct data_version *in = found(&task->access[i]);
        if (in && !data_version_packet(in))
            return false;
        there += in ? parcel_lines(in->packet->bytes) + 64 : 0;
        back += parcel_lines(room(&task->access[i]));
    }
    *bytes = there + back + 2 * sizeof(struct data_packet);
    return there < DATA_MOST_BYTES && back < DATA_MOST_BYTES;
}

static struct parcel_param describe(const struct task_access *access)
{
    const struct data_version *in = found(access), *out = task_written(access);
    const struct data_version *version = in ? in : out;
    if (!version)
        return (struct parcel_param){.most = access->sum->count, .type = access->sum->type};
    return (struct parcel_param){.bytes = in ? in->packet->bytes : 0,
                                 .most = version->most,
                                 .type = version->type,
                                 .sized = version->sized};
}

static struct parcel head(const struct task *task)
{
    struct data_failure place = {0};
    task_failure_place(&place, task, NULL);
    struct parcel parcel = {.number = place.number,
                            .index = task->number,
                            .kernel = task->kernel,
                            .n = task->n,
                            .block = task->block,
                            .priority = task->priority,
                            .cost = task->cost,
                            .path_length = place.path_length};
    memcpy(parcel.path, place.path, sizeof parcel.path);
    return parcel;
}

/* NULL without memory. */
static struct data_packet *pack(const struct task_graph *graph, struct task *task)
{
    const struct parcel parcel = head(task);
    size_t args = graph->kernels[task->kernel]->args_size, n = task->n;
    size_t bytes = parcel_head(n) + parcel_lines(args);
    for (size_t i = 0; i < n; i++)
        bytes += parcel_value(task->access[i].waiter.mode, describe(&task->access[i]).bytes);
    struct data_packet *packet = data_packet_new(bytes, false);
    if (!packet)
        return NULL;
    struct parcel_param *param = (void *)((char *)data_payload(packet) + sizeof parcel);
    memset(data_payload(packet), 0, parcel_head(n));
    memcpy(data_payload(packet), &parcel, sizeof parcel);
    size_t at = parcel_put(packet, parcel_head(n), task_rest(task, n), args);
    for (size_t i = 0; i < n; i++) {
        const struct data_version *in = found(&task->access[i]);
        param[i] = describe(&task->access[i]);
        if (in)
            parcel_put(packet, at, data_payload(in->packet), in->packet->bytes);
        at += parcel_value(task->access[i].waiter.mode, param[i].bytes);
    }
    return packet;
}

/* False if it is too late. */
static bool enter(struct task_graph *graph, struct offload_away *away)
{
    pthread_mutex_lock(&graph->lock);
    bool open = !graph->away_closed;
    if (open) {
        away->next = graph->away;
        if (away->next)
            away->next->last = away;
        graph->away = away;
    }
    pthread_mutex_unlock(&graph->lock);
    return open;
}

bool offload_send(struct task_graph *graph, struct worker *worker, struct task *task, int to)
{
    struct data_packet *packet = pack(graph, task);
    struct offload_away *away = packet ? base_pool_take(sizeof *away) : NULL;
    if (!away) {
        data_packet_free(packet);
        return false;
    }
    packet->kind = DATA_GUEST;
    packet->key = (struct data_key){.slot = (uint32_t)graph->rank, .number = (uintptr_t)away};
    *away = (struct offload_away){
        .send = {.key = packet->key, .to = to, .packet = packet}, .task = task, .left = 2};
    if (!enter(graph, away)) {
        data_packet_free(packet);
        base_pool_give(away, sizeof *away);
        return false;
    }
    task->kind = TASK_AWAY;
    task->send = &away->send;
    work_ready(graph->pool, worker, task);
    return true;
}

/* ---- Coming home ---- */

/* What the body left becomes what its parameters have; or its failure, kept here as if it had
 * failed here. */
static const struct data_failure *unpack(const struct task *task, duite_param *param,
                                         struct data_packet *packet)
{
    struct task_graph *graph = task->scope->graph;
    char *payload = data_payload(packet);
    const uint64_t *bytes = (const void *)payload;
    size_t at = parcel_counts(task->n);
    if (packet->pieces & PARCEL_FAILED) {
        const struct data_failure *both = (const void *)payload;
        if (packet->pieces & PARCEL_TOLD)
            task_fail_below(graph, &both[1], task->scope);
        return task_fail(graph, &both[0], false);
    }
    for (uint32_t i = 0; i < task->n; i++) {
        if (bytes[i])
            memcpy(param[i].data, payload + at, bytes[i]);
        if (task->access[i].waiter.mode != DUITE_R)
            param[i].count = bytes[i] / data_type_size(param[i].type);
        at += parcel_lines(bytes[i]);
    }
    if (packet->pieces & PARCEL_TOLD)
        task_fail_below(graph, (const void *)(payload + at), task->scope);
    return NULL;
}

static const struct data_failure *take_result(const struct task *task, duite_param *param,
                                              struct data_packet *result)
{
    return result ? unpack(task, param, result) : task_lost_failure();
}

/* One of two things happened; `away` may be gone afterwards, and the task. */
static void one_less(struct task_graph *graph, struct worker *worker, struct offload_away *away)
{
    struct task *task = away->task;
    struct data_packet *result;
    if (atomic_fetch_sub_explicit(&away->left, 1, memory_order_acq_rel) != 1)
        return;
    result = away->result;
    base_pool_give(away, sizeof *away);
    task->kind = TASK_BODY;
    task->inner = NULL;
    task_run_result(graph, task, take_result, result);
    data_packet_free(result);
    task_finish(graph, worker, task);
}

void offload_away_sent(struct task_graph *graph, struct worker *worker, struct task *task)
{
    one_less(graph, worker, (struct offload_away *)task->send);
}

/* Under the lock. */
static void leave(struct task_graph *graph, struct offload_away *away)
{
    if (away->next)
        away->next->last = away->last;
    *(away->last ? &away->last->next : &graph->away) = away->next;
}

void offload_came_home(struct task_graph *graph, struct worker *worker, struct data_packet *packet)
{
    struct offload_away *away = (struct offload_away *)(uintptr_t)packet->key.number;
    pthread_mutex_lock(&graph->lock);
    bool late = graph->away_closed; /* then it was given up */
    if (!late)
        leave(graph, away);
    pthread_mutex_unlock(&graph->lock);
    if (late) {
        data_packet_free(packet);
        return;
    }
    away->result = packet;
    one_less(graph, worker, away);
}

void offload_away_lost(struct task_graph *graph, struct worker *worker)
{
    pthread_mutex_lock(&graph->lock);
    struct offload_away *away = graph->away;
    graph->away = NULL;
    graph->away_closed = true;
    pthread_mutex_unlock(&graph->lock);
    while (away) {
        struct offload_away *next = away->next;
        one_less(graph, worker, away);
        away = next;
    }
}

void offload_away_look(struct task_graph *graph,
                       void (*look)(void *context, const struct task *task, int rank),
                       void *context)
{
    pthread_mutex_lock(&graph->lock);
    for (const struct offload_away *away = graph->away; away; away = away->next)
        look(context, away->task, away->send.to);
    pthread_mutex_unlock(&graph->lock);
}
