/* Dependences, the second stage of a task: its accesses become versions on this rank. Each access
 * becomes a hold on the version that it reads, the heir of the one that it overwrites, a leaf of a
 * sum, or a lent object. On other ranks the same call forgets stale versions, and sends or awaits
 * copies. Values that are not there yet wake the task later: ready.c. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/data/law.h"

/* ---- One task and one version ---- */

void task_read(struct task *task, size_t i, struct data_version *version, uint32_t *done)
{
    *done += data_version_read(version, &task->access[i].waiter);
}

int task_overwrite(struct task_graph *graph, struct task *task, size_t i,
                   struct data_object *object, struct data_version *version, uint32_t *done)
{
    struct data_version *out = data_object_version(object);
    if (!out) {
        base_no_memory("a version");
        return task_break(graph);
    }
    object->current = out;
    *done += data_version_overwrite(version, out, &task->access[i].waiter);
    return DUITE_OK;
}

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

static int copy_send(struct task_graph *graph, struct worker *worker, struct data_object *object,
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

static int copy_await(struct task_graph *graph, struct worker *worker, struct data_object *object)
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
    if (!task_note_copy(graph, object, to))
        return DUITE_OK;
    if (graph->rank == to)
        return copy_await(graph, worker, object);
    if (graph->rank == object->holder)
        return copy_send(graph, worker, object, to);
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

static void access_read(struct task_fork_call *call, size_t i, const struct data_object *object,
                        struct data_version *version, bool postponed)
{
    if (!postponed) {
        task_read(call->task, i, version, &call->done);
        return;
    }
    data_version_hold(version);
    task_lend(call->task->inner, &call->task->access[i], object, version, NULL);
    call->done++;
}

/* The scope of the task gets the object's hold on the version; the object has from now on the one
 * that its children will leave. */
static int access_lend(struct task_fork_call *call, size_t i, struct data_object *object,
                       struct data_version *version)
{
    struct data_version *out = data_object_version(object);
    if (!out) {
        base_no_memory("a version");
        return task_break(call->scope->graph);
    }
    task_lend(call->task->inner, &call->task->access[i], object, version, out);
    object->current = out;
    call->done++;
    return DUITE_OK;
}

static int access_contribute(struct task_fork_call *call, size_t i, struct data_object *object,
                             bool postponed)
{
    int code = task_contribute(call, object, i);
    if (!code && call->task && postponed)
        task_lend(call->task->inner, &call->task->access[i], object, NULL, NULL);
    call->done += !code;
    return code;
}

/* The rank that runs the task, or all of them, gets the value that the task reads. */
static int access_fetch(struct task_fork_call *call, struct data_object *object, bool everywhere)
{
    struct task_graph *graph = call->scope->graph;
    return everywhere ? task_fetch_all(graph, call->worker, object)
                      : task_fetch(graph, call->worker, object, call->at);
}

/* The task writes the object, which then has a new version on this rank, or none. */
static int access_write(struct task_fork_call *call, size_t i, struct data_object *object,
                        struct data_version *version, duite_mode declared, bool everywhere)
{
    struct task_graph *graph = call->scope->graph;
    task_note_version(object, everywhere ? object->home : call->at);
    for (int rank = 0; everywhere && rank < graph->n_ranks; rank++)
        task_note_copy(graph, object, rank);
    if (!call->task) {
        task_forget(graph, call->worker, object);
        return DUITE_OK;
    }
    return task_postponed(declared)
               ? access_lend(call, i, object, version)
               : task_overwrite(graph, call->task, i, object, version, &call->done);
}

__attribute__((noinline)) static int access_depend(struct task_fork_call *call, size_t i,
                                                   duite_mode declared)
{
    struct task_graph *graph = call->scope->graph;
    struct data_object *object = task_fork_object(call, i);
    duite_mode mode = task_immediate(declared);
    bool everywhere = call->kernel->replicated && !call->scope->depth;
    int code = DUITE_OK;
    if (object->leaves && !data_order_joins(mode, data_law_of(call->kernel, i), object->law))
        code = task_reduce(call->scope, call->worker, object);
    if (!code && mode == DUITE_CW)
        return access_contribute(call, i, object, task_postponed(declared));
    if (!code && data_order_reads(mode) && graph->n_ranks > 1)
        code = access_fetch(call, object, everywhere);
    if (code)
        return code;
    struct data_version *version = object->current;
    if (call->task && data_order_reads(mode) && !(version = task_local(graph, object)))
        return DUITE_E_MEMORY;
    if (data_order_writes(mode))
        return access_write(call, i, object, version, declared, everywhere);
    if (call->task)
        access_read(call, i, object, version, task_postponed(declared));
    return DUITE_OK;
}

/* All accesses. *made: those before the one that failed. */
static int depend_each(struct task_fork_call *call, size_t *made)
{
    const size_t n_listed = call->scope->graph->fixed[call->index].n;
    int code = DUITE_OK;
    for (*made = 0; *made < call->n && !code; *made += !code) {
        /* As data_mode_of, without a look for the end of the list. */
        duite_mode mode = *made < n_listed ? call->kernel->access[*made] : call->kernel->variadic;
        if (call->task)
            call->task->access[*made].waiter.mode = mode;
        code = access_depend(call, *made, mode);
    }
    return code;
}

int task_depend(struct task_fork_call *call)
{
    struct task *task = call->task;
    struct task_graph *graph = call->scope->graph;
    size_t made = 0;
    const int code = depend_each(call, &made);
    if (code && task)
        task_void(graph, call->worker, task, made, call->done);
    else if (task)
        task_settled(graph, call->worker, task, call->done);
    return code;
}
