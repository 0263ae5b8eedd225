/* Forking: every rank comes through here for every task, in the same order, and draws the same
 * conclusions about where it runs and which versions move; it keeps only what it runs, sends or
 * receives itself. */
#include "runtime/graph/internal.h"

#include "runtime/base/error.h"
#include "runtime/data/mode.h"

#include <duite_policy.h>
#include <string.h>

void graph_mix(struct graph *graph, uint64_t value)
{
    uint64_t state = graph->fingerprint ^ value;
    graph->fingerprint = duite_random(&state);
}

static int find_kernel(const struct graph *graph, const duite_kernel *kernel, uint32_t *index)
{
    if (!kernel)
        return base_error(DUITE_E_ARGUMENT, "duite_fork: no kernel");
    for (*index = 0; *index < graph->n_kernels; ++*index)
        if (graph->kernels[*index] == kernel)
            return DUITE_OK;
    return base_error(DUITE_E_KERNEL, "kernel %s was not listed at start",
                      kernel->name ? kernel->name : "without a name");
}

/* Kernel, arguments and number of objects fit. */
static int check_call(const struct graph *graph, int at, uint32_t index, const void *args, size_t n,
                      const duite_object *objects)
{
    const duite_kernel *kernel = graph->kernels[index];
    size_t fixed = graph->n_fixed[index];
    if (n < fixed || (n > fixed && kernel->rest == DUITE_NONE) || n > UINT32_MAX / 2)
        return base_error(DUITE_E_ACCESS, "kernel %s takes %s%zu objects, not %zu", kernel->name,
                          kernel->rest == DUITE_NONE ? "" : "at least ", fixed, n);
    if (n && !objects)
        return base_error(DUITE_E_ARGUMENT, "kernel %s: no objects given", kernel->name);
    if (kernel->args_size && !args)
        return base_error(DUITE_E_ARGUMENT, "kernel %s needs %zu bytes of arguments", kernel->name,
                          kernel->args_size);
    if (at < GRAPH_ANYWHERE || at >= graph->n_ranks)
        return base_error(DUITE_E_ARGUMENT, "kernel %s: there is no rank %d, only 0 to %d",
                          kernel->name, at, graph->n_ranks - 1);
    return DUITE_OK;
}

static int check_law(const duite_kernel *kernel, size_t i, const struct data_object *object,
                     duite_object name)
{
    const duite_law *law = data_law_of(kernel, i);
    if (object->sized)
        return base_error(DUITE_E_ACCESS,
                          "kernel %s, parameter %zu: object %u.%u changes its size and cannot be "
                          "accumulated into",
                          kernel->name, i, name.slot, name.generation);
    if (data_law_fits(law, object->type))
        return DUITE_OK;
    return base_error(DUITE_E_LAW,
                      "kernel %s, parameter %zu: law %s is for %s, and object %u.%u has %s",
                      kernel->name, i, law->name, data_type_name(law->type), name.slot,
                      name.generation, data_type_name(object->type));
}

/* Every object exists, is named once, and can be accumulated into where it is. */
static int check_objects(struct graph *graph, const duite_kernel *kernel, size_t n,
                         const duite_object *objects)
{
    uint64_t mark = graph->forks + 1;
    for (size_t i = 0; i < n; i++) {
        struct data_object *object = data_object_find(&graph->table, objects[i]);
        if (!object)
            return base_error(DUITE_E_OBJECT, "kernel %s, parameter %zu: object %u.%u %s",
                              kernel->name, i, objects[i].slot, objects[i].generation,
                              objects[i].slot ? "was freed or never made" : "names nothing");
        if (object->mark == mark)
            return base_error(DUITE_E_ACCESS,
                              "kernel %s, parameter %zu: the task names object %u.%u twice",
                              kernel->name, i, objects[i].slot, objects[i].generation);
        if (data_mode_of(kernel, i) == DUITE_CW) {
            int code = check_law(kernel, i, object, objects[i]);
            if (code)
                return code;
        }
        object->mark = mark;
    }
    return DUITE_OK;
}

void graph_unmark(struct graph *graph, size_t n, const duite_object *objects)
{
    for (size_t i = 0; i < n; i++)
        if (objects[i].slot < graph->table.n_slots)
            graph->table.object[objects[i].slot].mark = 0;
}

/* The owner rule: the object where a task runs; NULL if it only accumulates. */
static const struct data_object *owner(const struct graph *graph, const duite_kernel *kernel,
                                       size_t n, const duite_object *objects)
{
    const struct data_object *first_read = NULL;
    for (size_t i = 0; i < n; i++) {
        duite_mode mode = data_mode_of(kernel, i);
        const struct data_object *object = &graph->table.object[objects[i].slot];
        if (mode == DUITE_W || mode == DUITE_RW)
            return object;
        if (mode == DUITE_R && !first_read)
            first_read = object;
    }
    return first_read;
}

/* Access i of a task that runs on rank `at`; `task` is NULL on the other ranks. */
static int use(struct graph *graph, void *worker, int at, const duite_kernel *kernel, size_t i,
               duite_object name, struct graph_task *task, uint32_t *done)
{
    duite_mode mode = data_mode_of(kernel, i);
    struct data_object *object = &graph->table.object[name.slot];
    int code = DUITE_OK;
    if (task) {
        task->access[i].mode = mode;
        task->access[i].bytes = object->room;
        task->access[i].sized = object->sized;
        task->param[i] =
            (duite_param){.count = object->most, .type = object->type, .most = object->most};
    }
    if (mode == DUITE_CW) {
        code = graph_contribute(graph, worker, object, data_law_of(kernel, i), at, task, i);
        *done += !code;
        return code;
    }
    if (object->leaves)
        code = graph_close(graph, worker, object);
    if (!code && mode != DUITE_W)
        code = graph_fetch(graph, worker, object, at);
    if (code)
        return code;
    struct data_version *version = object->current;
    if (task && mode != DUITE_W && !(version = graph_local(graph, object)))
        return DUITE_E_MEMORY;
    if (mode == DUITE_R) {
        if (task)
            graph_read(task, i, version, done);
        return DUITE_OK;
    }
    object->number++;
    data_object_moved(object, at);
    if (mode == DUITE_W && task)
        version = graph_rename(graph, worker, object);
    if (task)
        return graph_overwrite(graph, task, i, object, version, done);
    graph_forget(graph, worker, object);
    return DUITE_OK;
}

static struct graph_task *body_task(struct graph *graph, const struct graph_how *how,
                                    uint32_t index, const void *args, size_t n)
{
    const duite_kernel *kernel = graph->kernels[index];
    struct graph_task *task = graph_task_new(graph, GRAPH_BODY, n, kernel->args_size);
    if (!task)
        return NULL;
    task->kernel = index;
    task->priority = how->priority;
    task->cost = how->cost;
    if (kernel->args_size)
        memcpy(task->args, args, kernel->args_size);
    return task;
}

/* Memory ran out at access `made`: the accesses before it are kept, or others would wait for ever.
 */
void graph_void(struct graph *graph, void *worker, struct graph_task *task, size_t made,
                uint32_t done)
{
    uint32_t missing = task->n - (uint32_t)made;
    task->kind = GRAPH_VOID;
    task->n = (uint32_t)made;
    graph_settled(graph, worker, task, done + missing);
}

int graph_check(struct graph *graph, int at, const duite_kernel *kernel, const void *args, size_t n,
                const duite_object *objects, uint32_t *index)
{
    int code = find_kernel(graph, kernel, index);
    if (!code)
        code = check_call(graph, at, *index, args, n, objects);
    if (code)
        return code;
    code = check_objects(graph, kernel, n, objects);
    if (code)
        graph_unmark(graph, n, objects);
    return code;
}

int graph_fork(struct graph *graph, void *worker, const struct graph_how *how,
               const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects)
{
    uint32_t index = 0, done = 0;
    int at = how->at;
    int code = graph_check(graph, at, kernel, args, n, objects, &index);
    if (code)
        return code;
    graph->forks++;
    graph_mix(graph, (uint64_t)index << 32 | (uint32_t)at);
    const struct data_object *own = owner(graph, kernel, n, objects);
    if (at == GRAPH_ANYWHERE)
        at = own ? own->home : 0;
    struct graph_task *task = NULL;
    if (at == graph->rank && !(task = body_task(graph, how, index, args, n)))
        return DUITE_E_MEMORY;
    if (task && own)
        task->block = own->block;
    for (size_t i = 0; i < n; i++) {
        graph_mix(graph, (uint64_t)objects[i].slot << 32 | objects[i].generation);
        code = use(graph, worker, at, kernel, i, objects[i], task, &done);
        if (code && task)
            graph_void(graph, worker, task, i, done);
        if (code)
            return code;
    }
    if (task)
        graph_settled(graph, worker, task, done);
    return DUITE_OK;
}

int graph_free(struct graph *graph, void *worker, duite_object name)
{
    struct data_object *object = data_object_find(&graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    graph_mix(graph, (uint64_t)name.slot << 32 | name.generation);
    int code = object->leaves ? graph_close(graph, worker, object) : DUITE_OK;
    graph_forget(graph, worker, object);
    data_object_drop(&graph->table, name);
    return code;
}

int graph_copy(struct graph *graph, void *worker, duite_object name, int to,
               struct graph_copy *copy)
{
    struct data_object *object = data_object_find(&graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    if (to < GRAPH_ANYWHERE || to >= graph->n_ranks)
        return base_error(DUITE_E_ARGUMENT, "duite_get_at: there is no rank %d, only 0 to %d", to,
                          graph->n_ranks - 1);
    graph_mix(graph, (uint64_t)name.slot << 32 | (uint32_t)to);
    int code = object->leaves ? graph_close(graph, worker, object) : DUITE_OK;
    for (int rank = 0; rank < graph->n_ranks && !code; rank++)
        if (to == GRAPH_ANYWHERE || to == rank)
            code = graph_fetch(graph, worker, object, rank);
    if (code || (to != GRAPH_ANYWHERE && to != graph->rank))
        return code;
    struct data_version *version = graph_local(graph, object);
    struct graph_task *task = version ? graph_task_new(graph, GRAPH_COPY, 1, 0) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    task->copy = copy;
    task->block = object->block;
    uint32_t done = 0;
    task->access[0].mode = DUITE_R;
    graph_read(task, 0, version, &done);
    graph_settled(graph, worker, task, done);
    return DUITE_OK;
}
