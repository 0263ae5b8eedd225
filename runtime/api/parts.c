/* The calls that split objects and join them. The main program's trace has what they fork. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/task/fork.h"
#include "runtime/task/parts.h"

#include <string.h>

static void split_trace(const duite *rt, const duite_object *name, size_t n)
{
    const struct data_table *table = &rt->graph.table;
    for (size_t i = 1; i <= n; i++) {
        trace_object(rt->trace, table, name[i]);
        trace_moved(rt->trace, table, &name[i].slot, 1);
    }
    trace_fork(rt->trace, &task_split_kernel, &task_no_options, n + 1, name);
}

static int main_split(duite *rt, duite_object object, size_t n, const size_t *counts,
                      const duite_object *parts)
{
    int code = api_enter(rt, "duite_split");
    if (code)
        return code;
    code = parts ? api_settle(rt)
                 : base_error(DUITE_E_ARGUMENT, "duite_split: nowhere to put the parts");
    if (!code)
        code = task_split(&rt->graph, NULL, rt->worker, object, n, counts);
    if (!code && rt->trace)
        split_trace(rt, task_split_names(&rt->graph, NULL, object, &n), n);
    if (!code)
        api_throttle(rt);
    return api_remember(rt, code);
}

int duite_split(duite *rt, duite_object object, size_t n, const size_t *counts, duite_object *parts)
{
    struct duite_call_private *body = api_body(rt);
    const int code = body ? api_body_split(body, object, n, counts, parts)
                          : main_split(rt, object, n, counts, parts);
    for (size_t i = 0; i < n && parts; i++)
        parts[i] = DUITE_NO_OBJECT;
    if (!code)
        memcpy(parts, task_split_names(&rt->graph, body, object, &n) + 1, n * sizeof *parts);
    return code;
}

static int main_join(duite *rt, duite_object object)
{
    int code = api_enter(rt, "duite_join");
    if (code)
        return code;
    size_t n = 0;
    const duite_object *name = task_split_names(&rt->graph, NULL, object, &n);
    if (!name)
        return api_remember(rt, DUITE_E_OBJECT);
    if (rt->trace) /* the names end with the join */
        trace_fork(rt->trace, &task_join_kernel, &task_no_options, n + 1, name);
    for (size_t i = 1; i <= n && rt->trace; i++)
        trace_freed(rt->trace, name[i]);
    code = task_join(&rt->graph, NULL, rt->worker, object);
    if (!code)
        api_throttle(rt);
    return api_remember(rt, code);
}

int duite_join(duite *rt, duite_object object)
{
    struct duite_call_private *body = api_body(rt);
    return body ? api_body_join(body, object) : main_join(rt, object);
}
