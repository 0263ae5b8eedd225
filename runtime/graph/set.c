/* duite_set: a version that nobody has to wait for, so no task is needed and the old one is left to
 * its readers. */
#include "runtime/graph/internal.h"

#include "runtime/base/error.h"

#include <string.h>

enum { OVERWRITTEN = 0x736574 }; /* tells a set from a free in the fingerprint */

static struct data_version *version_of(const struct data_object *object, const void *values)
{
    struct data_version *version = data_version_new();
    struct data_packet *packet = version ? data_packet_new(object->bytes, !values) : NULL;
    if (!packet) {
        if (version)
            data_version_free(version);
        return NULL;
    }
    if (values)
        memcpy(data_payload(packet), values, object->bytes);
    version->packet = packet;
    data_version_produced(version);
    data_version_release(version); /* the object alone holds it */
    return version;
}

int graph_set(struct graph *graph, void *worker, duite_object name, const void *values)
{
    struct data_object *object = data_object_find(&graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    graph_mix(graph, (uint64_t)name.slot << 32 | name.generation);
    graph_mix(graph, OVERWRITTEN);
    struct data_version *version = NULL;
    if (object->home == graph->rank && !(version = version_of(object, values))) {
        base_no_memory("the values of duite_set");
        return graph_break(graph);
    }
    int code = object->leaves ? graph_close(graph, worker, object) : DUITE_OK;
    object->number++;
    data_object_moved(object, object->home);
    graph_forget(graph, worker, object);
    object->current = version;
    return code;
}
