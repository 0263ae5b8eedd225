/* A prediction: the graph is made once, and then run. */
#include "runtime/predict/graph.h"

#include "runtime/base/error.h"

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
                          "be foretold from it",
                          (unsigned long long)run->lost);
    if (!c->hosts || !c->cores || c->hosts > MOST_WORKERS / c->cores)
        return base_error(DUITE_E_ARGUMENT, "%u hosts with %u cores cannot be", c->hosts, c->cores);
    if (!(c->latency >= 0) || !(c->bandwidth > 0) || !(c->capacity > 0) || !(c->core_speed > 0))
        return base_error(DUITE_E_ARGUMENT,
                          "a latency >= 0, and bandwidth, switch and speed > 0, are expected");
    if (!c->mapping && c->hosts != run->n_ranks)
        return base_error(DUITE_E_ARGUMENT,
                          "the homes that were traced are those of %u ranks, not %u hosts: name a "
                          "mapping",
                          run->n_ranks, c->hosts);
    if (!(c->message >= 0))
        return base_error(DUITE_E_ARGUMENT, "the cost of a message is a number >= 0");
    if (c->balance && (c->balance->victim || c->balance->place))
        return base_error(DUITE_E_ARGUMENT,
                          "tasks that the balancer %s sends to other ranks are not foretold: take "
                          "none, or migrate",
                          c->balance->name);
    if (c->balance && c->balance->migrate && !c->mapping)
        return base_error(DUITE_E_ARGUMENT,
                          "the balancer %s moves what a mapping placed: name a mapping",
                          c->balance->name);
    return DUITE_OK;
}

int predict(const struct trace_run *run, const struct predict_cluster *cluster,
            struct predict_result *result, FILE *paje)
{
    struct predict_graph graph = {.run = run, .cluster = cluster};
    int code = predict_check(run, cluster);
    if (!code)
        code = predict_build(&graph);
    if (!code)
        code = predict_simulate(&graph, result, paje);
    predict_graph_free(&graph);
    return code;
}
