/* What a predicted run tells when it is over: nothing of it changes any more. */
#include "runtime/predict/machine.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/task/task.h"
#include "runtime/trace/export.h"

#include <math.h>

duite_ready predict_describe(const struct predict_machine *m, uint32_t node)
{
    const struct predict_node *n = &m->graph->node[node];
    const struct trace_run *run = m->graph->run;
    const uint32_t ran = n->placed ? m->affinity[n->placed - 1] : PREDICT_NONE;
    const bool has_affinity = ran != PREDICT_NONE && ran / m->cluster->cores == n->host;
    return (duite_ready){.kernel = n->kernel < run->n_kernels
                                       ? run->kernel_name[n->kernel]
                                       : task_own_name(n->kernel - run->n_kernels),
                         .number = n->number,
                         .block = n->block,
                         .priority = n->priority,
                         .cost = (double)n->cost,
                         .path = (double)n->path,
                         .affinity = has_affinity ? 1 + ran % m->cluster->cores : 0};
}

static double conclude_path(const struct predict_graph *graph, double *path)
{
    double longest = 0;
    for (size_t i = 0; i < graph->n_nodes; i++)
        path[i] = 0;
    for (size_t i = 0; i < graph->n_nodes; i++) { /* no edge points back */
        const struct predict_node *node = &graph->node[i];
        double end = path[i] + (double)node->seconds;
        longest = fmax(longest, end);
        for (uint32_t e = node->edge; e != PREDICT_NONE; e = graph->edge[e].next)
            path[graph->edge[e].to] = fmax(path[graph->edge[e].to], end);
    }
    return longest;
}

/* From the last node back along what each waited for. */
static void conclude_chain(const struct predict_machine *m, double *chain)
{
    const struct predict_graph *graph = m->graph;
    uint32_t at = m->latest;
    while (at != PREDICT_NONE) {
        const struct predict_node *node = &graph->node[at];
        const struct predict_cause *cause = &m->cause[at];
        double since = cause->by == PREDICT_NONE ? 0 : m->end[cause->by];
        bool travels = node->kind == PREDICT_MESSAGE || node->kind == PREDICT_EXCHANGE;
        double all = m->end[at] - since;
        if (travels) {
            chain[PREDICT_LATENCY] += (double)cause->flight;
            chain[PREDICT_BANDWIDTH] += all - (double)cause->flight;
        } else {
            double own = fmin(all, (double)node->seconds);
            chain[cause->how == LEFT_WORKER ? PREDICT_WORK : PREDICT_PATH] += own;
            chain[cause->how == FORKED ? PREDICT_MAIN : PREDICT_OVERHEAD] += all - own;
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
    struct trace_span *span = base_alloc(graph->n_nodes * sizeof *span + 1);
    uint32_t *host_of = base_alloc((m->n_workers + 1) * sizeof *host_of);
    int code = span && host_of ? DUITE_OK : base_no_memory("the predicted run");
    size_t n = 0;
    for (uint32_t w = 0; w < m->n_workers && !code; w++)
        host_of[w] = w / m->cluster->cores;
    for (uint32_t i = 0; i < graph->n_nodes && !code; i++)
        if (graph->node[i].kind == PREDICT_TASK)
            span[n++] = (struct trace_span){m->begin[i], m->end[i], predict_describe(m, i).kernel,
                                            m->runs_on[i]};
    if (!code)
        code = trace_write_paje_spans(file, span, n, host_of, m->n_workers, m->now);
    base_free(span);
    base_free(host_of);
    return code;
}

void predict_conclude(struct predict_machine *m, struct predict_result *result)
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
                                      .overhead = graph->overhead,
                                      .idle = all > 0 ? 1 - m->busy / all : 0};
    for (size_t i = 0; i < graph->n_nodes; i++)
        result->work += (double)graph->node[i].seconds;
    conclude_chain(m, result->chain);
    result->critical_path = conclude_path(graph, m->begin);
    result->limit = conclude_limit(result);
}
