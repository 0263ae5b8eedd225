/* The short way of most forks. The kernel is plain (task_fixed.plain): it lists a few parameters,
 * all under r, w or rw. No other rank has part in the task. One pass over the objects does the work
 * of fork.c and depend.c. Other cases are left to them before anything is changed: contributions,
 * values that are not here, and all errors but lack of memory. So no rule stands here alone. */
#include "runtime/task/ready.h"
#include "runtime/task/scope.h"

#include "runtime/base/error.h"

#include <string.h>

/* Compiled once for the main program and once for bodies, whose functions are at the end. */
#define PLAIN_INLINE __attribute__((always_inline)) static inline

/* A fork under way. */
struct plain_fork {
    struct task_graph *graph;
    struct task_scope *scope;
    struct worker *worker;
    const struct task_fixed *fixed;
    struct task *task;
    bool nested; /* a body's */
};

/* Unmarks the objects of the accesses before `end`: this fork does not name them after all. */
static void plain_unmark(struct task *task, const struct task_access *end)
{
    for (struct task_access *access = task->access; access < end; access++)
        access->object->mark = 0;
}

/* Finds the objects, and marks them as named by this fork. False: one of them needs a second look;
 * nothing was done. */
PLAIN_INLINE bool plain_take_objects(const struct plain_fork *fork, const duite_object *name)
{
    struct task_scope *const scope = fork->scope;
    struct data_object *const first = fork->graph->table.object;
    const uint32_t n_slots = fork->graph->table.n_slots;
    const struct task_access *like = fork->fixed->head->access;
    struct task_access *access = fork->task->access, *const end = access + fork->fixed->n;
    const uint64_t mark = scope->forks + 1;
    for (; access < end; access++, like++, name++) {
        struct data_object *object = fork->nested ? task_find_given(scope, *name, like->waiter.mode)
                                                  : data_object_usual(first, n_slots, *name);
        if (!object || object->mark == mark || (fork->nested && object->leaves) ||
            (!object->current && like->waiter.mode != DUITE_W)) {
            plain_unmark(fork->task, access);
            return false;
        }
        base_prefetch(object->current);
        object->mark = mark;
        *access = *like;
        access->object = object;
    }
    return true;
}

static inline void plain_copy_args(void *to, const void *from, size_t size)
{
    if (!size)
        return;
    if (size == sizeof(uint64_t)) /* as often: without a call */
        memcpy(to, from, sizeof(uint64_t));
    else
        memcpy(to, from, size);
}

/* Makes all of the task but its accesses; it counts as unfinished. */
PLAIN_INLINE void plain_make(const struct plain_fork *fork, const void *args)
{
    const struct task_fixed *fixed = fork->fixed;
    struct task_scope *scope = fork->scope;
    struct task *task = fork->task;
    *task = *fixed->head;
    task->scope = scope;
    task->number = ++scope->forks;
    task->block = fixed->owner[0] == TASK_NOBODY ? (uint32_t)scope->forks
                                                 : task->access[fixed->owner[0]].object->block;
    plain_copy_args(task_rest(task, fixed->n), args, fixed->kernel->args_size);
    if (fork->nested)
        atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    else
        fork->graph->tasks++;
}

/* The access writes: it becomes the heir of the version that it overwrites. False without memory.
 * *done grows by one if there is nothing to wait for. */
PLAIN_INLINE bool plain_overwrite(const struct plain_fork *fork, struct task_access *access,
                                  struct data_object *object, uint32_t *done)
{
    struct data_version *version = object->current;
    object->number++; /* of an object that is nowhere else: its holder stays this rank */
    struct data_version *out = fork->nested ? task_child_version(fork->scope, object, !version)
                                            : data_object_version(object);
    if (!out)
        return false;
    object->current = out;
    *done += data_version_overwrite(version, out, &access->waiter);
    return true;
}

/* The accesses become holds on versions, and places of heirs. Returns how many have nothing to wait
 * for; *stop: their end, or the one for which there was no memory. */
PLAIN_INLINE uint32_t plain_depend(const struct plain_fork *fork, const struct task_access **stop)
{
    struct task_access *access = fork->task->access, *const end = access + fork->fixed->n;
    uint32_t done = 0;
    for (; access < end; access++) {
        struct data_object *object = access->object;
        if (access->waiter.mode == DUITE_R) {
            done += data_version_read(object->current, &access->waiter);
        } else if (!plain_overwrite(fork, access, object, &done)) {
            break;
        }
    }
    *stop = access;
    return done;
}

/* The objects are found. */
PLAIN_INLINE int plain_fork(const struct plain_fork *fork, const struct task_options *options,
                            const void *args)
{
    struct task_graph *graph = fork->graph;
    struct task *task = fork->task;
    const struct task_access *stop;
    plain_make(fork, args);
    if (options) {
        task->priority = options->priority;
        task->cost = (float)options->cost;
    }
    const uint32_t done = plain_depend(fork, &stop);
    if (stop == task->access + fork->fixed->n) {
        ready_take(graph, fork->worker, task, done + 1);
        return DUITE_OK;
    }
    base_no_memory("a version");
    task_break(graph);
    task_void(graph, fork->worker, task, (size_t)(stop - task->access), done);
    return DUITE_E_MEMORY;
}

/* True if the fork is of this kind: then its task has memory, and its objects are found. */
PLAIN_INLINE bool plain_fits(struct plain_fork *fork, const duite_kernel *kernel, const void *args,
                             size_t n, const duite_object *objects)
{
    const struct task_graph *graph = fork->graph;
    const struct task_fixed *fixed = fork->fixed = task_kernel_find(graph, kernel);
    if (!fixed || !(fork->nested ? fixed->plain : fixed->direct) || n != fixed->n ||
        !task_args_fit(args, kernel->args_size) || (!objects && n))
        return false;
    const size_t bytes = (size_t)fixed->grains * TASK_GRAIN;
    fork->task = base_pool_take(bytes);
    if (!fork->task || plain_take_objects(fork, objects))
        return fork->task != NULL;
    base_pool_give(fork->task, bytes);
    return false;
}

/* The compiler knows `nested` and whether there are options. */
PLAIN_INLINE int plain_try(struct task_scope *scope, struct worker *worker,
                           const struct task_options *options, const duite_kernel *kernel,
                           const void *args, size_t n, const duite_object *objects, bool nested)
{
    static const struct task_options none = {.at = TASK_ANYWHERE};
    struct plain_fork fork = {
        .graph = scope->graph, .scope = scope, .worker = worker, .nested = nested};
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
