/* Forking: every rank comes through here for every task of the main program, in the same order, and
 * draws the same conclusions about where it runs and which versions move; it keeps only what it
 * runs, sends or receives itself. A task forks by the same rules in its own scope, whose objects
 * are here and nowhere else. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/data/mode.h"
#include "runtime/data/view.h"

#include <string.h>

static int find_kernel(const struct task_graph *graph, const duite_kernel *kernel, uint32_t *index)
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
static int check_call(const struct task_graph *graph, int at, uint32_t index, const void *args,
                      size_t n, const duite_object *objects)
{
    const duite_kernel *kernel = graph->kernels[index];
    size_t fixed = graph->fixed[index].n;
    if (n < fixed || (n > fixed && kernel->rest == DUITE_NONE) || n > TASK_MAX_OBJECTS)
        return base_error(DUITE_E_ACCESS, "kernel %s takes %s%zu objects, not %zu", kernel->name,
                          kernel->rest == DUITE_NONE ? "" : "at least ", fixed, n);
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

/* What is known of a task before anything is changed for it. */
enum { FEW = 16 };
struct sketch {
    uint32_t kernel;                 /* index in the list given at start */
    uint32_t owner;                  /* the parameter it runs for, or TASK_NOBODY */
    bool views;                      /* some are views */
    struct data_object *object[FEW]; /* the first ones */
};

/* Object i, whose name was checked. */
static struct data_object *object_of(struct task_scope *scope, const struct sketch *sketch,
                                     size_t i, duite_object name)
{
    duite_mode right;
    return i < FEW ? sketch->object[i] : task_find_object(scope, name, &right);
}

/* It exists, is named once, may be used so, and can be accumulated into where it is. */
static int check_object(struct task_scope *scope, const duite_kernel *kernel, size_t i,
                        duite_mode mode, duite_object name, struct sketch *sketch)
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
        code = check_law(kernel, i, object, name);
    if (!code && right == DUITE_CWP && data_law_of(kernel, i) != object->law)
        code = task_wrong_law(scope, kernel, i, name);
    if (code)
        return code;
    object->mark = scope->forks + 1;
    sketch->views |= object->view != NULL;
    if (i < FEW)
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

static void read_version(struct task *task, size_t i, const struct data_object *object,
                         struct data_version *version, bool postponed, uint32_t *done)
{
    if (!postponed) {
        task_read(task, i, version, done);
        return;
    }
    data_version_hold(version);
    task_lend(task, i, object, version, NULL);
    *done += 1;
}

/* The scope of the task gets the object's hold on the version; the object has from now on the one
 * that its children will leave. */
static int lend_version(struct task *task, size_t i, struct data_object *object,
                        struct data_version *version, uint32_t *done)
{
    struct data_version *out = data_object_version(object);
    if (!out) {
        base_no_memory("a version");
        return task_break(task->scope->graph);
    }
    task_lend(task, i, object, version, out);
    object->current = out;
    *done += 1;
    return DUITE_OK;
}

static int contribute(struct task_scope *scope, struct worker *worker, int at,
                      const duite_kernel *kernel, size_t i, struct data_object *object,
                      struct task *task, uint32_t *done)
{
    int code = task_contribute(scope, worker, object, data_law_of(kernel, i), at, task, i);
    if (!code && task && task_postponed((duite_mode)task->access[i].waiter.mode))
        task_lend(task, i, object, NULL, NULL);
    *done += !code;
    return code;
}

/* Access i of a task that runs on rank `at`; `task` is NULL on the other ranks. */
static int use(struct task_scope *scope, struct worker *worker, int at, const duite_kernel *kernel,
               size_t i, duite_mode declared, struct data_object *object, struct task *task,
               uint32_t *done)
{
    struct task_graph *graph = scope->graph;
    duite_mode mode = task_immediate(declared);
    bool postponed = task_postponed(declared);
    bool everywhere = kernel->replicated && !scope->depth;
    int code = DUITE_OK;
    if (mode == DUITE_CW)
        return contribute(scope, worker, at, kernel, i, object, task, done);
    if (object->leaves)
        code = task_close_sum(scope, worker, object);
    if (!code && mode != DUITE_W && graph->n_ranks > 1)
        code = everywhere ? task_fetch_all(graph, worker, object)
                          : task_fetch(graph, worker, object, at);
    if (code)
        return code;
    struct data_version *version = object->current;
    if (task && mode != DUITE_W && !(version = task_local(graph, object)))
        return DUITE_E_MEMORY;
    if (mode == DUITE_R) {
        if (task)
            read_version(task, i, object, version, postponed, done);
        return DUITE_OK;
    }
    object->number++;
    data_object_moved(object, everywhere ? object->home : at);
    for (int rank = 0; everywhere && rank < graph->n_ranks; rank++)
        data_object_add_copy(&graph->table, object, rank);
    if (mode == DUITE_W && task)
        version = task_rename(graph, worker, object);
    if (task)
        return postponed ? lend_version(task, i, object, version, done)
                         : task_overwrite(graph, task, i, object, version, done);
    task_forget(graph, worker, object);
    return DUITE_OK;
}

/* Memory ran out at access `made`: the accesses before it are kept, or others would wait for ever.
 */
void task_void(struct task_graph *graph, struct worker *worker, struct task *task, size_t made,
               uint32_t done)
{
    uint32_t missing = task->n - (uint32_t)made;
    if (task->kind != TASK_BODY)
        task->inner = NULL;
    task->kind = TASK_VOID;
    task->n = (uint32_t)made;
    task_settled(graph, worker, task, done + missing);
}

/* A body's rights. What it reads may come into its scope, whose objects move then. */
static int check_rights(struct task_scope *scope, const duite_kernel *kernel, size_t n,
                        const duite_object *objects)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < n && !code; i++)
        code = task_check_right(scope, kernel->name, i, objects[i], data_mode_of(kernel, i));
    return code;
}

static int check_objects(struct task_scope *scope, const duite_kernel *kernel, size_t n,
                         const duite_object *objects, struct sketch *sketch)
{
    const struct task_fixed *fixed = &scope->graph->fixed[sketch->kernel];
    sketch->owner = fixed->owner[n > fixed->n];
    sketch->views = false;
    for (uint32_t i = 0; i < n; i++) {
        int code = check_object(scope, kernel, i, data_mode_of(kernel, i), objects[i], sketch);
        if (code) {
            task_unmark(scope, i, objects);
            return code;
        }
    }
    return DUITE_OK;
}

static int check(struct task_scope *scope, int at, const duite_kernel *kernel, const void *args,
                 size_t n, const duite_object *objects, struct sketch *sketch)
{
    int code = find_kernel(scope->graph, kernel, &sketch->kernel);
    if (!code)
        code = check_call(scope->graph, at, sketch->kernel, args, n, objects);
    if (!code && scope->depth)
        code = check_rights(scope, kernel, n, objects);
    return code ? code : check_objects(scope, kernel, n, objects, sketch);
}

int task_check_fork(struct task_scope *scope, int at, const duite_kernel *kernel, const void *args,
                    size_t n, const duite_object *objects, uint32_t *index)
{
    struct sketch sketch;
    int code = check(scope, at, kernel, args, n, objects, &sketch);
    *index = sketch.kernel;
    return code;
}

/* NULL without memory. */
static struct task *body_task(struct task_scope *scope, struct worker *worker,
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
    if (task_postponed(kernel->rest))
        postponed += n - fixed;
    if (!postponed || (task->inner = task_scope_new(task, postponed)))
        return task;
    base_no_memory("a task");
    task_break(scope->graph);
    task_void(scope->graph, worker, task, 0, 0);
    return NULL;
}

/* All of them before any other access: the task may write their parents. */
static int gather_views(struct task_scope *scope, struct worker *worker,
                        const struct sketch *sketch, size_t n, const duite_object *objects)
{
    int code = DUITE_OK;
    for (size_t i = 0; i < n && !code; i++)
        code = task_view_gather(scope->graph, worker, object_of(scope, sketch, i, objects[i]));
    return code;
}

/* The task runs for the object; `follows`: where that one's home is. */
static void give_block(struct task *task, struct data_object *own, bool follows)
{
    task->block = own->block;
    task->placed = follows;
    own->stays |= follows && task->scope->graph->kernels[task->kernel]->stays;
    if (task->inner) {
        task->inner->block = task->block;
        task->inner->placed = task->placed;
    }
}

/* Checked: nothing but memory can be missing. */
static int fork_checked(struct task_scope *scope, struct worker *worker,
                        const struct task_options *how, const struct sketch *sketch,
                        const void *args, size_t n, const duite_object *objects)
{
    struct task_graph *graph = scope->graph;
    const duite_kernel *kernel = graph->kernels[sketch->kernel];
    struct data_object *own = sketch->owner == TASK_NOBODY
                                  ? NULL
                                  : object_of(scope, sketch, sketch->owner, objects[sketch->owner]);
    int code = sketch->views ? gather_views(scope, worker, sketch, n, objects) : DUITE_OK;
    if (code)
        return code;
    struct task *task = NULL;
    uint32_t done = 0;
    int at = scope->depth ? graph->rank
                          : task_owner_rank(how->at, kernel->replicated, own ? own->home : -1);
    if (at == TASK_EVERYWHERE)
        at = graph->rank;
    if (at == graph->rank && !(task = body_task(scope, worker, how, sketch->kernel, args, n)))
        return DUITE_E_MEMORY;
    if (task && own)
        give_block(task, own, task_owner_decides(how->at, kernel->replicated));
    for (size_t i = 0; i < n; i++) {
        struct data_object *object = object_of(scope, sketch, i, objects[i]);
        duite_mode mode = data_mode_of(kernel, i);
        if (task)
            task->access[i].waiter.mode = mode;
        code = use(scope, worker, at, kernel, i, mode, object, task, &done);
        if (code && task)
            task_void(graph, worker, task, i, done);
        if (code)
            return code;
    }
    if (task)
        task_settled(graph, worker, task, done);
    return DUITE_OK;
}

static void mix_fork(struct task_graph *graph, uint32_t kernel, int at, size_t n,
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
    struct sketch sketch;
    int code = check(scope, how->at, kernel, args, n, objects, &sketch);
    if (code)
        return code;
    scope->forks++;
    if (!scope->depth)
        mix_fork(scope->graph, sketch.kernel, how->at, n, objects);
    return fork_checked(scope, worker, how, &sketch, args, n, objects);
}

int task_free_object(struct task_scope *scope, struct worker *worker, duite_object name)
{
    struct task_graph *graph = scope->graph;
    duite_mode right;
    struct data_object *object = task_find_object(scope, name, &right);
    if (!object)
        return DUITE_E_OBJECT;
    if (object->n_views)
        return base_error(DUITE_E_VIEW, "duite_free: object %u.%u has %u views that are not freed",
                          name.slot, name.generation, object->n_views);
    if (!scope->depth)
        task_mix(graph, (uint64_t)name.slot << 32 | name.generation);
    int code = object->leaves ? task_close_sum(scope, worker, object) : DUITE_OK;
    task_forget(graph, worker, object);
    if (scope->depth)
        task_drop(scope, object);
    else
        data_object_drop(&graph->table, name);
    return code;
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
    int code = object->leaves ? task_close_sum(&graph->root, worker, object) : DUITE_OK;
    if (!code)
        code = task_view_gather(graph, worker, object);
    if (!code)
        code = to == TASK_ANYWHERE ? task_fetch_all(graph, worker, object)
                                   : task_fetch(graph, worker, object, to);
    if (code || (to != TASK_ANYWHERE && to != graph->rank))
        return code;
    struct data_version *version = task_local(graph, object);
    struct task *task = version ? task_new(&graph->root, TASK_COPY, 1, 0) : NULL;
    if (!task)
        return DUITE_E_MEMORY;
    task->copy = copy;
    task->block = object->block;
    uint32_t done = 0;
    task->access[0].waiter.mode = DUITE_R;
    task_read(task, 0, version, &done);
    task_settled(graph, worker, task, done);
    return DUITE_OK;
}

int task_see(struct task_scope *scope, struct worker *worker, duite_object name,
             struct data_version **version, size_t *size)
{
    duite_mode right;
    struct data_object *object = task_find_object(scope, name, &right);
    if (!object)
        return DUITE_E_OBJECT;
    *size = data_type_size(object->type);
    int code = object->leaves ? task_close_sum(scope, worker, object) : DUITE_OK;
    if (!code && !(*version = task_local(scope->graph, object)))
        code = DUITE_E_MEMORY;
    return code;
}
