/* duite_set: a version that nobody has to wait for, so no task is needed and the old one is left to
 * its readers. */
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/data/view.h"

#include <string.h>

enum { OVERWRITTEN = 0x736574 }; /* tells a set from a free in the fingerprint */

static struct data_version *version_of(const struct data_object *object, const void *values,
                                       size_t count)
{
    size_t bytes = count * data_type_size(object->type);
    struct data_version *version = data_object_version(object);
    struct data_packet *packet = version ? data_packet_new(bytes, !values) : NULL;
    if (!packet) {
        if (version)
            data_version_free(version);
        return NULL;
    }
    if (values)
        memcpy(data_payload(packet), values, bytes);
    version->packet = packet;
    data_version_produced(version);
    data_version_release(version); /* the object alone holds it */
    return version;
}

int task_set_check(const struct task_graph *graph, const struct data_object *object,
                   duite_object name, size_t count)
{
    int code = data_view_refuse(&graph->table, object, "duite_set");
    if (code)
        return code;
    if (count == object->most || (object->sized && count < object->most))
        return DUITE_OK;
    return base_error(DUITE_E_SIZE, "duite_set_sized: %zu elements, and object %u.%u has %s%zu",
                      count, name.slot, name.generation, object->sized ? "at most " : "",
                      object->most);
}

int task_set_object(struct task_scope *scope, struct worker *worker, duite_object name,
                    const void *values, const size_t *wanted)
{
    struct task_graph *graph = scope->graph;
    duite_mode right;
    struct data_object *object = task_find_object(scope, name, &right);
    if (!object)
        return DUITE_E_OBJECT;
    size_t count = wanted ? *wanted : object->most;
    int code = task_set_check(graph, object, name, count);
    if (code)
        return code;
    if (!scope->depth) {
        task_mix(graph, (uint64_t)name.slot << 32 | name.generation);
        task_mix(graph, OVERWRITTEN);
        task_mix(graph, count);
    }
    struct data_version *version = NULL;
    if (object->home == graph->rank && !(version = version_of(object, values, count))) {
        base_no_memory("the values of duite_set");
        return task_break(graph);
    }
    code = object->leaves ? task_close_sum(scope, worker, object) : DUITE_OK;
    object->number++;
    data_object_moved(object, object->home);
    task_forget(graph, worker, object);
    object->current = version;
    return code;
}
