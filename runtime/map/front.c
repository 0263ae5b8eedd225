/* Mappings are asked by the main thread alone. */
#include "runtime/map/front.h"

#include "runtime/base/error.h"

/* What is not built in says nothing itself. */
static int told(const duite_mapping *own, int code)
{
    return code && map_is_foreign(own) ? base_error(code, "mapping %s failed with code %d (%s)",
                                                    own->name, code, duite_code_text(code))
                                       : code;
}

int map_ask(const struct map_front *mapping, const duite_object_graph *graph, int n_ranks,
            uint64_t seed, int *home)
{
    static const struct base_guarded what = {"mapping", "map"};
    struct base_caller *caller = mapping->caller;
    if (!caller)
        return told(mapping->own, mapping->own->map(graph, n_ranks, seed, home));
    if (sigsetjmp(caller->back, 0) || !base_guard_enters(caller, &what, mapping->own->name))
        return base_guard_code(caller->guard);
    int code = mapping->own->map(graph, n_ranks, seed, home);
    base_guard_leaves(caller);
    return told(mapping->own, code);
}

int map_ask_tasks(const struct map_front *mapping, const duite_task_graph *graph, int *home)
{
    static const struct base_guarded what = {"mapping", "map_tasks"};
    struct base_caller *caller = mapping->caller;
    if (!caller)
        return mapping->own->map_tasks(graph, home);
    if (sigsetjmp(caller->back, 0) || !base_guard_enters(caller, &what, mapping->own->name))
        return base_guard_code(caller->guard);
    int code = mapping->own->map_tasks(graph, home);
    base_guard_leaves(caller);
    return code;
}
