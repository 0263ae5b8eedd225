/* The short way of most forks: of a plain kernel, which lists a few parameters under r, w and rw
 * and nothing else (task_fixed.plain), where no other rank has part in the task. It makes of a fork
 * what fork.c and depend.c make of it together, in one go over the objects. Whatever it does not
 * know it leaves to them, before anything is changed: views, contributions, values that are not
 * here, and all errors but want of memory. So no rule stands here alone. */
#include "runtime/task/ready.h"
#include "runtime/task/scope.h"

#include "runtime/base/error.h"

#include <string.h>

/* Compiled once for the main program and once for bodies, whose functions are at the end. */
#define PLAIN_INLINE __attribute__((always_inline)) static inline

/* A fork under way, in registers mostly. */
struct plain_fork {
    struct task_graph *graph;
    struct task_scope *scope;
    struct worker *worker;
    const struct task_fixed *fixed;
    struct data_object *object[TASK_FEW];
    bool nested; /* a body's */
};

/* The first n objects are not named by this fork after all. */
static void plain_unmark(struct plain_fork *fork, uint32_t n)
{
    while (n > 0)
        fork->object[--n]->mark = 0;
}

/* Finds the objects, and marks them as named by this fork. False: one of them needs a second look;
 * nothing was done. */
PLAIN_INLINE bool plain_take_objects(struct plain_fork *fork, const duite_object *name)
{
    struct task_scope *const scope = fork->scope;
    struct data_table *const table = &fork->graph->table;
    const duite_mode *const mode = fork->fixed->kernel->access;
    const uint64_t mark = scope->forks + 1;
    const uint32_t n = fork->fixed->n;
    for (uint32_t i = 0; i < n; i++) {
        struct data_object *object = fork->nested ? task_find_given(scope, name[i], mode[i])
                                                  : data_object_here(table, name[i]);
        if (object && object->mark != mark && !((uintptr_t)object->view | object->leaves) &&
            (object->current || mode[i] == DUITE_W)) {
            object->mark = mark;
            fork->object[i] = object;
            continue;
        }
        plain_unmark(fork, i);
        return false;
    }
    return true;
}

/* The task without its accesses, counted as unfinished. NULL without memory. */
PLAIN_INLINE struct task *plain_make(const struct plain_fork *fork, const void *args)
{
    const struct task_fixed *fixed = fork->fixed;
    struct task_scope *scope = fork->scope;
    struct data_object *own = fixed->owner[0] == TASK_NOBODY ? NULL : fork->object[fixed->owner[0]];
    struct task *task = base_pool_take((size_t)fixed->grains * TASK_GRAIN);
    if (!task)
        return NULL;
    *task = *fixed->head;
    task->scope = scope;
    task->number = scope->forks;
    task->block = own ? own->block : (uint32_t)scope->forks;
    if (own)
        own->fixed |= fixed->kernel->fixed;
    if (fixed->kernel->args_size)
        memcpy(task_rest(task, fixed->n), args, fixed->kernel->args_size);
    if (fork->nested)
        atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    else
        fork->graph->tasks++;
    return task;
}

/* The accesses become holds on versions, and places of heirs. *made: those before the one for which
 * there was no memory. Returns how many have nothing to wait for. */
PLAIN_INLINE uint32_t plain_depend(const struct plain_fork *fork, struct task *task, uint32_t *made)
{
    struct task_graph *const graph = fork->graph;
    const duite_mode *mode = fork->fixed->kernel->access;
    struct data_object *const *of = fork->object;
    struct task_access *access = task->access, *const end = access + fork->fixed->n;
    uint32_t done = 0;
    for (; access < end; access++, mode++, of++) {
        struct data_object *object = *of;
        struct data_version *version = object->current, *out = NULL;
        access->waiter.back = (uint32_t)((char *)access - (char *)task);
        access->waiter.mode = *mode;
        access->in = version;
        access->out = NULL;
        if (*mode == DUITE_R) {
            data_version_hold(version);
            done += !data_version_await(version, &access->waiter);
            continue;
        }
        task_note_version(object, graph->rank);
        if (*mode == DUITE_W && graph->rename_max)
            access->in = version = task_rename(graph, fork->worker, object);
        out = fork->nested ? task_child_version(fork->scope, object, !version)
                           : data_object_version(object);
        if (!out)
            break;
        access->out = object->current = out;
        if (version)
            version->heir = &access->waiter;
        done += !version || data_version_release(version) != NULL;
    }
    *made = (uint32_t)(access - task->access);
    return done;
}

static int plain_no_memory(struct task_graph *graph, const char *what)
{
    base_no_memory(what);
    return task_break(graph);
}

/* The objects are found. */
PLAIN_INLINE int plain_fork(const struct plain_fork *fork, const struct task_options *options,
                            const void *args)
{
    struct task_graph *graph = fork->graph;
    uint32_t made;
    fork->scope->forks++;
    struct task *task = plain_make(fork, args);
    if (!task)
        return plain_no_memory(graph, "a task");
    if (options) {
        task->priority = options->priority;
        task->cost = (float)options->cost;
    }
    const uint32_t done = plain_depend(fork, task, &made);
    if (made == fork->fixed->n) {
        ready_take(graph, fork->worker, task, done + 1);
        return DUITE_OK;
    }
    const int code = plain_no_memory(graph, "a version");
    task_void(graph, fork->worker, task, made, done);
    return code;
}

/* Whether the fork is such, and its objects are found. */
PLAIN_INLINE bool plain_fits(struct plain_fork *fork, const duite_kernel *kernel, const void *args,
                             size_t n, const duite_object *objects)
{
    const struct task_graph *graph = fork->graph;
    const uint32_t index = task_kernel_index(graph, kernel);
    const struct task_fixed *fixed = fork->fixed = &graph->fixed[index];
    return index < graph->n_kernels && (fork->nested ? fixed->plain : fixed->direct) &&
           n == fixed->n && (args || !kernel->args_size) && (objects || !n) &&
           plain_take_objects(fork, objects);
}

/* The compiler knows `nested` and whether there are options. */
PLAIN_INLINE int plain_try(struct task_scope *scope, struct worker *worker,
                           const struct task_options *options, const duite_kernel *kernel,
                           const void *args, size_t n, const duite_object *objects, bool nested)
{
    static const struct task_options none = {.at = TASK_ANYWHERE};
    struct plain_fork fork; /* `object` stays unset, which would take time */
    fork.graph = scope->graph;
    fork.scope = scope;
    fork.worker = worker;
    fork.nested = nested;
    if (plain_fits(&fork, kernel, args, n, objects))
        return plain_fork(&fork, options, args);
    return task_fork_any(scope, worker, options ? options : &none, kernel, args, n, objects);
}

int task_fork_main(struct task_graph *graph, struct worker *worker, const duite_kernel *kernel,
                   const void *args, size_t n, const duite_object *objects)
{
    return plain_try(&graph->root, worker, NULL, kernel, args, n, objects, false);
}

int task_fork_nested(struct task_scope *scope, struct worker *worker, const duite_kernel *kernel,
                     const void *args, size_t n, const duite_object *objects)
{
    return plain_try(scope, worker, NULL, kernel, args, n, objects, true);
}

int task_fork(struct task_scope *scope, struct worker *worker, const struct task_options *options,
              const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects)
{
    if (options->at != TASK_ANYWHERE)
        return task_fork_any(scope, worker, options, kernel, args, n, objects);
    return plain_try(scope, worker, options, kernel, args, n, objects, scope->depth != 0);
}
