/* Renaming: a w takes fresh bytes and starts at once, instead of waiting until nobody reads the old
 * version or makes it any more. Both then take memory: the bytes of the new one are counted from
 * the fork on until the old one dies. A version that was renamed away has no heir. */
#include "runtime/task/internal.h"

struct data_version *task_rename(struct task_graph *graph, struct worker *worker,
                                 struct data_object *object)
{
    struct data_version *version = object->current;
    uint64_t bytes = data_packet_memory(object->room);
    if (!version || bytes > graph->rename_most || data_version_is_alone(version))
        return version;
    if (atomic_fetch_add_explicit(&graph->rename_bytes, bytes, memory_order_relaxed) >
        graph->rename_most - bytes) {
        atomic_fetch_sub_explicit(&graph->rename_bytes, bytes, memory_order_relaxed);
        return version;
    }
    atomic_fetch_add_explicit(&graph->renamed, 1, memory_order_relaxed);
    version->renamed = true;
    version->rename_bytes = &graph->rename_bytes;
    object->current = NULL;
    task_release(graph, worker, version);
    return NULL;
}
