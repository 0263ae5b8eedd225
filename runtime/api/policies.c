/* Policies that are not ours are asked under a guard, for they may never return. On several ranks
 * the end of the guard breaks the communication, since a mapping that did not answer leaves this
 * rank unlike the others; on one the next get, wait or stop tells it. */
#include "runtime/api/instance.h"

#include "runtime/base/error.h"

int policies_guard(duite *rt, const duite_options *options, const duite_scheduler **scheduler,
                   const duite_balancer **balancer)
{
    const bool schedules = sched_is_foreign(options->scheduler),
               maps = map_is_foreign(options->mapping),
               balances = balance_is_foreign(options->balance);
    if (!(options->policy_seconds > 0) || !(schedules || maps || balances))
        return DUITE_OK;
    int code = base_guard_start(&rt->guard, options->policy_seconds, rt->threads, rt->graph.rank);
    if (code)
        return code;
    if (schedules)
        *scheduler = sched_front(&rt->scheduler, options->scheduler);
    if (balances)
        *balancer = balance_front(&rt->balancer, options->balance);
    if (maps)
        rt->mapping.caller = base_guard_caller(rt->guard, 0);
    return DUITE_OK;
}

static void is_over(void *context, const char *sentence)
{
    comm_broke(context, DUITE_E_ARGUMENT, sentence);
}

void policies_end(duite *rt)
{
    if (rt->guard)
        base_guard_tell(rt->guard, NULL, NULL);
}

void policies_begin(duite *rt)
{
    if (rt->guard && rt->comm)
        base_guard_tell(rt->guard, is_over, rt->comm);
}
