/* Forking, the first stage of a task. Every rank comes through here for every task of the main
 * program, in the same order. Each draws the same conclusions about where the task runs and which
 * versions move. A rank keeps only what it runs, sends or receives itself. A task forks by the same
 * rules in its own scope, whose objects are here and nowhere else. Errors are refused before
 * anything is changed; afterwards only memory can be missing. The next stage is depend.c; prune.h
 * is the short way for tasks of which nothing is here. */
#include "runtime/task/scope.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/data/law.h"
#include "runtime/data/object.h"

#include <string.h>

/* ---- The checks of a fork ---- */

static int fork_kernel(const struct task_graph *graph, const duite_kernel *kernel, uint32_t *index)
{
    if (!kernel)
        return base_error(DUITE_E_ARGUMENT, "duite_fork: no kernel");
    const struct task_fixed *fixed = task_kernel_find(graph, kernel);
    *index = fixed ? fixed->index : graph->n_kernels;
    if (fixed)
        return DUITE_OK;
    return base_error(DUITE_E_KERNEL, "kernel %s was not listed at start",
                      kernel->name ? kernel->name : "without a name");
}

static int fork_wrong_args(const duite_kernel *kernel)
{
    if (kernel->args_size)
        return base_error(DUITE_E_ARGUMENT, "kernel %s needs %zu bytes of arguments", kernel->name,
                          kernel->args_size);
    return base_error(DUITE_E_ARGUMENT,
                      "kernel %s has no arguments, and the fork gives some; if the body is to find "
                      "them, the kernel says their size (args_size)",
                      kernel->name);
}

/* Kernel, arguments and number of objects fit. */
static int fork_check_call(const struct task_graph *graph, int at, uint32_t index, const void *args,
                           size_t n, const duite_object *objects)
{
    const duite_kernel *kernel = graph->kernels[index];
    size_t fixed = graph->fixed[index].n;
    if (n < fixed || (n > fixed && kernel->variadic == DUITE_NONE) || n > TASK_MAX_OBJECTS)
        return base_error(DUITE_E_ACCESS, "kernel %s takes %s%zu objects, not %zu", kernel->name,
                          kernel->variadic == DUITE_NONE ? "" : "at least ", fixed, n);
    if (n && !objects)
        return base_error(DUITE_E_ARGUMENT, "kernel %s: no objects given", kernel->name);
    if (!task_args_fit(args, kernel->args_size))
        return fork_wrong_args(kernel);
    if (at < TASK_ANYWHERE || at >= graph->n_ranks)
        return base_error(DUITE_E_ARGUMENT, "kernel %s: there is no rank %d, only 0 to %d",
                          kernel->name, at, graph->n_ranks - 1);
    if (kernel->replicated && at != TASK_ANYWHERE)
        return base_error(DUITE_E_ARGUMENT,
                          "kernel %s is replicated: it runs on all ranks, and none can be named",
                          kernel->name);
    return DUITE_OK;
}

static int fork_check_law(const duite_kernel *kernel, size_t i, const struct data_object *object,
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

/* The object exists, is named once, may be used so and, under cw, can be accumulated into. */
static int fork_check_object(struct task_fork_call *call, size_t i)
{
    struct task_scope *scope = call->scope;
    const duite_kernel *kernel = call->kernel;
    const duite_mode mode = task_immediate(data_mode_of(kernel, i));
    const duite_object name = call->objects[i];
    duite_mode right = DUITE_RWP;
    struct data_object *object = scope->depth ? task_find_object(scope, name, &right)
                                              : data_object_find(&scope->graph->table, name);
    if (!object)
        return base_error(DUITE_E_OBJECT, "kernel %s, parameter %zu: object %u.%u %s", kernel->name,
                          i, name.slot, name.generation,
                          name.slot ? "was freed or never made" : "names nothing");
    if (object->mark == scope->forks + 1)
        return base_error(DUITE_E_ACCESS,
                          "kernel %s, parameter %zu: the task names object %u.%u twice",
                          kernel->name, i, name.slot, name.generation);
    int code = DUITE_OK;
    if (mode == DUITE_CW)
        code = fork_check_law(kernel, i, object, name);
    if (!code && right == DUITE_CWP && data_law_of(kernel, i) != object->law)
        code = task_wrong_law(scope, kernel, i, name);
    if (code)
        return code;
    object->mark = scope->forks + 1;
    if (i < TASK_FEW)
        call->object[i] = object;
    return DUITE_OK;
}

/* Checks a body's rights. The objects that it reads may come into its scope, whose objects then
 * move. */
static int fork_check_rights(const struct task_fork_call *call)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < call->n && !code; i++)
        code = task_check_right(call->scope, call->kernel->name, i, call->objects[i],
                                data_mode_of(call->kernel, i));
    return code;
}

/* True if no object needs a second look: each may be used so as it is, as in most forks. Else
 * nothing was done, and fork_check_object says what is wrong. */
static bool fork_take_objects(struct task_fork_call *call)
{
    struct task_scope *const scope = call->scope;
    struct data_table *const table = scope->depth ? NULL : &scope->graph->table;
    const duite_mode *const mode = call->kernel->access;
    const duite_object *const name = call->objects;
    const uint64_t mark = scope->forks + 1;
    const size_t n = call->plain ? call->n : 0;
    for (size_t i = 0; i < n; i++) {
        struct data_object *object =
            table ? data_object_here(table, name[i]) : task_find_given(scope, name[i], mode[i]);
        if (object && object->mark != mark) {
            object->mark = mark;
            call->object[i] = object;
            continue;
        }
        while (i > 0)
            call->object[--i]->mark = 0;
        return false;
    }
    return call->plain;
}

/* Unmarks the first n objects: this fork does not name them after all. */
static void fork_unmark(const struct task_fork_call *call, size_t n)
{
    for (size_t i = 0; i < n; i++)
        task_fork_object(call, i)->mark = 0;
}

static int fork_check_objects(struct task_fork_call *call)
{
    for (size_t i = 0; i < call->n; i++) {
        int code = fork_check_object(call, i);
        if (code) {
            fork_unmark(call, i);
            return code;
        }
    }
    return DUITE_OK;
}

/* `at`: the rank that the fork names, or TASK_ANYWHERE. */
static int fork_check(struct task_fork_call *call, int at, const void *args)
{
    const struct task_graph *graph = call->scope->graph;
    int code = fork_kernel(graph, call->kernel, &call->index);
    if (!code)
        code = fork_check_call(graph, at, call->index, args, call->n, call->objects);
    if (code)
        return code;
    const struct task_fixed *fixed = &graph->fixed[call->index];
    call->owner = fixed->owner[call->n > fixed->n];
    call->plain = fixed->plain;
    if (fork_take_objects(call))
        return DUITE_OK;
    if (call->scope->depth)
        code = fork_check_rights(call);
    return code ? code : fork_check_objects(call);
}

/* `object` stays unset to save time: each is looked up before it is used. */
static void fork_call_init(struct task_fork_call *call, struct task_scope *scope,
                           struct worker *worker, const duite_kernel *kernel, size_t n,
                           const duite_object *objects)
{
    call->scope = scope;
    call->worker = worker;
    call->kernel = kernel;
    call->n = n;
    call->objects = objects;
    call->task = NULL;
    call->done = 0;
}

int task_check_fork(struct task_fork_call *call, struct task_scope *scope, int at,
                    const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects)
{
    fork_call_init(call, scope, NULL, kernel, n, objects);
    int code = fork_check(call, at, args);
    if (!code)
        fork_unmark(call, n);
    return code;
}

/* ---- The task of a fork ---- */

struct task *task_make(struct task_scope *scope, enum task_type type, size_t n, size_t extra)
{
    struct task *task;
    const size_t grains = task_grains(n, extra);
    task = grains <= UINT32_MAX ? base_pool_take(grains * TASK_GRAIN) : NULL;
    if (!task)
        return NULL;
    *task = (struct task){
        .pending = (uint32_t)n + 1,
        .n = (uint32_t)n,
        .scope = scope,
        .number = scope->forks,
        .kernel = UINT32_MAX,
        .block = (uint32_t)scope->forks, /* until it is known to run for an object */
        .priority = INT32_MAX,           /* unless the program forks it */
        .grains = (uint32_t)grains,
        .type = type,
    };
    if (type != TASK_BODY && extra)
        task->sum = task_rest(task, n);
    for (size_t i = 0; i < n; i++)
        task->access[i] = (struct task_access){
            .waiter.back = (uint32_t)(sizeof *task + i * sizeof task->access[0])};
    return task;
}

struct task *task_new(struct task_scope *scope, enum task_type type, size_t n, size_t extra)
{
    struct task *task = task_make(scope, type, n, extra);
    if (!task) {
        base_no_memory("a task");
        task_break(scope->graph);
        return NULL;
    }
    if (scope->parent)
        atomic_fetch_add_explicit(&scope->unfinished, 1, memory_order_relaxed);
    else
        scope->graph->tasks++;
    return task;
}

/* Memory ran out at access `made`: the accesses before it are kept, or others would wait for ever.
 */
void task_void(struct task_graph *graph, struct worker *worker, struct task *task, size_t made,
               uint32_t done)
{
    uint32_t missing = task->n - (uint32_t)made;
    if (task->type != TASK_BODY)
        task->inner = NULL;
    task->state = TASK_VOID;
    task->n = (uint32_t)made;
    task_settled(graph, worker, task, done + missing);
}

uint64_t task_later_round(const struct task *task)
{
    uint64_t round;
    const size_t args_size = task->scope->graph->kernels[task->kernel]->args_size;
    const char *rest = (const char *)task + sizeof *task + task->n * sizeof task->access[0];
    memcpy(&round, rest + task_round_at(args_size), sizeof round);
    return round;
}

/* NULL without memory. */
static struct task *fork_body(const struct task_fork_call *call, const struct task_options *options,
                              const void *args)
{
    struct task_scope *scope = call->scope;
    const duite_kernel *kernel = call->kernel;
    const size_t round_at = task_round_at(kernel->args_size);
    struct task *task =
        task_new(scope, TASK_BODY, call->n,
                 options->round ? round_at + sizeof options->round : kernel->args_size);
    if (!task)
        return NULL;
    task->later = options->round != 0;
    if (task->later)
        memcpy((char *)task_rest(task, call->n) + round_at, &options->round, sizeof options->round);
    task->kernel = call->index;
    task->priority = options->priority;
    task->cost = (float)options->cost;
    task->at_rank = options->at != TASK_ANYWHERE;
    if (kernel->args_size)
        memcpy(task_rest(task, call->n), args, kernel->args_size);
    const struct task_fixed *fixed = &scope->graph->fixed[call->index];
    size_t postponed = fixed->postponed;
    if (task_postponed(kernel->variadic))
        postponed += call->n - fixed->n;
    if (!postponed || (task->inner = task_scope_new(task, postponed)))
        return task;
    base_no_memory("a task");
    task_break(scope->graph);
    task_void(scope->graph, call->worker, task, 0, 0);
    return NULL;
}

/* Makes the task run for the object; `follows`: at the object's home. */
static void fork_give_block(struct task *task, struct data_object *own, bool follows)
{
    task->block = own->block;
    task->placed = follows;
    own->fixed |= follows && task->scope->graph->kernels[task->kernel]->fixed;
    if (task->inner) {
        task->inner->block = task->block;
        task->inner->placed = task->placed;
    }
}

/* Forks after the checks: only memory can be missing. */
static int fork_checked(struct task_fork_call *call, const struct task_options *options,
                        const void *args)
{
    const struct task_graph *graph = call->scope->graph;
    const bool replicated = call->kernel->replicated;
    struct data_object *own =
        call->owner == TASK_NOBODY ? NULL : task_fork_object(call, call->owner);
    call->at = call->scope->depth ? graph->rank
                                  : task_owner_rank(options->at, replicated, own ? own->home : -1);
    if (call->at == TASK_EVERYWHERE)
        call->at = graph->rank;
    if (call->at == graph->rank && !(call->task = fork_body(call, options, args)))
        return DUITE_E_MEMORY;
    if (call->task && own)
        fork_give_block(call->task, own, task_owner_decides(options->at, replicated));
    return task_depend(call);
}

int task_fork_any(struct task_scope *scope, struct worker *worker,
                  const struct task_options *options, const duite_kernel *kernel, const void *args,
                  size_t n, const duite_object *objects)
{
    struct task_fork_call call;
    fork_call_init(&call, scope, worker, kernel, n, objects);
    int code = fork_check(&call, options->at, args);
    if (code)
        return code;
    scope->forks++;
    if (!scope->depth && scope->graph->n_ranks > 1)
        task_mix_fork(scope->graph, task_fork_hash_all(call.index, options->at, n, objects),
                      COMM_FORKED, call.index);
    return fork_checked(&call, options, args);
}
