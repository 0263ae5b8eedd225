/* The main program's calls that make, place and free objects; those of a body go on to bodies.c.
 * Their arguments are part of the fingerprint, since every rank must make the same calls. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/data/object.h"
#include "runtime/map/map.h"

#include <string.h>

/* A function apart, or each call of a body would save registers for it. */
__attribute__((noinline)) static int main_new(duite *rt, duite_type type, size_t count, size_t max,
                                              bool sized, duite_object *object)
{
    const char *call = sized ? "duite_new_sized" : "duite_new";
    int code = api_enter(rt, call);
    if (code)
        return code;
    if (!object)
        return api_remember(rt,
                            base_error(DUITE_E_ARGUMENT, "%s: nowhere to put the object", call));
    task_mix(&rt->graph, count);
    if (sized)
        task_mix(&rt->graph, max);
    task_mix(&rt->graph, (uint64_t)type);
    task_mixed(&rt->graph, COMM_CALLED, sized ? COMM_CALLED_NEW_SIZED : COMM_CALLED_NEW);
    code = data_object_new(&rt->graph.table, type, count, max, sized, object);
    if (!code)
        trace_object(rt->trace, &rt->graph.table, *object);
    return api_remember(rt, code);
}

static inline int object_new(duite *rt, duite_type type, size_t count, size_t max, bool sized,
                             duite_object *object)
{
    struct duite_call_private *body = api_body(rt);
    if (object)
        *object = DUITE_NO_OBJECT;
    return body ? api_body_new(body, type, count, max, sized, object)
                : main_new(rt, type, count, max, sized, object);
}

int duite_new(duite *rt, duite_type type, size_t count, duite_object *object)
{
    return object_new(rt, type, count, count, false, object);
}

int duite_new_sized(duite *rt, duite_type type, size_t count, size_t max, duite_object *object)
{
    return object_new(rt, type, count, max, true, object);
}

/* All ranks find these errors, and only these keep the object from being made. */
static int adopt_check(const duite *rt, int rank, duite_type type, size_t count,
                       const duite_object *object)
{
    if (!object)
        return base_error(DUITE_E_ARGUMENT, "duite_adopt: nowhere to put the object");
    if (rank < 0 || rank >= rt->graph.n_ranks)
        return base_error(DUITE_E_ARGUMENT, "duite_adopt: there is no rank %d, only 0 to %d", rank,
                          rt->graph.n_ranks - 1);
    return data_object_check(type, count, count)
               ? data_object_refuse("duite_adopt", type, count, count)
               : DUITE_OK;
}

int duite_adopt(duite *rt, int rank, duite_type type, size_t count, void *values, duite_done *done,
                void *user, duite_object *object)
{
    if (object)
        *object = DUITE_NO_OBJECT;
    int code = api_enter(rt, "duite_adopt");
    if (code)
        return code;
    struct task_graph *graph = &rt->graph;
    code = adopt_check(rt, rank, type, count, object);
    if (code)
        return api_remember(rt, code);
    task_mix(graph, (uint64_t)rank);
    task_mix(graph, count);
    task_mix(graph, (uint64_t)type);
    task_mixed(graph, COMM_CALLED, COMM_CALLED_ADOPT);
    code = data_object_new_at(&graph->table, type, count, rank, NULL, object);
    if (code)
        return api_remember(rt, code);
    trace_object(rt->trace, &graph->table, *object);
    trace_moved(rt->trace, &graph->table, &object->slot, 1);
    code = task_adopt(graph, &graph->table.object[object->slot], values, done, user);
    return graph->broken ? api_remember(rt, code) : code; /* a poisoned value tells of itself */
}

static void object_mix_name(duite *rt, duite_object object)
{
    task_mix(&rt->graph, task_name_bits(object));
}

static void object_mix_double(duite *rt, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    task_mix(&rt->graph, bits);
}

static void object_mix_hint(duite *rt, duite_object object, double weight, size_t n,
                            const duite_object *neighbours, const double *edge_weights)
{
    object_mix_name(rt, object);
    object_mix_double(rt, weight);
    task_mix(&rt->graph, n);
    for (size_t i = 0; i < n && neighbours; i++)
        object_mix_name(rt, neighbours[i]);
    for (size_t i = 0; i < n && edge_weights; i++)
        object_mix_double(rt, edge_weights[i]);
}

int duite_hint(duite *rt, duite_object object, double weight, size_t n,
               const duite_object *neighbours, const double *edge_weights)
{
    int code = api_enter(rt, "duite_hint");
    if (code)
        return code;
    object_mix_hint(rt, object, weight, n, neighbours, edge_weights);
    task_mixed(&rt->graph, COMM_CALLED, COMM_CALLED_HINT);
    code = map_hint(&rt->graph.table, object, weight, n, neighbours, edge_weights);
    if (!code)
        trace_hint(rt->trace, object, weight, n, neighbours, edge_weights);
    return api_remember(rt, code);
}

int duite_colocate(duite *rt, duite_object object, duite_object leader)
{
    int code = api_enter(rt, "duite_colocate");
    if (code)
        return code;
    object_mix_name(rt, object);
    object_mix_name(rt, leader);
    task_mixed(&rt->graph, COMM_CALLED, COMM_CALLED_COLOCATE);
    code = map_colocate(&rt->graph.table, object, leader);
    if (!code)
        trace_colocate(rt->trace, object, leader);
    return api_remember(rt, code);
}

int duite_home(duite *rt, duite_object object)
{
    if (api_enter_any(rt, "duite_home") || api_settle(rt))
        return -1;
    const struct data_object *found = data_object_find(&rt->graph.table, object);
    return found ? found->home : -1;
}

/* True if this rank has some part of the object. */
static bool object_is_here(const duite *rt, const struct data_object *object)
{
    int rank = rt->graph.rank;
    return object->home == rank || object->holder == rank || object->current || object->sum;
}

int duite_is_local(duite *rt, duite_object object)
{
    if (api_enter_any(rt, "duite_is_local") || api_settle(rt))
        return 1;
    const struct data_object *found = data_object_find(&rt->graph.table, object);
    return !found || object_is_here(rt, found);
}

void duite_prefetch(const duite *rt, size_t n, const duite_object *objects)
{
    if (!rt || task_thread_mark() != rt->thread)
        return;
    const struct data_table *table = &rt->graph.table;
    for (size_t i = 0; i < n; i++)
        if (objects[i].slot < table->n_slots)
            base_prefetch(table->object + objects[i].slot);
}

int duite_free(duite *rt, duite_object object)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_free(body, object);
    int code = api_enter(rt, "duite_free");
    if (!code)
        code = api_remember(rt, api_settle(rt));
    if (!code)
        code = api_remember(rt, task_free_object(&rt->graph.root, rt->worker, object));
    if (!code)
        trace_freed(rt->trace, object);
    return code;
}
