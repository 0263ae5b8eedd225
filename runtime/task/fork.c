/* Forking, the first stage of a task. Every rank comes through here for every task of the main
 * program, in the same order, and draws the same conclusions about where it runs and which versions
 * move; it keeps only what it runs, sends or receives itself. A task forks by the same rules in its
 * own scope, whose objects are here and nowhere else. What is wrong is refused before anything is
 * changed; afterwards nothing but memory can be missing. The next stage is depend.c; prune.c is the
 * short way for tasks that touch nothing of this rank. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/pool.h"
#include "runtime/data/mode.h"
#include "runtime/data/view.h"

#include <string.h>

/* ---- What a fork checks ---- */

static int fork_kernel(const struct task_graph *graph, const duite_kernel *kernel, uint32_t *index)
{
    if (!kernel)
        return base_error(DUITE_E_ARGUMENT, "duite_fork: no kernel");
    *index = task_kernel_index(graph, kernel);
    if (*index < graph->n_kernels)
        return DUITE_OK;
    return base_error(DUITE_E_KERNEL, "kernel %s was not listed at start",
                      kernel->name ? kernel->name : "without a name");
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
    if (kernel->args_size && !args)
        return base_error(DUITE_E_ARGUMENT, "kernel %s needs %zu bytes of arguments", kernel->name,
                          kernel->args_size);
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

/* What is known of a task before anything is changed for it. */
struct fork_sketch {
    uint32_t kernel;                      /* index in the list given at start */
    uint32_t owner;                       /* the parameter it runs for, or TASK_NOBODY */
    bool views;                           /* some are views */
    struct data_object *object[TASK_FEW]; /* the first ones */
};

/* It exists, is named once, may be used so, and can be accumulated into where it is. */
static int fork_check_object(struct task_scope *scope, const duite_kernel *kernel, size_t i,
                             duite_mode mode, duite_object name, struct fork_sketch *sketch)
{
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
    if (object->view && task_immediate(mode) != DUITE_R)
        code = data_view_refuse(&scope->graph->table, object, kernel->name);
    if (!code && task_immediate(mode) == DUITE_CW)
        code = fork_check_law(kernel, i, object, name);
    if (!code && right == DUITE_CWP && data_law_of(kernel, i) != object->law)
        code = task_wrong_law(scope, kernel, i, name);
    if (code)
        return code;
    object->mark = scope->forks + 1;
    sketch->views |= object->view != NULL;
    if (i < TASK_FEW)
        sketch->object[i] = object;
    return DUITE_OK;
}

void task_unmark(struct task_scope *scope, size_t n, const duite_object *objects)
{
    duite_mode right;
    for (size_t i = 0; i < n; i++) {
        struct data_object *object = task_find_object(scope, objects[i], &right);
        if (object)
            object->mark = 0;
    }
}

/* A body's rights. What it reads may come into its scope, whose objects move then. */
static int fork_check_rights(struct task_scope *scope, const duite_kernel *kernel, size_t n,
                             const duite_object *objects)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < n && !code; i++)
        code = task_check_right(scope, kernel->name, i, objects[i], data_mode_of(kernel, i));
    return code;
}

static int fork_check_objects(struct task_scope *scope, const duite_kernel *kernel, size_t n,
                              const duite_object *objects, struct fork_sketch *sketch)
{
    const struct task_fixed *fixed = &scope->graph->fixed[sketch->kernel];
    sketch->owner = fixed->owner[n > fixed->n];
    sketch->views = false;
    for (uint32_t i = 0; i < n; i++) {
        int code = fork_check_object(scope, kernel, i, data_mode_of(kernel, i), objects[i], sketch);
        if (code) {
            task_unmark(scope, i, objects);
            return code;
        }
    }
    return DUITE_OK;
}

static int fork_check(struct task_scope *scope, int at, const duite_kernel *kernel,
                      const void *args, size_t n, const duite_object *objects,
                      struct fork_sketch *sketch)
{
    int code = fork_kernel(scope->graph, kernel, &sketch->kernel);
    if (!code)
        code = fork_check_call(scope->graph, at, sketch->kernel, args, n, objects);
    if (!code && scope->depth)
        code = fork_check_rights(scope, kernel, n, objects);
    return code ? code : fork_check_objects(scope, kernel, n, objects, sketch);
}

int task_check_fork(struct task_scope *scope, int at, const duite_kernel *kernel, const void *args,
                    size_t n, const duite_object *objects, uint32_t *index)
{
    struct fork_sketch sketch;
    int code = fork_check(scope, at, kernel, args, n, objects, &sketch);
    *index = sketch.kernel;
    return code;
}

/* ---- What it makes ---- */

struct task *task_make(struct task_scope *scope, enum task_type type, size_t n, size_t extra)
{
    struct task *task;
    size_t bytes = sizeof *task + n * sizeof task->access[0] + extra;
    size_t grains = (bytes + TASK_GRAIN - 1) / TASK_GRAIN;
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

/* NULL without memory. */
static struct task *fork_body(struct task_scope *scope, struct worker *worker,
                              const struct task_options *how, uint32_t index, const void *args,
                              size_t n)
{
    const duite_kernel *kernel = scope->graph->kernels[index];
    struct task *task = task_new(scope, TASK_BODY, n, kernel->args_size);
    if (!task)
        return NULL;
    task->kernel = index;
    task->priority = how->priority;
    task->cost = (float)how->cost;
    task->pinned = how->at != TASK_ANYWHERE;
    if (kernel->args_size)
        memcpy(task_rest(task, n), args, kernel->args_size);
    size_t fixed = scope->graph->fixed[index].n, postponed = scope->graph->fixed[index].postponed;
    if (task_postponed(kernel->variadic))
        postponed += n - fixed;
    if (!postponed || (task->inner = task_scope_new(task, postponed)))
        return task;
    base_no_memory("a task");
    task_break(scope->graph);
    task_void(scope->graph, worker, task, 0, 0);
    return NULL;
}

/* All of them before any other access: the task may write their parents. */
static int fork_gather_views(struct task_scope *scope, struct worker *worker,
                             const struct fork_sketch *sketch, size_t n,
                             const duite_object *objects)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < n && !code; i++)
        code = task_view_gather(scope->graph, worker,
                                task_named_object(scope, sketch->object, i, objects[i]));
    return code;
}

/* The task runs for the object; `follows`: where that one's home is. */
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

/* Checked: nothing but memory can be missing. */
static int fork_checked(struct task_scope *scope, struct worker *worker,
                        const struct task_options *how, const struct fork_sketch *sketch,
                        const void *args, size_t n, const duite_object *objects)
{
    struct task_graph *graph = scope->graph;
    const duite_kernel *kernel = graph->kernels[sketch->kernel];
    struct data_object *own =
        sketch->owner == TASK_NOBODY
            ? NULL
            : task_named_object(scope, sketch->object, sketch->owner, objects[sketch->owner]);
    int code = sketch->views ? fork_gather_views(scope, worker, sketch, n, objects) : DUITE_OK;
    if (code)
        return code;
    struct task *task = NULL;
    int at = scope->depth ? graph->rank
                          : task_owner_rank(how->at, kernel->replicated, own ? own->home : -1);
    if (at == TASK_EVERYWHERE)
        at = graph->rank;
    if (at == graph->rank && !(task = fork_body(scope, worker, how, sketch->kernel, args, n)))
        return DUITE_E_MEMORY;
    if (task && own)
        fork_give_block(task, own, task_owner_decides(how->at, kernel->replicated));
    return task_depend(scope, worker, at, kernel, n, objects, sketch->object, task);
}

static void fork_mix(struct task_graph *graph, uint32_t kernel, int at, size_t n,
                     const duite_object *objects)
{
    uint64_t hash = task_fork_hash(kernel, at);
    for (size_t i = 0; i < n; i++)
        hash = task_fork_hash_on(hash, objects[i]);
    task_mix(graph, hash);
}

int task_fork(struct task_scope *scope, struct worker *worker, const struct task_options *how,
              const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects)
{
    struct fork_sketch sketch;
    int code = fork_check(scope, how->at, kernel, args, n, objects, &sketch);
    if (code)
        return code;
    scope->forks++;
    if (!scope->depth)
        fork_mix(scope->graph, sketch.kernel, how->at, n, objects);
    return fork_checked(scope, worker, how, &sketch, args, n, objects);
}
