/* The calls of the main program; those of a body go on to bodies.c. Each call checks that it may be
 * made, settles the homes of new objects where they matter, and leaves the work to task/ and plan/.
 * Calls that return at once remember their error for the next get, wait or stop. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/map/map.h"
#include "runtime/task/fork.h"

#include <stdio.h>

int api_enter_any(duite *rt, const char *call)
{
    if (!rt)
        return base_error(DUITE_E_ARGUMENT, "%s: no runtime", call);
    if (!work_may_fork(rt->pool))
        return base_error(DUITE_E_STATE, "%s is for the main thread, outside of bodies", call);
    if (rt->memo)
        plan_memo_break(rt->memo);
    if (rt->graph.broken)
        return base_error(rt->graph.broken,
                          "%s: an earlier call failed beyond repair (%s); only duite_stop is left",
                          call, duite_code_text(rt->graph.broken));
    if (rt->mpi_held)
        return api_remember(
            rt,
            base_error(DUITE_E_STATE, "%s: not between duite_mpi_begin and duite_mpi_end", call));
    if (!comm_is_broken(rt->comm))
        return DUITE_OK;
    api_give_up(rt); /* before the program knows: then no body finds its context gone */
    return comm_error(rt->comm);
}

int api_enter(duite *rt, const char *call)
{
    int code = api_enter_any(rt, call);
    if (code || !rt->building)
        return code;
    return api_remember(rt, base_error(DUITE_E_STATE, "%s: not while a graph is recorded", call));
}

int api_remember(duite *rt, int code)
{
    if (code && rt->building)
        return api_graphs_failed(rt, code);
    if (code == DUITE_E_MEMORY && rt->comm)
        rt->graph.broken = code; /* the other ranks did what this one could not */
    if (rt->graph.broken)
        api_give_up(rt);
    if (!code || rt->remembered)
        return code;
    rt->remembered = code;
    snprintf(rt->message, sizeof rt->message, "%s", duite_message());
    return code;
}

int api_settle(duite *rt)
{
    const struct data_table *table = &rt->graph.table;
    if (!table->n_unsettled)
        return DUITE_OK;
    trace_settles(rt->trace, table);
    int code = map_settle(&rt->graph.table, &rt->mapping, rt->seed);
    if (!code)
        trace_settled(rt->trace, table);
    else if (rt->comm && code != DUITE_E_MEMORY)     /* api_remember handles that */
        comm_break(rt->comm, code, duite_message()); /* other ranks may have homes now */
    return code;
}

/* ---- MPI of the program's own ---- */

int duite_mpi_begin(duite *rt)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_mpi_begin(body);
    const int code = api_enter(rt, "duite_mpi_begin");
    if (code)
        return code;
    comm_guests_hold(&rt->graph.guests, rt);
    rt->mpi_held = true;
    return DUITE_OK;
}

int duite_mpi_end(duite *rt)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_mpi_end(body);
    if (!rt)
        return base_error(DUITE_E_ARGUMENT, "duite_mpi_end: no runtime");
    if (!work_may_fork(rt->pool))
        return base_error(DUITE_E_STATE, "duite_mpi_end is for the main thread and bodies");
    if (!rt->mpi_held)
        return base_error(DUITE_E_STATE, "duite_mpi_end: duite_mpi_begin was not called");
    rt->mpi_held = false;
    comm_guests_let_go(&rt->graph.guests);
    return DUITE_OK;
}

/* ---- Tasks ---- */

/* This ends. Consider the first in fork order of the unfinished tasks of all ranks: it waits for
 * tasks forked earlier, which are over. A rank that has not come to its fork yet does not send its
 * inputs, but is not throttled: all its tasks are even earlier, so they are over. Contributions do
 * not wait for the access that combines them, and that waits for earlier tasks only. Messages go
 * on, since a throttled rank sends and receives as it works. */
void api_throttle(duite *rt)
{
    if (rt->window && !rt->turns) /* tasks may wait for the program itself */
        work_throttle(rt->pool, rt->window);
}

static int fork_task(duite *rt, const struct task_options *options, const duite_kernel *kernel,
                     const void *args, size_t n, const duite_object *objects)
{
    if (rt->building) {
        const int recorded = plan_record_fork(rt->building, options, kernel, args, n, objects);
        return recorded ? api_remember(rt, recorded) : DUITE_OK;
    }
    int code = rt->graph.table.n_unsettled ? api_settle(rt) : DUITE_OK;
    if (!code)
        code = task_fork(&rt->graph.root, rt->worker, options, kernel, args, n, objects);
    if (!code && rt->trace)
        trace_fork(rt->trace, kernel, options, n, objects);
    if (rt->comm)
        work_tick(rt->pool);
    if (!code)
        api_throttle(rt);
    return code || rt->graph.broken ? api_remember(rt, code) : DUITE_OK;
}

/* True for a usual fork outside of bodies: by the main thread, with nothing broken, no graph being
 * recorded, all homes settled, and MPI not held by the program. Only ranks and a trace may then ask
 * for more. */
static inline bool fork_is_usual(const duite *rt)
{
    const uint64_t more = (uintptr_t)rt->building | rt->graph.table.n_unsettled |
                          (uint64_t)rt->mpi_held | (uint64_t)rt->graph.broken;
    return !more && task_thread_mark() == rt->thread;
}

__attribute__((noinline)) static int fork_other(duite *rt, const duite_kernel *kernel,
                                                const void *args, size_t n,
                                                const duite_object *objects)
{
    int code = api_enter_any(rt, "duite_fork");
    return code ? code : fork_task(rt, &task_no_options, kernel, args, n, objects);
}

/* A usual fork on several ranks. After every so many of those that make no task here messages are
 * polled, and broken communication is noticed. */
__attribute__((noinline)) static int fork_ranks(duite *rt, const duite_kernel *kernel,
                                                const void *args, size_t n,
                                                const duite_object *objects)
{
    enum { FORKS_A_TICK = 32 };
    const uint64_t tasks = rt->graph.tasks;
    if (task_has_given_up(&rt->graph))
        return fork_other(rt, kernel, args, n, objects);
    const int code = task_fork_ranks(&rt->graph, rt->worker, kernel, args, n, objects);
    if (code)
        return api_remember(rt, code);
    if (rt->trace)
        trace_fork(rt->trace, kernel, &task_no_options, n, objects);
    if (rt->graph.tasks == tasks && rt->graph.root.forks % FORKS_A_TICK)
        return DUITE_OK;
    work_tick(rt->pool);
    if (comm_is_broken(rt->comm))
        return api_enter_any(rt, "duite_fork");
    api_throttle(rt);
    return DUITE_OK;
}

static inline int fork_direct(duite *rt, const duite_kernel *kernel, const void *args, size_t n,
                              const duite_object *objects)
{
    const int code = task_fork_main(&rt->graph, rt->worker, kernel, args, n, objects);
    if (code)
        return api_remember(rt, code);
    if (rt->window)
        api_throttle(rt);
    return DUITE_OK;
}

/* A function apart, since it needs most registers. */
__attribute__((noinline)) static int fork_recognised(duite *rt, const duite_kernel *kernel,
                                                     const void *args, size_t n,
                                                     const duite_object *objects)
{
    if (!plan_memo_fork(rt->memo, kernel, args, n, objects))
        return fork_direct(rt, kernel, args, n, objects);
    if (rt->window)
        api_throttle(rt);
    return DUITE_OK;
}

int duite_fork(duite *rt, const duite_kernel *kernel, const void *args, size_t n,
               const duite_object *objects)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_fork(body, kernel, args, n, objects);
    if (!rt || !fork_is_usual(rt))
        return fork_other(rt, kernel, args, n, objects);
    if (rt->comm)
        return fork_ranks(rt, kernel, args, n, objects);
    if (rt->trace)
        return fork_other(rt, kernel, args, n, objects);
    return rt->memo ? fork_recognised(rt, kernel, args, n, objects)
                    : fork_direct(rt, kernel, args, n, objects);
}

int duite_fork_at(duite *rt, int rank, const duite_kernel *kernel, const void *args, size_t n,
                  const duite_object *objects)
{
    int code = api_enter_any(rt, "duite_fork_at");
    if (code)
        return code;
    if (rank < 0)
        return api_remember(
            rt, base_error(DUITE_E_ARGUMENT, "duite_fork_at: there is no rank %d", rank));
    return fork_task(rt, &(struct task_options){.at = rank}, kernel, args, n, objects);
}

int duite_fork_with(duite *rt, const duite_task_options *options, const duite_kernel *kernel,
                    const void *args, size_t n, const duite_object *objects)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_fork_with(body, options, kernel, args, n, objects);
    int code = api_enter_any(rt, "duite_fork_with");
    if (code)
        return code;
    struct task_options own = {.at = TASK_ANYWHERE};
    if (options)
        own = (struct task_options){.at = options->at ? *options->at : TASK_ANYWHERE,
                                    .priority = options->priority,
                                    .cost = options->cost > 0 ? options->cost : 0};
    if (options && options->at && own.at < 0)
        return api_remember(
            rt, base_error(DUITE_E_ARGUMENT, "duite_fork_with: there is no rank %d", own.at));
    return fork_task(rt, &own, kernel, args, n, objects);
}

static int object_set(duite *rt, duite_object object, const void *values, const size_t *count,
                      const char *call)
{
    struct duite_call_private *body = api_body(rt);
    if (body)
        return api_body_set(body, object, values, count, call);
    int code = api_enter_any(rt, call);
    if (!code && rt->building)
        return api_remember(rt, plan_record_set(rt->building, object, values, count));
    if (!code)
        code = api_remember(rt, api_settle(rt));
    if (!code)
        code = api_remember(
            rt, task_set_object(&rt->graph.root, rt->worker, object, TASK_ANYWHERE, values, count));
    if (!code)
        trace_set(rt->trace, object);
    return code;
}

int duite_set(duite *rt, duite_object object, const void *values)
{
    return object_set(rt, object, values, NULL, "duite_set");
}

int duite_set_sized(duite *rt, duite_object object, const void *values, size_t count)
{
    return object_set(rt, object, values, &count, "duite_set_sized");
}

int duite_set_at(duite *rt, duite_object object, int rank, const void *values)
{
    int code = api_enter(rt, "duite_set_at");
    if (code)
        return code;
    if (rank < 0 || rank >= rt->graph.n_ranks)
        return api_remember(rt, base_error(DUITE_E_ARGUMENT,
                                           "duite_set_at: there is no rank %d, only 0 to %d", rank,
                                           rt->graph.n_ranks - 1));
    code = api_settle(rt);
    if (!code)
        code = task_set_object(&rt->graph.root, rt->worker, object, rank, values, NULL);
    if (!code)
        trace_set(rt->trace, object);
    return api_remember(rt, code);
}

/* ---- Ranks, threads and cores ---- */

int duite_rank(const duite *rt)
{
    return rt ? rt->graph.rank : -1;
}

int duite_ranks(const duite *rt)
{
    return rt ? rt->graph.n_ranks : -1;
}

unsigned duite_threads(const duite *rt)
{
    return rt ? rt->share.workers : 0;
}

unsigned duite_cores(const duite *rt, const char **from)
{
    if (from)
        *from = rt ? rt->share.from : "";
    return rt ? rt->share.cores : 0;
}

int duite_oversubscribed(const duite *rt)
{
    return rt ? rt->oversubscribed : 0;
}
