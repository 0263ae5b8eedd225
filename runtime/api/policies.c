/* Policies that are not built in may never return: a watchdog names those that do not. */
#include "runtime/api/instance.h"

#include "runtime/balance/balance.h"
#include "runtime/sched/sched.h"

int api_watch_policies(duite *rt, const duite_options *options)
{
    const char *policy[BASE_POLICY_KINDS] = {
        [BASE_SCHEDULER] = sched_is_foreign(options->scheduler) ? options->scheduler->name : NULL,
        [BASE_MAPPING] = map_is_foreign(options->mapping) ? options->mapping->name : NULL,
        [BASE_BALANCER] = balance_is_foreign(options->balance) ? options->balance->name : NULL};
    if (!(options->policy_seconds > 0) ||
        !(policy[BASE_SCHEDULER] || policy[BASE_MAPPING] || policy[BASE_BALANCER]))
        return DUITE_OK;
    const int code = base_watchdog_start(&rt->watchdog, &rt->monitor, policy,
                                         options->policy_seconds, rt->threads, rt->graph.rank);
    if (!code)
        rt->mapping.mark = base_watchdog_mark(rt->watchdog, BASE_MAPPING, 0);
    return code;
}
