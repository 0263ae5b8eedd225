/* The main program's calls for the trace. It opens with the workers, recording changes between
 * steps while no task is left, and it closes before the workers go. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

void api_trace_begin(duite *rt)
{
    if (!rt->trace)
        return;
    trace_align(rt->trace, rt->mpi);
    if (trace_wants_all(rt->trace))
        trace_switch(rt->trace, true, 0, 0);
}

/* Waits for all tasks as duite_wait does, and records the wait: else the time would count as the
 * main program's own. */
static int step_meet(duite *rt, const char *call)
{
    const uint64_t from = base_ticks();
    const int code = api_meet(rt, call, NULL);
    trace_wait(rt->trace, from);
    return code;
}

int duite_trace_step(duite *rt, uint64_t step)
{
    int code = api_enter(rt, "duite_trace_step");
    if (code || !rt->trace || rt->traced)
        return code;
    bool wants = trace_wants(rt->trace, step);
    if (wants != trace_is_on(rt->trace)) {
        code = step_meet(rt, "duite_trace_step");
        trace_flush(rt->trace);
        trace_switch(rt->trace, wants, step, rt->graph.root.forks);
    }
    work_note(rt->pool,
              &(struct trace_event){.begin = base_ticks(), .number = step, .kind = TRACE_STEP});
    trace_flush(rt->trace);
    return code;
}

static int trace_close_file(duite *rt)
{
    struct trace_counters *counters = base_alloc_zero(rt->share.workers * sizeof *counters);
    if (counters)
        work_note_counters(rt->pool, counters);
    if (trace_is_on(rt->trace))
        trace_switch(rt->trace, false, 0, rt->graph.root.forks);
    int code = trace_close(rt->trace, counters);
    base_free(counters);
    return code;
}

int api_trace_end(duite *rt, const char *call)
{
    if (!rt->trace || rt->traced)
        return DUITE_OK;
    int code = step_meet(rt, call);
    if (rt->comm && !code) {
        comm_hold(rt->comm);
        trace_align(rt->trace, rt->mpi);
        comm_let_go(rt->comm);
    }
    rt->traced = true;
    const int closed = trace_close_file(rt);
    return code ? code : closed;
}

int duite_trace_end(duite *rt)
{
    int code = api_enter(rt, "duite_trace_end");
    return code ? code : api_trace_end(rt, "duite_trace_end");
}
