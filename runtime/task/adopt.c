/* Objects whose memory is the program's (data/adopted.h): their beginning, and their end. In
 * between they are objects like any other. */
#include "runtime/task/ready.h"

#include "runtime/data/adopted.h"
#include "runtime/data/object.h"

#include <stdio.h>

/* ---- The beginning ---- */

/* The memory's first value. */
static void adopt_value(struct task_graph *graph, struct data_object *object,
                        struct data_version *version, int code)
{
    struct data_failure failure = {
        .code = code, .rank = graph->rank, .number = graph->root.forks, .kernel = UINT32_MAX};
    if (!code) {
        version->packet = data_adopted_take(object->memory);
    } else {
        snprintf(failure.text, sizeof failure.text, "%s", duite_message());
        data_version_poison(version, task_fail(graph, &failure, &graph->root));
    }
    data_version_produced(version);
    data_version_release(version); /* the object alone holds it */
    object->current = version;
}

/* The main program may wait for it. */
static void adopt_rested(void *graph)
{
    queue_notify(((const struct task_graph *)graph)->pool);
}

int task_adopt(struct task_graph *graph, struct data_object *object, void *values, duite_done *done,
               void *user)
{
    object->adopted = object->fixed = true;
    task_note_version(object, object->home);
    if (object->home != graph->rank)
        return DUITE_OK;
    struct data_version *version = data_object_version(object);
    if (!version)
        return task_break(graph, "a version");
    const struct data_adopted like = {
        .packet = {.bytes = object->bytes, .kind = DATA_VALUE, .elsewhere = values},
        .done = done,
        .user = user,
        .rested = adopt_rested,
        .context = graph};
    const int code = data_adopted_new(&like, data_type_size(object->type), &object->memory);
    adopt_value(graph, object, version, code);
    return code == DUITE_E_MEMORY ? task_break(graph, "adopted memory") : code;
}

/* ---- The end ---- */

int task_leave(struct task_graph *graph, struct worker *worker, struct data_object *object)
{
    int code = task_fetch(graph, worker, object, object->home);
    if (code || !object->memory)
        return code;
    struct task *task = task_local(graph, object) ? task_new(&graph->root, TASK_LEAVE, 1, 0) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    uint32_t done = 0;
    task->adopted = object->memory;
    task->block = object->block;
    task->access[0].waiter.mode = DUITE_RW;
    code = task_wait(&graph->root, task, 0, object, &done);
    if (code) { /* the memory is given back without it */
        task->n = 0;
        done = 1;
    }
    object->memory = NULL;
    ready_take(graph, worker, task, done + 1);
    return code;
}

/* The task is the last that has the value. */
void task_run_leave(struct task *task)
{
    struct data_version *version = task->n ? task->access[0].waiter.version : NULL;
    struct data_packet *last = version ? data_version_packet(version) : NULL;
    if (last)
        version->packet = NULL;
    data_adopted_leave(task->adopted, last);
}

void task_leave_now(struct data_object *object)
{
    struct data_version *version = object->current;
    struct data_packet *last = version ? data_version_packet(version) : NULL;
    if (version && atomic_load_explicit(&version->holds, memory_order_acquire) != 1)
        return;
    if (last)
        version->packet = NULL;
    data_adopted_leave(object->memory, last);
    object->memory = NULL;
}
