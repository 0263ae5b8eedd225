/* Rights: what a task holds is what its kernel's modes say, and all of what it made; a child gets
 * no more than that. */
#include "runtime/graph/nest.h"

#include "runtime/base/error.h"

const char *graph_mode_name(duite_mode mode)
{
    static const char *const names[] = {"no right", "r", "w", "rw", "cw", "rp", "wp", "rwp", "cwp"};
    return names[mode];
}

static bool gives(duite_mode held, duite_mode wanted)
{
    if (held == DUITE_RWP)
        return true;
    return (graph_postponed(held) || held == DUITE_R) &&
           graph_immediate(wanted) == graph_immediate(held);
}

int graph_check_right(struct graph_scope *scope, const char *call, size_t i, duite_object name,
                      duite_mode wanted)
{
    const struct graph_task *task = ((struct graph_nest *)scope)->body->task;
    const char *forker = scope->graph->kernels[task->kernel]->name;
    const char *mode = graph_mode_name(wanted);
    struct data_object *local;
    duite_mode held;
    if (!graph_known(scope, name, &held, &local)) {
        if (name.slot && name.slot < GRAPH_LOCAL_NAME)
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
        return local ? DUITE_OK : graph_lend_reads(scope);
    return base_error(DUITE_E_RIGHT,
                      "%s, parameter %zu: the task holds %s on object %u.%u, parameter %u of its "
                      "kernel %s, and %s is wanted",
                      call, i, graph_mode_name(held), name.slot, name.generation,
                      name.slot - GRAPH_LOCAL_NAME, forker, mode);
}

int graph_wrong_law(const struct graph_scope *scope, const duite_kernel *kernel, size_t i,
                    duite_object name)
{
    const struct graph_task *task = ((const struct graph_nest *)scope)->body->task;
    const duite_kernel *forker = scope->graph->kernels[task->kernel];
    uint32_t parameter = name.slot - GRAPH_LOCAL_NAME;
    return base_error(DUITE_E_RIGHT,
                      "%s, parameter %zu: the task holds cwp by law %s on object %u.%u, parameter "
                      "%u of its kernel %s, and law %s is wanted",
                      kernel->name, i, data_law_of(forker, parameter)->name, name.slot,
                      name.generation, parameter, forker->name, data_law_of(kernel, i)->name);
}

int graph_check_call(struct duite_call_private *body, const char *call, duite_object object,
                     duite_mode wanted)
{
    struct graph_scope *scope = graph_inside(body);
    return scope ? graph_check_right(scope, call, 0, object, wanted) : DUITE_E_MEMORY;
}

bool graph_lent(const struct duite_call_private *body, duite_object object)
{
    return (object.slot & ~GRAPH_LOCAL_NAME) < body->task->n;
}
