/* The checks of a fork, one after the other: the second look at a fork that fork.c does not take at
 * once. Each has the sentence of its error. Only marks are changed, and an error takes them away
 * again. */
#include "runtime/task/scope.h"

#include "runtime/base/error.h"

static int fork_check_kernel(struct task_fork_call *call)
{
    const duite_kernel *kernel = call->kernel;
    if (!kernel)
        return base_error(DUITE_E_ARGUMENT, "duite_fork: no kernel");
    call->fixed = task_kernel_find(call->scope->graph, kernel);
    if (call->fixed)
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
static int fork_check_call(const struct task_fork_call *call, int at, const void *args)
{
    const struct task_graph *graph = call->scope->graph;
    const duite_kernel *kernel = call->kernel;
    const size_t n = call->n, fixed = call->fixed->n;
    if (n < fixed || (n > fixed && kernel->variadic == DUITE_NONE) || n > TASK_MAX_OBJECTS)
        return base_error(DUITE_E_ACCESS, "kernel %s takes %s%zu objects, not %zu", kernel->name,
                          kernel->variadic == DUITE_NONE ? "" : "at least ", fixed, n);
    if (n && !call->objects)
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
                      kernel->name, i, law->name, data_law_types(law), name.slot, name.generation,
                      data_type_name(object->type));
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

void task_fork_unmark(const struct task_fork_call *call, size_t n)
{
    for (size_t i = 0; i < n; i++)
        task_fork_object(call, i)->mark = 0;
}

static int fork_check_objects(struct task_fork_call *call)
{
    for (size_t i = 0; i < call->n; i++) {
        int code = fork_check_object(call, i);
        if (code) {
            task_fork_unmark(call, i);
            return code;
        }
    }
    return DUITE_OK;
}

int task_fork_check(struct task_fork_call *call, int at, const void *args)
{
    int code = fork_check_kernel(call);
    if (!code)
        code = fork_check_call(call, at, args);
    if (!code && call->scope->depth)
        code = fork_check_rights(call);
    return code ? code : fork_check_objects(call);
}
