/* The short way of most forks: of a plain kernel, which lists a few parameters under r, w and rw
 * and nothing else (task_fixed.plain), where no other rank has part in the task. It makes of a fork
 * what fork.c and depend.c make of it together, in one go over the objects. Whatever it does not
 * know it leaves to them, before anything is changed: views, contributions, values that are not
 * here, and all errors but want of memory. So no rule stands here alone. */
#include "runtime/task/ready.h"
#include "runtime/task/scope.h"

#include "runtime/base/error.h"

#include <string.h>

/* A fork under way, in registers mostly: all of it is inline. */
struct plain_fork {
    struct task_scope *scope;
    struct worker *worker;
    const struct task_fixed *fixed;
    struct data_object *object[TASK_FEW];
};

/* Finds the objects, and marks them as named by this fork. False: one of them needs a second look;
 * nothing was done. */
static inline bool plain_take_objects(struct plain_fork *fork, const duite_object *name)
{
    struct task_scope *const scope = fork->scope;
    struct data_table *const table = scope->depth ? NULL : &scope->graph->table;
    const duite_mode *const mode = fork->fixed->kernel->access;
    const uint64_t mark = scope->forks + 1;
    const uint32_t n = fork->fixed->n;
    for (uint32_t i = 0; i < n; i++) {
        struct data_object *object =
            table ? data_object_here(table, name[i]) : task_find_given(scope, name[i], mode[i]);
        if (object && object->mark != mark && !object->view && !object->leaves &&
            (object->current || mode[i] == DUITE_W)) {
            object->mark = mark;
            fork->object[i] = object;
            continue;
        }
        while (i > 0)
            fork->object[--i]->mark = 0;
        return false;
    }
    return true;
}

/* The task without its accesses, counted as unfinished. NULL without memory. */
static inline struct task *plain_make(const struct plain_fork *fork,
                                      const struct task_options *options, const void *args)
{
    const struct task_fixed *fixed = fork->fixed;
    struct task_scope *scope = fork->scope;
    struct data_object *own = fixed->owner[0] == TASK_NOBODY ? NULL : fork->object[fixed->owner[0]];
    struct task *task = base_pool_take((size_t)fixed->grains * TASK_GRAIN);
    if (!task)
        return NULL;
    *task = (struct task){
        .pending = fixed->n + 1,
        .n = fixed->n,
        .scope = scope,
        .number = scope->forks,
        .kernel = (uint32_t)(fixed - scope->graph->fixed),
        .block = own ? own->block : (uint32_t)scope->forks,
        .priority = options->priority,
        .cost = (float)options->cost,
        .grains = fixed->grains,
        .type = TASK_BODY,
        .placed = own != NULL,
    };
    if (own)
        own->fixed |= fixed->kernel->fixed;
    if (fixed->kernel->args_size)
        memcpy(task_rest(task, fixed->n), args, fixed->kernel->args_size);
    if (scope->parent)
        atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    else
        scope->graph->tasks++;
    return task;
}

/* The accesses become holds on versions, and places of heirs. *made: those before the one for which
 * there was no memory. Returns how many have nothing to wait for. */
static inline uint32_t plain_depend(const struct plain_fork *fork, struct task *task,
                                    uint32_t *made)
{
    struct task_graph *const graph = fork->scope->graph;
    const duite_mode *const mode = fork->fixed->kernel->access;
    const uint32_t n = fork->fixed->n;
    uint32_t done = 0, i;
    for (i = 0; i < n; i++) {
        struct task_access *access = &task->access[i];
        struct data_object *object = fork->object[i];
        struct data_version *version = object->current, *out = NULL;
        access->waiter.back = (uint32_t)(sizeof *task + i * sizeof *access);
        access->waiter.mode = mode[i];
        access->in = version;
        access->out = NULL;
        if (mode[i] == DUITE_R) {
            data_version_hold(version);
            done += !data_version_await(version, &access->waiter);
            continue;
        }
        task_note_version(object, graph->rank);
        if (mode[i] == DUITE_W && graph->rename_max)
            access->in = version = task_rename(graph, fork->worker, object);
        if (!(out = data_object_version(object)))
            break;
        access->out = object->current = out;
        if (version)
            version->heir = &access->waiter;
        done += !version || data_version_release(version) != NULL;
    }
    *made = i;
    return done;
}

static int plain_no_memory(struct task_graph *graph, const char *what)
{
    base_no_memory(what);
    return task_break(graph);
}

/* The objects are found. */
static inline int plain_fork(const struct plain_fork *fork, const struct task_options *options,
                             const void *args)
{
    struct task_graph *graph = fork->scope->graph;
    uint32_t made;
    fork->scope->forks++;
    struct task *task = plain_make(fork, options, args);
    if (!task)
        return plain_no_memory(graph, "a task");
    const uint32_t done = plain_depend(fork, task, &made);
    if (made == fork->fixed->n) {
        ready_take(graph, fork->worker, task, done + 1);
        return DUITE_OK;
    }
    const int code = plain_no_memory(graph, "a version");
    task_void(graph, fork->worker, task, made, done);
    return code;
}

int task_fork(struct task_scope *scope, struct worker *worker, const struct task_options *options,
              const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects)
{
    const struct task_graph *graph = scope->graph;
    const uint32_t index = task_kernel_index(graph, kernel);
    struct plain_fork fork; /* `object` stays unset, which would take time */
    fork.scope = scope;
    fork.worker = worker;
    fork.fixed = &graph->fixed[index];
    if (index < graph->n_kernels && fork.fixed->plain && n == fork.fixed->n &&
        options->at == TASK_ANYWHERE && (graph->n_ranks == 1 || scope->depth) &&
        (args || !kernel->args_size) && (objects || !n) && plain_take_objects(&fork, objects))
        return plain_fork(&fork, options, args);
    return task_fork_any(scope, worker, options, kernel, args, n, objects);
}
