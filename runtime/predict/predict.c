/* A prediction: the graph is made once, and then run. */
#include "runtime/predict/graph.h"

#include "runtime/balance/balance.h"
#include "runtime/base/error.h"
#include "runtime/base/policy.h"
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"

const char *predict_limit_name(enum predict_limit limit)
{
    static const char *const names[] = {"work",      "critical path", "latency",
                                        "bandwidth", "main program",  "overhead"};
    return names[limit];
}

int predict_check(const struct trace_run *run, const struct predict_cluster *c)
{
    enum { MOST_WORKERS = 1 << 24 };
    if (run->lost || !run->whole)
        return base_error(DUITE_E_ARGUMENT,
                          "the trace is not whole (%llu events or words are missing): nothing can "
                          "be predicted from it",
                          (unsigned long long)run->lost);
    if (!c->hosts || !c->cores || c->hosts > MOST_WORKERS / c->cores)
        return base_error(DUITE_E_ARGUMENT, "%u hosts with %u cores are invalid", c->hosts,
                          c->cores);
    if (!(c->latency >= 0) || !(c->bandwidth > 0) || !(c->capacity > 0) || !(c->core_speed > 0))
        return base_error(DUITE_E_ARGUMENT,
                          "a latency >= 0, and bandwidth, switch and speed > 0, are expected");
    if (!c->mapping && c->hosts != run->n_ranks)
        return base_error(DUITE_E_ARGUMENT,
                          "the homes that were traced are those of %u ranks, not %u hosts: name a "
                          "mapping",
                          run->n_ranks, c->hosts);
    if (!(c->policy_seconds >= 0 && c->policy_seconds <= 1e9))
        return base_error(DUITE_E_ARGUMENT,
                          "the seconds of a policy (DUITE_POLICY_SECONDS) are no number from 0 to "
                          "1e9");
    if (c->scheduler->state_size > BASE_MAX_STATE ||
        (c->balance && c->balance->state_size > BASE_MAX_STATE))
        return base_error(DUITE_E_ARGUMENT,
                          "the scheduler or the balancer wants a state (state_size) of more than "
                          "%zu bytes",
                          BASE_MAX_STATE);
    if (!(c->message >= 0))
        return base_error(DUITE_E_ARGUMENT, "the cost of a message is a number >= 0");
    if (c->balance && (c->balance->victim || c->balance->place))
        return base_error(DUITE_E_ARGUMENT,
                          "tasks that the balancer %s sends to other ranks are not predicted: take "
                          "none, or migrate",
                          c->balance->name);
    if (c->balance && c->balance->migrate && !c->mapping)
        return base_error(DUITE_E_ARGUMENT,
                          "the balancer %s moves what a mapping placed: name a mapping",
                          c->balance->name);
    return DUITE_OK;
}

/* Policies that are not built in are watched: one that does not return is named. */
static int watch_policies(struct predict_graph *graph, struct base_monitor *monitor)
{
    const struct predict_cluster *c = graph->cluster;
    const char *policy[BASE_POLICY_KINDS] = {
        [BASE_SCHEDULER] = sched_is_foreign(c->scheduler) ? c->scheduler->name : NULL,
        [BASE_MAPPING] = c->mapping && map_is_foreign(c->mapping) ? c->mapping->name : NULL,
        [BASE_BALANCER] = c->balance && balance_is_foreign(c->balance) ? c->balance->name : NULL};
    if (!(c->policy_seconds > 0) ||
        !(policy[BASE_SCHEDULER] || policy[BASE_MAPPING] || policy[BASE_BALANCER]))
        return DUITE_OK;
    return base_watchdog_start(&graph->watchdog, monitor, policy, c->policy_seconds, 1, -1);
}

int predict(const struct trace_run *run, const struct predict_cluster *cluster,
            struct predict_result *result, FILE *paje)
{
    struct base_monitor monitor = {0};
    struct predict_graph graph = {.run = run, .cluster = cluster};
    int code = predict_check(run, cluster);
    if (!code)
        code = watch_policies(&graph, &monitor);
    if (!code)
        code = predict_build(&graph);
    if (!code)
        code = predict_simulate(&graph, result, paje);
    predict_graph_free(&graph);
    base_watchdog_stop(graph.watchdog);
    return code;
}
