/* A prediction: the input is checked, the graph is made once and then run, and the results are
 * added up. */
#include "tools/predict/machine.h"

#include "runtime/balance/balance.h"
#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/policy.h"
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"
#include "tools/trace/export.h"

#include <math.h>

const char *predict_limit_name(enum predict_limit limit)
{
    static const char *const names[] = {"work",      "critical path", "latency",
                                        "bandwidth", "main program",  "overhead"};
    return names[limit];
}

struct predict_cluster predict_cluster_default(void)
{
    return (struct predict_cluster){.scheduler = duite_scheduler_find("steal"),
                                    .latency = -1,
                                    .bandwidth = 1.25e9,
                                    .capacity = INFINITY,
                                    .core_speed = 1,
                                    .overhead = -1,
                                    .message = -1,
                                    .look = -1,
                                    .seed = 1};
}

int predict_check(const struct trace_run *run, const struct predict_cluster *c)
{
    enum { MAX_WORKERS = 1 << 24 };
    if (run->lost || !run->whole)
        return base_error(DUITE_E_ARGUMENT,
                          "the trace is not whole (%llu events or words are missing): nothing can "
                          "be predicted from it",
                          (unsigned long long)run->lost);
    if (c->platform && c->platform->n_hosts != c->hosts)
        return base_error(DUITE_E_ARGUMENT, "the platform has %u hosts, not %u",
                          c->platform->n_hosts, c->hosts);
    if (!c->platform && (!c->hosts || !c->cores || c->hosts > MAX_WORKERS / c->cores))
        return base_error(DUITE_E_ARGUMENT, "%u hosts with %u cores are invalid", c->hosts,
                          c->cores);
    if (!c->platform &&
        (!(c->latency >= 0) || !(c->bandwidth > 0) || !(c->capacity > 0) || !(c->core_speed > 0)))
        return base_error(DUITE_E_ARGUMENT,
                          "a latency >= 0, and bandwidth, switch and speed > 0, are expected");
    if (!c->mapping && c->hosts != run->n_ranks)
        return base_error(DUITE_E_ARGUMENT,
                          "the homes that were traced are those of %u ranks, not %u hosts: name a "
                          "mapping",
                          run->n_ranks, c->hosts);
    if (c->scheduler->state_size > BASE_MAX_STATE ||
        (c->balance && c->balance->state_size > BASE_MAX_STATE))
        return base_error(DUITE_E_ARGUMENT,
                          "the scheduler or the balancer wants a state (state_size) of more than "
                          "%zu bytes",
                          BASE_MAX_STATE);
    if (isnan(c->message) || isnan(c->look))
        return base_error(DUITE_E_ARGUMENT, "the costs of messages and looks are numbers");
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

int predict_build_plain(struct predict_graph *graph, const struct trace_run *run)
{
    static const struct predict_cluster one = {.hosts = 1,
                                               .cores = 1,
                                               .bandwidth = INFINITY,
                                               .capacity = INFINITY,
                                               .core_speed = 1,
                                               .mapping = &map_block,
                                               .scheduler = &sched_steal};
    *graph = (struct predict_graph){.run = run, .cluster = &one, .plain = true};
    const int code = predict_check(run, &one);
    return code ? code : predict_build(graph);
}

/* ---- Results, when the run is over and no longer changes ---- */

/* Goes back from the last node along the causes. kernels: NULL, or seconds of the chain's bodies by
 * kernel. */
static void conclude_chain(const struct predict_machine *m, double *chain, double *kernels)
{
    const struct predict_graph *graph = m->graph;
    uint32_t at = m->latest;
    for (uint32_t k = 0; kernels && k < graph->run->n_kernels; k++)
        kernels[k] = 0;
    while (at != PREDICT_NONE) {
        const struct predict_node *node = &graph->node[at];
        const struct predict_cause *cause = &m->cause[at];
        double since = cause->by == PREDICT_NONE ? 0 : m->end[cause->by];
        bool travels = node->kind == PREDICT_MESSAGE;
        double all = m->end[at] - since;
        double own = travels ? m->end[at] - m->begin[at] : fmin(all, (double)node->seconds);
        chain[cause->kind == FORKED ? PREDICT_MAIN : PREDICT_OVERHEAD] += all - own;
        if (travels) {
            chain[PREDICT_LATENCY] += (double)cause->flight;
            chain[PREDICT_BANDWIDTH] += own - (double)cause->flight;
        } else {
            chain[cause->kind == LEFT_WORKER ? PREDICT_WORK : PREDICT_PATH] += own;
            if (kernels && node->kernel < graph->run->n_kernels)
                kernels[node->kernel] += own;
        }
        at = cause->by;
    }
}

static enum predict_limit conclude_limit(const struct predict_result *result)
{
    enum predict_limit limit = PREDICT_WORK;
    for (int i = 1; i < PREDICT_LIMITS; i++)
        if (result->chain[i] > result->chain[limit])
            limit = (enum predict_limit)i;
    return limit;
}

int predict_write_paje(const struct predict_machine *m, FILE *file)
{
    const struct predict_graph *graph = m->graph;
    struct trace_spans spans = {.n_workers = m->n_workers};
    spans.span = base_alloc(graph->n_nodes * sizeof *spans.span + 1);
    spans.host_of = base_alloc((m->n_workers + 1) * sizeof *spans.host_of);
    int code = spans.span && spans.host_of ? DUITE_OK : base_no_memory("the predicted run");
    for (uint32_t w = 0; w < m->n_workers && !code; w++)
        spans.host_of[w] = m->host_of[w];
    for (uint32_t i = 0; i < graph->n_nodes && !code; i++)
        if (graph->node[i].kind == PREDICT_TASK)
            spans.span[spans.n++] = (struct trace_span){
                m->begin[i], m->end[i], predict_describe(m, i).kernel, m->runs_on[i], NULL};
    if (!code)
        code = trace_write_paje_spans(file, &spans, NULL, m->now);
    trace_spans_free(&spans);
    return code;
}

void predict_conclude(struct predict_machine *m, struct predict_result *result, double *kernels)
{
    const struct predict_graph *graph = m->graph;
    double makespan = 0;
    for (size_t i = 0; i < graph->n_nodes; i++)
        makespan = fmax(makespan, m->end[i]);
    const double all = makespan * m->n_workers;
    *result = (struct predict_result){.tasks = graph->n_tasks,
                                      .messages = m->network.messages,
                                      .bytes = m->network.bytes,
                                      .stolen = m->stolen,
                                      .migrated = graph->migrated,
                                      .makespan = fmax(makespan, m->main_time),
                                      .critical_path = m->longest,
                                      .overhead = graph->costs[0].overhead,
                                      .message = graph->costs[0].message,
                                      .look = graph->costs[0].look,
                                      .bodies = graph->bodies,
                                      .medians = graph->medians,
                                      .idle = all > 0 ? 1 - m->busy / all : 0};
    for (size_t i = 0; i < graph->n_nodes; i++)
        result->work += (double)graph->node[i].seconds;
    conclude_chain(m, result->chain, kernels);
    result->limit = conclude_limit(result);
}

/* ---- All of it ---- */

int predict(const struct trace_run *run, const struct predict_cluster *cluster,
            struct predict_result *result, const struct predict_more *more)
{
    static const struct predict_more nothing = {0};
    struct predict_graph graph = {.run = run, .cluster = cluster};
    int code = predict_check(run, cluster);
    if (!code)
        code = predict_build(&graph);
    if (!code)
        code = predict_simulate(&graph, result, more ? more : &nothing);
    predict_graph_free(&graph);
    return code;
}
