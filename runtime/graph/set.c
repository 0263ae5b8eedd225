/* duite_set as a task: a w whose body copies bytes that the home kept since the call. */
#include "runtime/graph/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <string.h>

struct set_args {
    void *values; /* owned by the task; NULL: zeros */
};

static int set_body(const duite_call *call)
{
    const struct set_args *args = call->args;
    size_t bytes = call->param[0].count * data_type_size(call->param[0].type);
    if (args->values)
        memcpy(call->param[0].data, args->values, bytes);
    else
        memset(call->param[0].data, 0, bytes);
    base_free(args->values);
    return DUITE_OK;
}

const duite_kernel graph_set_kernel = {.name = "duite_set",
                                       .body = set_body,
                                       .access = {DUITE_W},
                                       .args_size = sizeof(struct set_args)};

int graph_set(struct graph *graph, void *worker, duite_object name, const void *values)
{
    struct data_object *object = data_object_find(&graph->table, name);
    if (!object)
        return DUITE_E_OBJECT;
    struct set_args args = {NULL};
    if (values && object->home == graph->rank) {
        args.values = base_alloc(object->bytes);
        if (!args.values) {
            base_no_memory("the values of duite_set");
            return graph_break(graph);
        }
        memcpy(args.values, values, object->bytes);
    }
    return graph_fork(graph, worker, GRAPH_ANYWHERE, &graph_set_kernel, &args, 1, &name);
}
