/* Operations on objects without a task of the program: free, read, set, resize, and moves of homes.
 * Each leaves a version, or a task of the runtime that makes one, as a fork would; every rank
 * concludes the same. */
#include "runtime/task/ready.h"
#include "runtime/task/scope.h"

#include "runtime/data/object.h"

#include <string.h>

int task_free_object(struct task_scope *scope, struct worker *worker, duite_object name)
{
    struct task_graph *graph = scope->graph;
    duite_mode right;
    struct data_object *object = task_find_object(scope, name, &right);
    if (!object)
        return DUITE_E_OBJECT;
    if (object->part)
        return base_error(DUITE_E_STATE,
                          "duite_free: object %u.%u is a part of another one: duite_join ends it",
                          name.slot, name.generation);
    if (!scope->depth) {
        task_mix(graph, task_name_bits(name));
        task_mixed(graph, COMM_CALLED, COMM_CALLED_FREE);
    }
    int code = object->leaves ? task_reduce(scope, worker, object) : DUITE_OK;
    if (object->adopted && !scope->depth && !code)
        code = task_leave(graph, worker, object);
    task_forget(graph, worker, object);
    if (scope->depth)
        task_drop(scope, object);
    else
        data_object_drop(&graph->table, name);
    return code;
}

/* A task of the runtime waits for the object's value. */
static int object_read(struct task_graph *graph, struct worker *worker,
                       const struct data_object *object, enum task_type type,
                       struct task_copy *copy)
{
    struct task *task = task_new(&graph->root, type, 1, 0);
    if (!task)
        return DUITE_E_MEMORY;
    task->copy = copy;
    task->block = object->block;
    task->access[0].waiter.mode = DUITE_R;
    ready_take(graph, worker, task,
               1 + data_version_read(object->current, &task->access[0].waiter));
    return DUITE_OK;
}

int task_copy(struct task_graph *graph, struct worker *worker, duite_object name, int to,
              struct task_copy *copy)
{
    struct data_object *object = data_object_find(&graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    if (to < TASK_ANYWHERE || to >= graph->n_ranks)
        return base_error(DUITE_E_ARGUMENT, "duite_get_at: there is no rank %d, only 0 to %d", to,
                          graph->n_ranks - 1);
    task_mix(graph, (uint64_t)name.slot << 32 | (uint32_t)to);
    int code = object->leaves ? task_reduce(&graph->root, worker, object) : DUITE_OK;
    if (!code)
        code = to == TASK_ANYWHERE ? task_fetch_all(graph, worker, object)
                                   : task_fetch(graph, worker, object, to);
    if (code || (to != TASK_ANYWHERE && to != graph->rank))
        return code;
    return task_local(graph, object) ? object_read(graph, worker, object, TASK_COPY, copy)
                                     : DUITE_E_MEMORY;
}

int task_close(struct task_graph *graph, struct worker *worker, duite_object name)
{
    struct data_object *object = data_object_find(&graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    task_mix(graph, task_name_bits(name));
    return object->leaves ? task_reduce(&graph->root, worker, object) : DUITE_OK;
}

/* The value that this rank makes or keeps for all; a copy of another rank's may still be on its
 * way. NULL: there is none. */
static struct data_version *value_held(const struct task_graph *graph,
                                       const struct data_object *object)
{
    return object->holder == graph->rank ? object->current : NULL;
}

int task_await(struct task_graph *graph, struct worker *worker, duite_object name,
               struct task_copy *copy)
{
    const int code = task_close(graph, worker, name);
    const struct data_object *object = code ? NULL : data_object_here(&graph->table, name);
    if (object && value_held(graph, object))
        return object_read(graph, worker, object, TASK_COPY, copy);
    atomic_store_explicit(&copy->done, 1, memory_order_relaxed);
    return code;
}

bool task_is_there(const struct task_graph *graph, duite_object name)
{
    const struct data_version *value = value_held(graph, &graph->table.object[name.slot]);
    return !value || data_version_ready(value);
}

int task_see(struct duite_call_private *body, const char *call, duite_object name,
             struct data_version **version, size_t *size)
{
    struct task_scope *scope = task_inside(body);
    struct data_object *object = scope ? task_find_given(scope, name, DUITE_R) : NULL;
    int code = object ? DUITE_OK : task_check_call(body, call, name, DUITE_R);
    duite_mode right;
    if (!object && !code)
        object = task_find_object(scope, name, &right);
    if (!object)
        return code ? code : DUITE_E_OBJECT;
    *size = data_type_size(object->type);
    if (object->leaves)
        code = task_reduce(scope, body->worker, object);
    if (!code && !(*version = task_local(scope->graph, object)))
        code = DUITE_E_MEMORY;
    return code;
}

struct data_version *task_see_given(struct duite_call_private *body, duite_object name)
{
    struct task_scope *scope = body->scope;
    struct data_object *object = scope ? task_find_given(scope, name, DUITE_R) : NULL;
    return object && !object->leaves ? object->current : NULL;
}

/* ---- duite_set: a version that nobody has to wait for, so no task is needed and the old one is
 * left to its readers ---- */

enum { OVERWRITTEN = 0x736574 }; /* tells a set from a free in the fingerprint */

struct data_version *task_value_version(const struct data_object *object, const void *values,
                                        size_t bytes)
{
    struct data_version *version = data_object_version(object);
    struct data_packet *packet = version ? data_packet_new(bytes, !values) : NULL;
    if (packet) {
        if (values)
            memcpy(data_payload(packet), values, bytes);
        version->packet = packet;
        data_version_produced(version);
        data_version_release(version); /* nobody produces it: the object alone holds it */
    } else if (version) {
        data_version_free(version);
        version = NULL;
    }
    return version;
}

int task_set_check(const struct data_object *object, duite_object name, size_t count)
{
    if (count == object->max || (object->sized && count < object->max))
        return DUITE_OK;
    return base_error(DUITE_E_SIZE, "duite_set_sized: %zu elements, and object %u.%u has %s%zu",
                      count, name.slot, name.generation, object->sized ? "at most " : "",
                      object->max);
}

int task_set_object(struct task_scope *scope, struct worker *worker, duite_object name, int at,
                    const void *values, const size_t *wanted)
{
    struct task_graph *graph = scope->graph;
    duite_mode right;
    struct data_object *object = task_find_object(scope, name, &right);
    if (!object)
        return DUITE_E_OBJECT;
    size_t count = wanted ? *wanted : object->max;
    int code = task_set_check(object, name, count);
    if (code)
        return code;
    if (!scope->depth) {
        task_mix(graph, task_name_bits(name));
        task_mix(graph, OVERWRITTEN + (uint64_t)(at - TASK_ANYWHERE));
        task_mix(graph, count);
        task_mixed(graph, COMM_CALLED, at == TASK_ANYWHERE ? COMM_CALLED_SET : COMM_CALLED_SET_AT);
    }
    struct data_version *version = NULL;
    const int holder = at == TASK_ANYWHERE ? object->home : at;
    const size_t bytes = count * data_type_size(object->type);
    if (holder == graph->rank && !(version = task_value_version(object, values, bytes)))
        return task_break(graph, "the values of duite_set");
    code = object->leaves ? task_reduce(scope, worker, object) : DUITE_OK;
    task_note_version(object, holder);
    task_forget(graph, worker, object);
    object->current = version;
    return code;
}

/* ---- Homes that change: a value is not tied to its object's home, since readers find its holder.
 * So a move is one more copy, whose holder is then the new home; copies on other ranks stay good
 * ---- */

/* Zeros, as at the beginning, need no message. */
static void move_zeros(struct task_graph *graph, struct worker *worker, struct data_object *object,
                       int to)
{
    if (graph->rank != to)
        task_forget(graph, worker, object);
    data_object_moved(object, to);
}

static int move_value(struct task_graph *graph, struct worker *worker, struct data_object *object,
                      int to)
{
    bool sent = !data_object_has_copy(&graph->table, object, to);
    bool held = graph->rank == object->holder;
    int code = sent ? task_fetch(graph, worker, object, to) : DUITE_OK;
    if (!code && sent && graph->rank == to) /* messages belong to tasks: none may be left at stop */
        code = object_read(graph, worker, object, TASK_MOVE, NULL);
    if (code)
        return code;
    data_object_hand_on(&graph->table, object, to);
    if (held)
        task_forget(graph, worker, object);
    return DUITE_OK;
}

int task_move_object(struct task_graph *graph, struct worker *worker, struct data_object *object,
                     int home)
{
    int from = object->home;
    object->home = home;
    graph->table.changes++;
    if (object->holder != from || object->leaves || from == home)
        return DUITE_OK;
    if (object->number)
        return move_value(graph, worker, object, home);
    move_zeros(graph, worker, object, home);
    return DUITE_OK;
}

/* ---- Objects whose size changes. The body works in room for the maximum and says how many
 * elements there are. The packet it leaves has just these, and so have its readers and messages
 * ---- */

/* True if the object of parameter i changes its size; false in a plan, whose objects have fixed
 * sizes. */
static bool param_is_sized(const duite_call *call, size_t i)
{
    const struct task *task = call->own->task;
    const struct task_access *access = &task->access[i];
    if (TASK_IS(task, TASK_TYPE_BIT(TASK_NODE)) || access->waiter.mode == DUITE_CW)
        return false;
    if (task_postponed((duite_mode)access->waiter.mode))
        return task_lent_object(call->own->scope, access->lent)->sized;
    if (task->type == TASK_OFFLOADED)
        return access->sized;
    return access->waiter.version->sized;
}

static bool param_is_written(const struct task *task, size_t i)
{
    duite_mode mode = (duite_mode)task->access[i].waiter.mode;
    return mode == DUITE_W || mode == DUITE_RW;
}

static int resize_refuse(const duite_call *call, size_t i, bool sized, size_t count)
{
    if (i >= call->n_params)
        duite_fail(call, 0, "duite_resize: there is no parameter %zu, only %zu", i, call->n_params);
    else if (!sized)
        duite_fail(call, 0, "duite_resize: the object of parameter %zu has a fixed size", i);
    else if (task_postponed((duite_mode)call->own->task->access[i].waiter.mode))
        duite_fail(call, 0, "duite_resize: parameter %zu is its children's alone", i);
    else if (!param_is_written(call->own->task, i))
        duite_fail(call, 0, "duite_resize: parameter %zu is only read", i);
    else
        duite_fail(call, 0, "duite_resize: parameter %zu: %zu elements are more than %zu at most",
                   i, count, call->param[i].max);
    call->own->refused = DUITE_E_SIZE;
    return base_error(DUITE_E_SIZE, "%s", call->own->text);
}

int duite_resize(const duite_call *call, size_t i, size_t count)
{
    struct task *task = call->own->task;
    bool sized = i < call->n_params && param_is_sized(call, i);
    if (!sized || !param_is_written(task, i) || count > call->param[i].max)
        return resize_refuse(call, i, sized, count);
    duite_param *param = (duite_param *)&call->param[i]; /* ours to write */
    size_t size = data_type_size(param->type);
    if (count > param->count)
        memset((char *)param->data + param->count * size, 0, (count - param->count) * size);
    param->count = count;
    return DUITE_OK;
}
