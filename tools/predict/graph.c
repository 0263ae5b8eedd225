/* Nodes of a predicted run, and the nodes that each waits for. Plain growing arrays: who waits for
 * whom is decided by value.c and sum.c for forks, and by the runtime's passes for rounds. */
#include "tools/predict/graph.h"

#include "runtime/base/memory.h"
#include "runtime/task/task.h"

#include <stdlib.h>

uint32_t predict_add(struct predict_graph *graph, const struct predict_node *node)
{
    graph->failed |= graph->n_nodes >= PREDICT_NONE;
    if (!predict_grew(graph, BASE_GROW(graph->node, graph->nodes_capacity, graph->n_nodes + 1)))
        return 0;
    if (graph->plain) {
        if (!predict_grew(graph,
                          BASE_GROW(graph->shown, graph->shown_capacity, graph->n_nodes + 1)))
            return 0;
        graph->shown[graph->n_nodes] = 0;
    }
    graph->node[graph->n_nodes] = *node;
    graph->node[graph->n_nodes].pending = 1;
    graph->node[graph->n_nodes].edge = PREDICT_NONE;
    return (uint32_t)graph->n_nodes++;
}

void predict_edge_kind(struct predict_graph *graph, uint32_t from, uint32_t to, bool reads)
{
    if (from == PREDICT_NONE || from == to || (graph->plain && !reads) ||
        !predict_grew(graph, BASE_GROW(graph->edge, graph->edges_capacity, graph->n_edges + 1)))
        return;
    graph->linked |= from >= graph->round;
    if (graph->node[from].edge != PREDICT_NONE && graph->edge[graph->node[from].edge].to == to)
        return;
    graph->edge[graph->n_edges] = (struct predict_edge){to, graph->node[from].edge};
    graph->node[from].edge = (uint32_t)graph->n_edges++;
    graph->node[to].pending++;
}

void predict_edge(struct predict_graph *graph, uint32_t from, uint32_t to)
{
    predict_edge_kind(graph, from, to, false);
}

void predict_link_push(struct predict_graph *graph, uint32_t *list, uint32_t node, uint32_t host)
{
    if (!predict_grew(graph, BASE_GROW(graph->link, graph->links_capacity, graph->n_links + 1)))
        return;
    graph->link[graph->n_links] = (struct predict_link){node, host, *list};
    *list = (uint32_t)graph->n_links++;
}

uint32_t predict_own_node(struct predict_graph *graph, enum predict_kind kind, uint32_t host,
                          uint32_t what, uint64_t number)
{
    double seconds = kind == PREDICT_TASK ? graph->own[what] : 0;
    return predict_add(graph, &(struct predict_node){.number = number,
                                                     .kernel = graph->run->n_kernels + what,
                                                     .host = host,
                                                     .block = host,
                                                     .priority = INT32_MAX,
                                                     .seconds = (float)seconds,
                                                     .kind = kind});
}

void predict_hold(struct predict_graph *graph, uint32_t node)
{
    if (!graph->linked && graph->decided)
        predict_edge_kind(graph, graph->began[graph->node[node].host], node, true);
}

void predict_graph_free(struct predict_graph *graph)
{
    free(graph->node);
    free(graph->shown);
    free(graph->edge);
    free(graph->op);
    free(graph->object);
    free(graph->link);
    free(graph->reader);
    free(graph->hint);
    predict_platform_free(&graph->flat);
    base_free(graph->memory);
}
