/* Dependences: a task waits through its accesses for versions, and is ready when `pending`, which
 * also counts a hold of the fork itself, comes to 0. Whoever takes the last one hands the task on.
 */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/pool.h"

struct task *task_make(struct task_scope *scope, enum task_type kind, size_t n, size_t extra)
{
    struct task *task;
    size_t bytes = sizeof *task + n * sizeof task->access[0] + extra;
    size_t grains = (bytes + TASK_GRAIN - 1) / TASK_GRAIN;
    task = grains <= UINT32_MAX ? base_pool_take(grains * TASK_GRAIN) : NULL;
    if (!task)
        return NULL;
    *task = (struct task){
        .pending = (uint32_t)n + 1,
        .n = (uint32_t)n,
        .scope = scope,
        .number = scope->forks,
        .kernel = UINT32_MAX,
        .block = (uint32_t)scope->forks, /* until it is known to run for an object */
        .priority = INT32_MAX,           /* unless the program forks it */
        .grains = (uint32_t)grains,
        .kind = kind,
    };
    if (kind > TASK_BODY && extra)
        task->sum = task_rest(task, n);
    for (size_t i = 0; i < n; i++)
        task->access[i] = (struct task_access){
            .waiter.back = (uint32_t)(sizeof *task + i * sizeof task->access[0])};
    return task;
}

struct task *task_new(struct task_scope *scope, enum task_type kind, size_t n, size_t extra)
{
    struct task *task = task_make(scope, kind, n, extra);
    if (!task) {
        base_no_memory("a task");
        task_break(scope->graph);
        return NULL;
    }
    if (scope->parent)
        atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    else
        scope->graph->tasks++;
    return task;
}

static void take(struct task_graph *graph, struct worker *worker, struct task *task, uint32_t taken)
{
    if (atomic_load_explicit(&task->pending, memory_order_acquire) == taken ||
        atomic_fetch_sub_explicit(&task->pending, taken, memory_order_acq_rel) == taken)
        work_ready(graph->pool, worker, task);
}

void task_settled(struct task_graph *graph, struct worker *worker, struct task *task, uint32_t done)
{
    take(graph, worker, task, done + 1);
}

static struct task *task_of(struct data_waiter *waiter)
{
    return (struct task *)(void *)((char *)waiter - waiter->back);
}

void task_wake(struct task_graph *graph, struct worker *worker, struct data_waiter *waiter)
{
    if (waiter)
        take(graph, worker, task_of(waiter), 1);
}

/* An heir that is no task passes the value on to a scope above, which may have one like it. */
static void wake_heir(struct task_graph *graph, struct worker *worker, struct data_waiter *heir)
{
    while (heir && !heir->back)
        heir = task_pass(worker, heir);
    if (heir) /* an access: another core wrote what its task will need next */
        base_prefetch(((struct task_access *)(void *)heir)->out);
    task_wake(graph, worker, heir);
}

void task_release(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    wake_heir(graph, worker, data_version_release(version));
}

struct data_waiter *task_produced(struct task_graph *graph, struct worker *worker,
                                  struct data_version *version)
{
    struct data_waiter *waiter = data_version_produced(version);
    while (waiter) {
        struct data_waiter *next = waiter->next; /* the task may run and be freed once woken */
        task_wake(graph, worker, waiter);
        waiter = next;
    }
    return data_version_release(version);
}

void task_publish(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    wake_heir(graph, worker, task_produced(graph, worker, version));
}

void task_read(struct task *task, size_t i, struct data_version *version, uint32_t *done)
{
    struct task_access *access = &task->access[i];
    data_version_hold(version);
    access->in = version;
    *done += !data_version_await(version, &access->waiter);
}

int task_overwrite(struct task_graph *graph, struct task *task, size_t i,
                   struct data_object *object, struct data_version *version, uint32_t *done)
{
    struct task_access *access = &task->access[i];
    access->out = data_object_version(object);
    if (!access->out) {
        base_no_memory("a version");
        return task_break(graph);
    }
    access->in = version;
    object->current = access->out;
    if (version)
        version->heir = &access->waiter;
    *done += !version || data_version_release(version) != NULL;
    return DUITE_OK;
}

struct data_version *task_local(struct task_graph *graph, struct data_object *object)
{
    if (object->current)
        return object->current;
    struct data_version *version = data_object_version(object);
    if (version)
        version->packet = data_packet_new(object->bytes, true);
    if (!version || !version->packet) {
        if (version)
            data_version_free(version);
        base_no_memory("an object");
        task_break(graph);
        return NULL;
    }
    data_version_produced(version);
    data_version_release(version); /* nobody produced these zeros: the object alone holds them */
    return object->current = version;
}

static int send_copy(struct task_graph *graph, struct worker *worker, struct data_object *object,
                     int to)
{
    struct data_version *version = task_local(graph, object);
    struct task *task = version ? task_new(&graph->root, TASK_SEND, 1, sizeof *task->send) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    *task->send = (struct task_send){.key = task_key(graph, object), .to = to};
    uint32_t done = 0;
    task->access[0].waiter.mode = DUITE_R;
    task_read(task, 0, version, &done);
    task_settled(graph, worker, task, done);
    return DUITE_OK;
}

static int await_copy(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    struct data_version *version = data_object_version(object);
    if (!version) {
        base_no_memory("a version");
        return task_break(graph);
    }
    object->current = version;
    if (!work_expect(graph->pool, worker, task_key(graph, object), object->holder, version, NULL,
                     1))
        return DUITE_OK;
    object->current = NULL;
    data_version_free(version);
    return task_break(graph);
}

int task_fetch(struct task_graph *graph, struct worker *worker, struct data_object *object, int to)
{
    if (data_object_has_copy(&graph->table, object, to))
        return DUITE_OK;
    data_object_add_copy(&graph->table, object, to);
    if (graph->rank == to)
        return await_copy(graph, worker, object);
    if (graph->rank == object->holder)
        return send_copy(graph, worker, object, to);
    return DUITE_OK;
}

int task_fetch_all(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    int code = DUITE_OK;
    for (int rank = 0; rank < graph->n_ranks && !code; rank++)
        code = task_fetch(graph, worker, object, rank);
    return code;
}

void task_forget(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    if (!object->current)
        return;
    task_release(graph, worker, object->current);
    object->current = NULL;
}

struct data_packet *task_send_packet(struct task *task)
{
    struct task_send *send = task->send;
    if (send->packet || !task->n)
        return send->packet;
    const struct data_version *version = task->access[0].in;
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
