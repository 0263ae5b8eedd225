/* The messages of a plan. A message has all values that a round makes on one rank for another in
 * one phase. Their order is that of the node's uses, the same on both sides. The failures of
 * poisoned values follow at the end. SENDs and RECEIVEs become ready like any node: when the values
 * to send are made, or when the values to overwrite have been read. */
#include "runtime/plan/plan.h"
#include "runtime/task/internal.h"

#include <string.h>

struct message {
    uint32_t failures; /* behind the values */
    uint32_t unused;   /* keeps the values on a multiple of 8 */
};

struct message_failure {
    uint64_t use; /* of the node */
    struct data_failure failure;
};

static size_t channel_value_room(const struct plan_place *place)
{
    return (place->bytes + 7) / 8 * 8;
}

static size_t channel_values_bytes(const struct plan *plan, const struct task *task)
{
    const struct plan_node_use *use = plan->use + task->node->first_use;
    size_t bytes = 0;
    for (uint32_t i = 0; i < task->n; i++)
        bytes += channel_value_room(&plan->place[use[i].place]);
    return bytes;
}

size_t plan_channel_room(const struct plan *plan, const struct task *task)
{
    return sizeof(struct message) + channel_values_bytes(plan, task) +
           task->n * sizeof(struct message_failure);
}

const struct task *plan_channel_waits(const struct comm_channel *channel, unsigned *more)
{
    const struct plan_node *node = ((const struct task *)channel->node)->node;
    const struct task *one = NULL;
    *more = 0;
    for (uint32_t i = node->n_cyclic; i < node->n_next; i++) {
        if (node->next[i]->kernel == UINT32_MAX)
            continue;
        *more += one != NULL;
        one = one ? one : node->next[i];
    }
    return one;
}

/* Like the beginning of plan_node_run: from now on the node counts for its next round. */
static struct plan *channel_begin(struct task *task)
{
    atomic_store_explicit(&task->pending, task->node->steady, memory_order_relaxed);
    return task->node->plan;
}

static size_t channel_pack_failures(const struct plan *plan, const struct task *task,
                                    struct message *message, char *at)
{
    const struct plan_node_use *use = plan->use + task->node->first_use;
    for (uint32_t i = 0; i < task->n; i++) {
        const struct data_failure *failure = plan->place[use[i].place].failure;
        struct message_failure failed = {.use = i};
        if (!failure)
            continue;
        failed.failure = *failure;
        memcpy(at + message->failures++ * sizeof failed, &failed, sizeof failed);
    }
    return message->failures * sizeof(struct message_failure);
}

size_t plan_channel_pack(struct comm_channel *channel, void *bytes)
{
    struct task *task = channel->node;
    const struct plan *plan = channel_begin(task);
    const struct plan_node_use *use = plan->use + task->node->first_use;
    struct message *message = bytes;
    char *at = (char *)(message + 1);
    for (uint32_t i = 0; i < task->n; i++) {
        const struct plan_place *place = &plan->place[use[i].place];
        size_t room = channel_value_room(place);
        if (place->data)
            memcpy(at, place->data, place->bytes);
        memset(at + place->bytes, 0, room - place->bytes);
        at += room;
    }
    *message = (struct message){0};
    if (atomic_load_explicit(&plan->tainted, memory_order_relaxed))
        at += channel_pack_failures(plan, task, message, at);
    return (size_t)(at - (char *)bytes);
}

/* Poisons or heals the received places. */
static void channel_unpack_failures(struct plan *plan, const struct task *task,
                                    const struct message *message, const char *at)
{
    const struct plan_node_use *use = plan->use + task->node->first_use;
    for (uint32_t i = 0; i < task->n; i++)
        plan->place[use[i].place].failure = NULL;
    for (uint32_t i = 0; i < message->failures; i++) {
        struct message_failure failed;
        memcpy(&failed, at + i * sizeof failed, sizeof failed);
        plan->place[use[failed.use].place].failure = task_fail(plan->graph, &failed.failure, false);
    }
    if (message->failures)
        atomic_store_explicit(&plan->tainted, PLAN_POISONED, memory_order_relaxed);
}

void plan_channel_unpack(struct comm_channel *channel, const void *bytes)
{
    struct task *task = channel->node;
    struct plan *plan = channel_begin(task);
    const struct plan_node_use *use = plan->use + task->node->first_use;
    const struct message *message = bytes;
    const char *at = (const char *)(message + 1);
    for (uint32_t i = 0; i < task->n; i++) {
        const struct plan_place *place = &plan->place[use[i].place];
        memcpy(place->data, at, place->bytes);
        at += channel_value_room(place);
    }
    if (message->failures || atomic_load_explicit(&plan->tainted, memory_order_relaxed))
        channel_unpack_failures(plan, task, message, at);
}

void plan_channel_lost(struct comm_channel *channel)
{
    struct task *task = channel->node;
    struct plan *plan = channel_begin(task);
    const struct plan_node_use *use = plan->use + task->node->first_use;
    atomic_store_explicit(&plan->tainted, PLAN_POISONED, memory_order_relaxed);
    for (uint32_t i = 0; i < task->n; i++)
        if (use[i].writes)
            plan->place[use[i].place].failure = &task_lost_failure;
}
