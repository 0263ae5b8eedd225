/* Dependences, the second stage of a task: its accesses become versions on this rank. Each access
 * becomes a hold on the version that it reads, the heir of the one that it overwrites, a leaf of a
 * sum, or a lent object. On other ranks the same call forgets stale versions, and sends or awaits
 * copies (message.c). Values that are not there yet wake the task later: ready.h. */
#include "runtime/task/access.h"
#include "runtime/task/ready.h"

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
    ready_release(graph, worker, object->current);
    object->current = NULL;
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
    const int code = access_note(call, i, object, mode, ACCESS_ANY);
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
        ready_take(call->scope->graph, call->worker, call->task, call->done + 1);
    return code;
}

static int depend_elsewhere(struct task_fork_call *call)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < call->n && !code; i++)
        code = access_elsewhere(call, i, task_fork_object(call, i), ACCESS_ANY);
    return code;
}

int task_depend(struct task_fork_call *call)
{
    return call->task ? depend_here(call) : depend_elsewhere(call);
}
