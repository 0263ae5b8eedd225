/* Rights: what a task holds is what its kernel's modes say, and all of what it made; a child gets
 * no more than that. */
#include "runtime/task/nest.h"

#include "runtime/base/error.h"

const char *task_mode_name(duite_mode mode)
{
    static const char *const names[] = {"no right", "r", "w", "rw", "cw", "rp", "wp", "rwp", "cwp"};
    return names[mode];
}

static bool gives(duite_mode held, duite_mode wanted)
{
    if (held == DUITE_RWP)
        return true;
    return (task_postponed(held) || held == DUITE_R) &&
           task_immediate(wanted) == task_immediate(held);
}

int task_check_right(struct task_scope *scope, const char *call, size_t i, duite_object name,
                     duite_mode wanted)
{
    const struct task *task = ((struct task_nest *)scope)->body->task;
    const char *forker = scope->graph->kernels[task->kernel]->name;
    const char *mode = task_mode_name(wanted);
    struct data_object *local;
    duite_mode held;
    if (!task_known(scope, name, &held, &local)) {
        if (name.slot && name.slot < TASK_LOCAL_NAME)
            return base_error(DUITE_E_RIGHT,
                              "%s, parameter %zu: the task (kernel %s) holds no right on object "
                              "%u.%u of the main program, %s is wanted",
                              call, i, forker, name.slot, name.generation, mode);
        return base_error(DUITE_E_OBJECT,
                          "%s, parameter %zu: object %u.%u %s (in a task of kernel %s)", call, i,
                          name.slot, name.generation,
                          name.slot ? "was freed, or is another task's" : "names nothing", forker);
    }
    if (gives(held, wanted))
        return local ? DUITE_OK : offload_lend_reads(scope);
    return base_error(DUITE_E_RIGHT,
                      "%s, parameter %zu: the task holds %s on object %u.%u, parameter %u of its "
                      "kernel %s, and %s is wanted",
                      call, i, task_mode_name(held), name.slot, name.generation,
                      name.slot - TASK_LOCAL_NAME, forker, mode);
}

int task_wrong_law(const struct task_scope *scope, const duite_kernel *kernel, size_t i,
                   duite_object name)
{
    const struct task *task = ((const struct task_nest *)scope)->body->task;
    const duite_kernel *forker = scope->graph->kernels[task->kernel];
    uint32_t parameter = name.slot - TASK_LOCAL_NAME;
    return base_error(DUITE_E_RIGHT,
                      "%s, parameter %zu: the task holds cwp by law %s on object %u.%u, parameter "
                      "%u of its kernel %s, and law %s is wanted",
                      kernel->name, i, data_law_of(forker, parameter)->name, name.slot,
                      name.generation, parameter, forker->name, data_law_of(kernel, i)->name);
}

int task_check_call(struct duite_call_private *body, const char *call, duite_object object,
                    duite_mode wanted)
{
    struct task_scope *scope = task_inside(body);
    return scope ? task_check_right(scope, call, 0, object, wanted) : DUITE_E_MEMORY;
}

bool task_lent(const struct duite_call_private *body, duite_object object)
{
    return (object.slot & ~TASK_LOCAL_NAME) < body->task->n;
}
