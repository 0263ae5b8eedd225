#ifndef DUITE_TASK_ACCESS_H
#define DUITE_TASK_ACCESS_H

#include "runtime/task/scope.h"

#include "runtime/data/law.h"

/* One access of a fork: its object is found, then the access waits for its version. The short ways
 * of most forks and the general one take these steps; each passes constants, by which the compiler
 * leaves out the questions that it need not ask. */
#define ACCESS_INLINE __attribute__((always_inline)) static inline

/* The kernels that a way is for: plain ones, with objects that have no contributions; few accesses,
 * cw among them; any (see task_fixed). */
enum access_kernels { ACCESS_PLAIN, ACCESS_FEW, ACCESS_ANY };

/* The immediate mode of parameter i. */
ACCESS_INLINE duite_mode access_mode(const struct task_fixed *fixed, size_t i,
                                     enum access_kernels kernels)
{
    return kernels == ACCESS_ANY ? task_immediate(task_mode_of(fixed, i))
                                 : (duite_mode)fixed->kernel->access[i];
}

/* How a fork looks for its objects. */
struct access_look {
    struct task_scope *scope;
    struct data_object *first; /* of the table */
    uint32_t n_slots;          /* of the table */
    uint64_t mark;             /* of this fork: no object has it yet */
    bool nested;               /* a body's fork */
    bool closed;               /* objects with open contributions need a second look */
};

ACCESS_INLINE struct access_look access_look_of(struct task_scope *scope, bool nested, bool closed)
{
    struct access_look look = {
        .scope = scope, .mark = scope->forks + 1, .nested = nested, .closed = closed};
    if (!nested) { /* a body has no look at the table, which the main program may move meanwhile */
        look.first = scope->graph->table.object;
        look.n_slots = scope->graph->table.n_slots;
    }
    return look;
}

/* This fork names none of the first n objects after all. */
ACCESS_INLINE void access_unmark(struct data_object *const *object, size_t n)
{
    while (n > 0)
        object[--n]->mark = 0;
}

/* The object, marked as named by this fork; NULL if it needs a second look, or was named before. */
ACCESS_INLINE struct data_object *access_find(const struct access_look *look, duite_object name,
                                              duite_mode mode)
{
    struct data_object *object;
    if (look->nested)
        object = task_find_given(look->scope, name, mode);
    else
        object = data_object_used(look->first, look->n_slots, name, look->closed);
    if (!object || object->mark == look->mark || (look->nested && look->closed && object->leaves))
        return NULL;
    object->mark = look->mark;
    return object;
}

/* The same for objects that may have open contributions, which a contribution joins. */
ACCESS_INLINE struct data_object *access_find_any(const struct access_look *look,
                                                  const struct task_fixed *fixed, size_t i,
                                                  duite_object name, enum access_kernels kernels)
{
    struct data_object *object = access_find(look, name, task_mode_of(fixed, i));
    if (!object || access_mode(fixed, i, kernels) != DUITE_CW ||
        (object->leaves && object->law == data_law_of(fixed->kernel, i)))
        return object;
    object->mark = 0;
    return NULL;
}

/* Every rank notes the access of a task on rank `at`, or of a replicated one. Open contributions
 * that it does not join are combined; rank `at` gets the value that it reads, and has the one that
 * it writes. Errors: memory; the graph is broken. */
ACCESS_INLINE int access_note(const struct task_fork_call *call, size_t i,
                              struct data_object *object, duite_mode mode,
                              enum access_kernels kernels)
{
    const duite_kernel *kernel = call->kernel;
    struct task_scope *scope = call->scope;
    int code = DUITE_OK;
    if (kernels != ACCESS_PLAIN && object->leaves &&
        !data_order_joins(mode, data_law_of(kernel, i), object->law))
        code = task_reduce(scope, call->worker, object);
    if (kernels != ACCESS_PLAIN && (code || mode == DUITE_CW))
        return code;
    if (kernels == ACCESS_ANY && kernel->replicated && !scope->depth)
        return task_note_everywhere(scope->graph, call->worker, object, mode);
    if (data_order_reads(mode) && object->holder != call->at)
        code = task_fetch(scope->graph, call->worker, object, call->at);
    if (!code && data_order_writes(mode))
        task_note_version(object, call->at);
    return code;
}

/* The same, and all that an access of a task that another rank runs is here. */
ACCESS_INLINE int access_elsewhere(const struct task_fork_call *call, size_t i,
                                   struct data_object *object, enum access_kernels kernels)
{
    const duite_mode mode = access_mode(call->fixed, i, kernels);
    const int code = access_note(call, i, object, mode, kernels);
    if (code)
        return code;
    if (kernels != ACCESS_PLAIN && mode == DUITE_CW)
        return task_contribute(call->scope->graph, NULL, i, object, data_law_of(call->kernel, i),
                               call->at);
    if (data_order_writes(mode) && object->current)
        task_forget(call->scope->graph, call->worker, object);
    return DUITE_OK;
}

/* The access waits for the object's version, and leaves its own if it writes. Adds one to
 * *done if there is nothing to wait for. False without memory. */
ACCESS_INLINE bool access_wait(struct task_scope *scope, struct task_access *access,
                               struct data_object *object, bool writes, bool nested, uint32_t *done)
{
    struct data_version *version = object->current;
    if (!writes) {
        *done += data_version_read(version, &access->waiter);
        return true;
    }
    struct data_version *out =
        nested ? task_child_version(scope, object, !version) : data_object_version(object);
    if (!out)
        return false;
    object->current = out;
    *done += data_version_overwrite(version, out, &access->waiter);
    return true;
}

#endif
