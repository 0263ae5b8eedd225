/* Sums that are closed. The first access of another kind ends the run of contributions. Then they
 * are reduced where the object's value is (its holder); other ranks send it the subtrees that they
 * have. */
#include "runtime/task/ready.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

/* A message has a list of subtrees, and then a value for each, filled up to a multiple of 16 bytes.
 */
enum { VALUE_BYTES = 16 };
enum value_where { VALUE_FOLLOWS, VALUE_IS_ABSENT /* though there is room for one */ };

const struct data_failure task_sum_no_memory = {
    .code = DUITE_E_MEMORY, .kernel = UINT32_MAX, .text = "there was no memory for contributions"};

/* ---- Reducing ---- */

/* A task that waits for all contributions and takes them from the object; pending counts them as
 * one. Without memory they stay there until stop. */
static struct task *sum_reducer(struct task_scope *scope, struct data_object *object,
                                enum task_type type, size_t n)
{
    struct task *task = task_new(scope, type, n, sizeof *task->sum);
    if (!task)
        return NULL;
    *task->sum =
        (struct task_sum){.waiter.back = (uint32_t)((char *)&task->sum->waiter - (char *)task),
                          .sum = object->sum,
                          .send = {.sender = task, .to = object->holder}};
    if (!scope->depth)
        task->sum->send.key = task_key(scope->graph, object);
    task->block = object->block;
    atomic_fetch_add_explicit(&task->pending, 1, memory_order_relaxed);
    object->sum->reducer = &task->sum->waiter;
    object->sum = NULL;
    return task;
}

static int pieces_expect(struct task_graph *graph, struct worker *worker, struct task_sum *closing)
{
    struct data_sum *sum = closing->sum;
    atomic_fetch_add_explicit(&sum->pending, sum->senders, memory_order_relaxed);
    const struct comm_target target = {.arrived = task_pieces_arrived, .what = sum, .from = -1};
    if (!comm_expect(graph->comm, worker, closing->send.key, target, sum->senders))
        return DUITE_OK;
    atomic_store_explicit(&sum->lost, &task_sum_no_memory, memory_order_relaxed);
    atomic_fetch_sub_explicit(&sum->pending, sum->senders, memory_order_relaxed);
    return task_break(graph);
}

static int sum_combine_here(struct task_scope *scope, struct worker *worker,
                            struct data_object *object)
{
    struct task_graph *graph = scope->graph;
    struct data_sum *sum = object->sum;
    struct data_version *version = task_local(graph, object);
    struct task *task = version ? sum_reducer(scope, object, TASK_COMBINE, 1) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    uint32_t done = 0;
    task->access[0].waiter.mode = DUITE_RW;
    int code = task_wait(scope, task, 0, object, &done);
    if (code) { /* the contributions are dropped once they are all there */
        task->n = 0;
        done = 1;
    } else if (sum->senders) {
        code = pieces_expect(graph, worker, task->sum);
    }
    ready_wake(graph, worker, data_sum_release(sum));
    ready_take(graph, worker, task, done + 1);
    return code;
}

static int sum_send_pieces(struct task_scope *scope, struct worker *worker,
                           struct data_object *object)
{
    struct task_graph *graph = scope->graph;
    struct data_sum *sum = object->sum;
    struct task *task = sum_reducer(scope, object, TASK_PIECES, 0);
    if (!task)
        return DUITE_E_MEMORY;
    ready_wake(graph, worker, data_sum_release(sum));
    ready_take(graph, worker, task, 1);
    return DUITE_OK;
}

/* Keeps the contributions to a task's object until stop if there is no memory to combine them:
 * their tasks may still run. */
static void sum_keep_unclosed(struct task_graph *graph, struct data_object *object)
{
    struct data_sum *sum = object->sum;
    object->sum = NULL;
    object->leaves = 0;
    if (!sum)
        return;
    pthread_mutex_lock(&graph->lock);
    sum->next = graph->unclosed;
    graph->unclosed = sum;
    pthread_mutex_unlock(&graph->lock);
}

int task_gather(struct task_scope *scope, struct worker *worker, struct data_object *object,
                struct data_piece *leaf)
{
    struct task_graph *graph = scope->graph;
    struct data_sum *sum = object->sum;
    struct task *task = sum_reducer(scope, object, TASK_GATHER, 1);
    if (!task) {
        sum_keep_unclosed(graph, object);
        return DUITE_E_MEMORY;
    }
    task->access[0].waiter.mode = DUITE_CW;
    task->access[0].leaf = leaf;
    object->leaves = 0;
    ready_wake(graph, worker, data_sum_release(sum));
    ready_take(graph, worker, task, 2);
    return DUITE_OK;
}

int task_reduce(struct task_scope *scope, struct worker *worker, struct data_object *object)
{
    struct task_graph *graph = scope->graph;
    int code = DUITE_OK;
    task_note_version(object, object->holder);
    if (object->holder == graph->rank) {
        code = sum_combine_here(scope, worker, object);
    } else {
        if (object->sum)
            code = sum_send_pieces(scope, worker, object);
        task_forget(graph, worker, object);
    }
    if (code && scope->depth)
        sum_keep_unclosed(graph, object);
    object->leaves = 0;
    return code;
}

/* ---- Running ---- */

void task_run_combine(struct task *task)
{
    struct task_sum *sum = task->sum;
    if (!task->n) {
        data_sum_free(sum->sum);
        return;
    }
    struct data_version *out = task->access[0].waiter.version;
    struct data_piece *whole;
    int code;
    const struct data_failure *failure = data_sum_fold(sum->sum, &whole, &code);
    failure =
        code ? task_fail_memory(task) : data_failure_first(data_version_failure(out), failure);
    data_version_poison(out, failure);
    if (!failure && whole)
        sum->sum->law->combine(data_payload(out->packet), whole->value, sum->sum->count,
                               sum->sum->type);
    data_sum_free(sum->sum);
}

void task_run_gather(struct task *task)
{
    struct data_sum *sum = task->sum->sum;
    struct data_piece *leaf = task->access[0].leaf, *whole;
    int code;
    const struct data_failure *failure = data_sum_fold(sum, &whole, &code);
    if (code)
        failure = task_fail_memory(task);
    leaf->failure = data_failure_first(leaf->failure, failure);
    if (!leaf->failure)
        data_piece_take(leaf, whole);
    data_sum_free(sum);
}

static struct data_packet *pieces_pack(const struct task_sum *sum, const struct data_pieces *pieces)
{
    const size_t n = pieces->n;
    size_t bytes = data_sum_bytes(sum->sum);
    size_t stride = (bytes + VALUE_BYTES - 1) / VALUE_BYTES * VALUE_BYTES;
    struct data_packet *packet = data_packet_new(n * (sizeof(struct data_subtree) + stride), false);
    if (!packet)
        return NULL;
    packet->key = sum->send.key;
    packet->kind = DATA_PIECES;
    packet->pieces = (uint32_t)n;
    struct data_subtree *trees = data_payload(packet);
    char *values = (char *)(trees + n);
    for (size_t i = 0; i < n; i++) {
        size_t present = pieces->piece[i]->value ? bytes : 0;
        trees[i] = pieces->piece[i]->tree;
        trees[i].where = present ? VALUE_FOLLOWS : VALUE_IS_ABSENT;
        if (present)
            memcpy(values + i * stride, pieces->piece[i]->value, bytes);
        memset(values + i * stride + present, 0, stride - present);
    }
    return packet;
}

void task_run_pieces(struct task *task)
{
    struct task_sum *sum = task->sum;
    struct data_pieces pieces;
    struct data_packet *packet = NULL;
    int code;
    const struct data_failure *failure = data_sum_reduce(sum->sum, &pieces, &code);
    if (!code && !failure)
        packet = pieces_pack(sum, &pieces);
    if (!packet)
        packet = task_poison_packet(sum->send.key, failure ? failure : task_fail_memory(task));
    data_pieces_free(&pieces);
    data_sum_free(sum->sum);
    sum->send.packet = packet; /* the sender notices NULL */
    task->state = TASK_LEAVES;
    task->send = &sum->send;
}

/* ---- Pieces of other ranks ---- */

/* Takes over the piece and its packet. Without memory the sum is marked lost, or it would count as
 * complete. */
static bool piece_add(struct task_graph *graph, struct data_sum *sum, struct data_piece piece)
{
    struct data_piece *node = data_piece_new();
    if (!node) {
        const struct data_failure *failure = task_fail(graph, &task_sum_no_memory, true);
        atomic_store_explicit(&sum->lost, failure, memory_order_relaxed);
        data_packet_free(piece.packet);
        return false;
    }
    *node = piece;
    data_sum_arrive(sum, node);
    return true;
}

/* The first piece owns the packet, whose bytes all of them share. */
static void pieces_add(struct task_graph *graph, struct data_sum *sum, struct data_packet *packet)
{
    uint32_t n = packet->pieces;
    struct data_subtree *trees = data_payload(packet);
    char *values = (char *)(trees + n);
    size_t stride = packet->bytes / n - sizeof *trees;
    for (uint32_t i = 0; i < n; i++)
        if (!piece_add(graph, sum,
                       (struct data_piece){
                           .tree = trees[i],
                           .packet = i ? NULL : packet,
                           .value = trees[i].where == VALUE_FOLLOWS ? values + i * stride : NULL}))
            return;
}

void task_pieces_arrived(void *graph, struct worker *worker, void *what, struct data_packet *packet)
{
    struct data_sum *sum = what;
    if (!packet) {
        atomic_store_explicit(&sum->lost, &task_lost_failure, memory_order_relaxed);
    } else if (packet->kind == DATA_POISON) {
        const struct data_failure *failure = task_fail(graph, data_payload(packet), false);
        piece_add(graph, sum, (struct data_piece){.failure = failure});
        data_packet_free(packet);
    } else {
        pieces_add(graph, sum, packet);
    }
    ready_wake(graph, worker, data_sum_release(sum));
}
