/* Finishing, the last stage of a task: its outputs are published once, its inputs released, and the
 * task is freed. Values that other ranks send, or fail to send, are published by the same means. */
#include "runtime/task/ready.h"

static inline void access_release(struct task_graph *graph, struct worker *worker,
                                  const struct task_access *access)
{
    if (access->waiter.mode == DUITE_R) { /* most */
        ready_wake_heir(graph, worker, data_version_was_read(access->waiter.version));
        return;
    }
    switch (access->waiter.mode) {
    case DUITE_W:
    case DUITE_RW:
        ready_publish(graph, worker, access->waiter.version);
        break;
    case DUITE_CW:
        task_wake(graph, worker, data_sum_release(access->leaf->sum));
        break;
    default: /* postponed: the scope's */
        break;
    }
}

void task_finish(struct task_graph *graph, struct worker *worker, struct task *task)
{
    const uint32_t n = task->n;
    for (uint32_t i = 0; i < n; i++)
        access_release(graph, worker, &task->access[i]);
    struct task_scope *scope = task->scope;
    struct task_scope *inner =
        task->type == TASK_BODY || task->state == TASK_VOID ? task->inner : NULL;
    base_pool_give(task, (size_t)task->grains * TASK_GRAIN);
    if (inner)
        task_scope_end(inner, worker); /* it leaves `scope` when its children have */
    else
        task_left(graph, scope, worker);
}

/* ---- Messages ---- */

static const struct data_failure communication_lost = {
    .code = DUITE_E_MPI, .kernel = UINT32_MAX, .text = "communication between the ranks broke"};

struct data_packet *task_send_packet(struct task *task)
{
    struct task_send *send = task->send;
    if (send->packet || !task->n)
        return send->packet;
    const struct data_version *version = task->access[0].waiter.version;
    if (version->poisoned)
        return send->packet = task_poison_packet(send->key, version->failure);
    /* The same bytes may be on their way to another rank already: then the header says just this.
     */
    struct data_packet *packet = version->packet;
    struct data_key key = send->key;
    if (packet->kind != DATA_VALUE || packet->key.slot != key.slot ||
        packet->key.generation != key.generation || packet->key.number != key.number) {
        packet->kind = DATA_VALUE;
        packet->key = key;
    }
    return packet;
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

const struct data_failure *task_lost_failure(void)
{
    return &communication_lost;
}

void task_lost(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    data_version_poison(version, &communication_lost);
    task_publish(graph, worker, version);
}

void task_pieces_lost(struct task_graph *graph, struct worker *worker, struct data_sum *sum)
{
    atomic_store_explicit(&sum->lost, &communication_lost, memory_order_relaxed);
    task_wake(graph, worker, data_sum_release(sum));
}
