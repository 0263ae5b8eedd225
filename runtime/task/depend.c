/* Dependences, the second stage of a task: its accesses become versions on this rank. Each access
 * becomes a hold on the version that it reads, the heir of the one that it overwrites, a leaf of a
 * sum, or a lent object. On other ranks the same call forgets stale versions, and sends or awaits
 * copies. Values that are not there yet wake the task later: ready.h. */
#include "runtime/task/access.h"
#include "runtime/task/ready.h"

#include "runtime/data/law.h"

/* ---- Versions on this rank ---- */

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

void task_forget(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    if (!object->current)
        return;
    task_release(graph, worker, object->current);
    object->current = NULL;
}

static int fetch_send(struct task_graph *graph, struct worker *worker, struct data_object *object,
                      int to)
{
    struct data_version *version = task_local(graph, object);
    struct task *task = version ? task_new(&graph->root, TASK_SEND, 1, sizeof *task->send) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    *task->send = (struct comm_letter){.key = task_key(graph, object), .sender = task, .to = to};
    task->access[0].waiter.mode = DUITE_R;
    task_settled(graph, worker, task, data_version_read(version, &task->access[0].waiter));
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

/* ---- Accesses ---- */

int task_wait(struct task_scope *scope, struct task *task, size_t i, struct data_object *object,
              uint32_t *done)
{
    struct task_access *access = &task->access[i];
    const bool writes = data_order_writes((duite_mode)access->waiter.mode);
    if (access_wait(scope, access, object, writes, scope->depth, done))
        return DUITE_OK;
    base_no_memory("a version");
    return task_break(scope->graph);
}

/* The scope of the task gets a hold on the version that is read; or the object's, and then the
 * object has from now on the version that the task's children will leave. */
static int access_lend(struct task_fork_call *call, size_t i, struct data_object *object,
                       struct data_version *version, bool writes)
{
    struct data_version *out = writes ? data_object_version(object) : NULL;
    if (writes && !out) {
        base_no_memory("a version");
        return task_break(call->scope->graph);
    }
    if (writes)
        object->current = out;
    else
        data_version_hold(version);
    task_lend(call->task->inner, &call->task->access[i], object, version, out);
    call->done++;
    return DUITE_OK;
}

int task_note_everywhere(struct task_graph *graph, struct worker *worker,
                         struct data_object *object, duite_mode mode)
{
    int code = data_order_reads(mode) ? task_fetch_all(graph, worker, object) : DUITE_OK;
    if (code || !data_order_writes(mode))
        return code;
    task_note_version(object, object->home);
    for (int rank = 0; rank < graph->n_ranks; rank++)
        task_note_copy(graph, object, rank);
    return DUITE_OK;
}

static int access_contribute(struct task_fork_call *call, size_t i, struct data_object *object,
                             bool postponed)
{
    const duite_law *law = data_law_of(call->kernel, i);
    int code = task_contribute(call->scope->graph, call->task, i, object, law, call->at);
    if (!code && postponed)
        task_lend(call->task->inner, &call->task->access[i], object, NULL, NULL);
    call->done += !code;
    return code;
}

static int access_depend(struct task_fork_call *call, size_t i, duite_mode declared)
{
    struct data_object *object = task_fork_object(call, i);
    const duite_mode mode = task_immediate(declared);
    int code =
        access_note(call->scope, call->worker, call->kernel, i, object, mode, call->at, false);
    if (code)
        return code;
    if (mode == DUITE_CW)
        return access_contribute(call, i, object, task_postponed(declared));
    if (data_order_reads(mode) && !task_local(call->scope->graph, object))
        return DUITE_E_MEMORY;
    if (task_postponed(declared))
        return access_lend(call, i, object, object->current, data_order_writes(mode));
    return task_wait(call->scope, call->task, i, object, &call->done);
}

static int depend_here(struct task_fork_call *call)
{
    size_t made = 0;
    int code = DUITE_OK;
    for (; made < call->n && !code; made += !code) {
        const duite_mode mode = task_mode_of(call->fixed, made);
        call->task->access[made].waiter.mode = mode;
        code = access_depend(call, made, mode);
    }
    if (code)
        task_void(call->scope->graph, call->worker, call->task, made, call->done);
    else
        task_settled(call->scope->graph, call->worker, call->task, call->done);
    return code;
}

static int depend_elsewhere(struct task_fork_call *call)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < call->n && !code; i++)
        code =
            access_elsewhere(call->scope, call->worker, call->kernel, i, task_fork_object(call, i),
                             task_immediate(task_mode_of(call->fixed, i)), call->at, false);
    return code;
}

int task_depend(struct task_fork_call *call)
{
    return call->task ? depend_here(call) : depend_elsewhere(call);
}

/* ---- ready.h, for those to whom a call more does not matter ---- */

void task_settled(struct task_graph *graph, struct worker *worker, struct task *task, uint32_t done)
{
    ready_take(graph, worker, task, done + 1);
}

void task_wake(struct task_graph *graph, struct worker *worker, struct data_waiter *waiter)
{
    ready_wake(graph, worker, waiter);
}

/* The heir of the version that the value is passed on to may again be no task. */
void task_wake_heir(struct task_graph *graph, struct worker *worker, struct data_waiter *heir)
{
    while (heir && !heir->back)
        heir = task_pass(worker, heir);
    ready_wake_heir(graph, worker, heir);
}

void task_release(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    ready_release(graph, worker, version);
}

struct data_waiter *task_produced(struct task_graph *graph, struct worker *worker,
                                  struct data_version *version)
{
    return ready_produced(graph, worker, version);
}

void task_publish(struct task_graph *graph, struct worker *worker, struct data_version *version)
{
    ready_publish(graph, worker, version);
}
