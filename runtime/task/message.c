/* Values that go to other ranks. At the fork of a reader the holder makes a task that sends, and
 * the reader's rank expects the version. Values that come, or fail to come, are published as if a
 * task had written them here. */
#include "runtime/task/ready.h"

#include "runtime/base/error.h"

/* ---- At the fork ---- */

static int fetch_send(struct task_graph *graph, struct worker *worker, struct data_object *object,
                      int to)
{
    struct data_version *version = task_local(graph, object);
    struct task *task = version ? task_new(&graph->root, TASK_SEND, 1, sizeof *task->send) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    *task->send = (struct comm_letter){.key = task_key(graph, object), .sender = task, .to = to};
    task->access[0].waiter.mode = DUITE_R;
    ready_take(graph, worker, task, 1 + data_version_read(version, &task->access[0].waiter));
    return DUITE_OK;
}

static int fetch_await(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    struct data_version *version = data_object_version(object);
    if (!version) {
        base_no_memory("a version");
        return task_break(graph);
    }
    object->current = version;
    const struct comm_target target = {
        .arrived = task_arrived, .what = version, .from = object->holder};
    if (!comm_expect(graph->comm, worker, task_key(graph, object), target, 1))
        return DUITE_OK;
    object->current = NULL;
    data_version_free(version);
    return task_break(graph);
}

int task_fetch(struct task_graph *graph, struct worker *worker, struct data_object *object, int to)
{
    if (!task_note_copy(graph, object, to))
        return DUITE_OK;
    if (graph->rank == to)
        return fetch_await(graph, worker, object);
    if (graph->rank == object->holder)
        return fetch_send(graph, worker, object, to);
    return DUITE_OK;
}

int task_fetch_all(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    int code = DUITE_OK;
    for (int rank = 0; rank < graph->n_ranks && !code; rank++)
        code = task_fetch(graph, worker, object, rank);
    return code;
}

/* ---- The message ---- */

const struct data_failure task_lost_failure = {
    .code = DUITE_E_MPI, .kernel = UINT32_MAX, .text = "communication between the ranks broke"};

struct data_packet *task_poison_packet(struct data_key key, const struct data_failure *failure)
{
    struct data_packet *packet = data_packet_new(sizeof *failure, false);
    if (!packet)
        return NULL;
    packet->key = key;
    packet->kind = DATA_POISON;
    memcpy(data_payload(packet), failure, sizeof *failure);
    return packet;
}

struct data_packet *task_send_packet(struct comm_letter *send)
{
    const struct task *task = send->sender;
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

void task_arrived(void *graph, struct worker *worker, void *what, struct data_packet *packet)
{
    struct data_version *version = what;
    if (!packet) {
        data_version_poison(version, &task_lost_failure);
    } else if (packet->kind == DATA_POISON) {
        data_version_poison(version, task_fail(graph, data_payload(packet), false));
        data_packet_free(packet);
    } else {
        version->packet = packet;
    }
    ready_publish(graph, worker, version);
}
