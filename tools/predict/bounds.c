/* The longest chain of bodies: of the plain graph, whose edges are values that are read. Bodies
 * take what they took in the trace, and all else no time; one that never ran takes none either. */
#include "tools/predict/graph.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "tools/trace/sums.h"

#include <math.h>

/* A node of the chain that ends with it. */
struct chain_node {
    double end;      /* s; until it is walked: its beginning */
    uint32_t before; /* node, or NONE */
};

static double chain_seconds(const struct predict_graph *graph, const struct trace_bodies *bodies,
                            size_t i)
{
    const struct predict_node *node = &graph->node[i];
    double seconds = 0;
    if (node->number && node->kernel < graph->run->n_kernels)
        trace_bodies_find(bodies, node->number, &seconds);
    return seconds;
}

/* Returns the node with which the longest chain ends; NONE: no body takes time. */
static uint32_t chain_walk(const struct predict_graph *graph, const struct trace_bodies *bodies,
                           struct chain_node *chain)
{
    uint32_t last = PREDICT_NONE;
    double longest = 0;
    for (size_t i = 0; i < graph->n_nodes; i++)
        chain[i] = (struct chain_node){0, PREDICT_NONE};
    for (uint32_t i = 0; i < graph->n_nodes; i++) { /* no edge points back */
        chain[i].end += chain_seconds(graph, bodies, i);
        if (chain[i].end > longest) {
            longest = chain[i].end;
            last = i;
        }
        for (uint32_t e = graph->node[i].edge; e != PREDICT_NONE; e = graph->edge[e].next)
            if (chain[i].end > chain[graph->edge[e].to].end)
                chain[graph->edge[e].to] = (struct chain_node){chain[i].end, i};
    }
    return last;
}

/* The tasks of the chain, from its last one back. */
static int chain_numbers(const struct predict_graph *graph, const struct chain_node *chain,
                         uint32_t last, struct predict_bounds *bounds)
{
    size_t n = 0;
    for (uint32_t i = last; i != PREDICT_NONE; i = chain[i].before)
        n += graph->node[i].number != 0;
    bounds->number = base_alloc((n + 1) * sizeof *bounds->number);
    if (!bounds->number)
        return base_no_memory("the longest chain of a trace");
    bounds->n = n;
    for (uint32_t i = last; i != PREDICT_NONE; i = chain[i].before)
        if (graph->node[i].number)
            bounds->number[--n] = graph->node[i].number;
    return DUITE_OK;
}

static int chain_find(const struct predict_graph *graph, struct predict_bounds *bounds)
{
    struct trace_bodies *bodies = trace_bodies_new(graph->run);
    struct chain_node *chain = base_alloc((graph->n_nodes + 1) * sizeof *chain);
    int code = bodies && chain ? DUITE_OK : base_no_memory("the longest chain of a trace");
    if (!code) {
        const uint32_t last = chain_walk(graph, bodies, chain);
        bounds->path = last == PREDICT_NONE ? 0 : chain[last].end;
        code = chain_numbers(graph, chain, last, bounds);
    }
    trace_bodies_free(bodies);
    base_free(chain);
    return code;
}

int predict_bounds(const struct trace_run *run, struct predict_bounds *bounds)
{
    struct predict_graph graph;
    struct trace_sums sums = {0};
    *bounds = (struct predict_bounds){0};
    int code = predict_build_plain(&graph, run);
    if (!code)
        code = chain_find(&graph, bounds);
    predict_graph_free(&graph);
    if (!code)
        code = trace_sum(run, &sums);
    if (!code)
        bounds->lower = fmax(bounds->path, sums.busy / sums.workers);
    trace_sums_free(&sums);
    return code;
}

void predict_bounds_free(struct predict_bounds *bounds)
{
    base_free(bounds->number);
}
