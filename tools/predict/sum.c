/* Sums of forked contributions: each host that contributes combines its own as far as the reduction
 * tree allows (data/subtrees.h), and sends its subtrees to the object's home, which adds up. A
 * sum's cost on a host follows from the contributions and subtrees that it combines, not from its
 * cost in the trace. Sums of rounds are those of the runtime's passes (round.c). */
#include "tools/predict/graph.h"

#include "runtime/base/memory.h"
#include "runtime/data/subtrees.h"
#include "runtime/task/task.h"

#include <stdlib.h>

struct sum_leaf {
    uint32_t host, first, node; /* first: its place in the tree */
};

static int leaf_compare(const void *left, const void *right)
{
    const struct sum_leaf *a = left, *b = right;
    return a->host != b->host ? (a->host > b->host) - (a->host < b->host)
                              : (a->first > b->first) - (a->first < b->first);
}

/* The contributions by host, those of a host in fork order. NULL without memory. */
static struct sum_leaf *leaves_by_host(struct predict_graph *graph, uint32_t object, size_t *n)
{
    const uint32_t newest = graph->object[object].leaves;
    *n = 0;
    for (uint32_t i = newest; i != PREDICT_NONE; i = graph->link[i].next)
        ++*n;
    struct sum_leaf *leaf = base_alloc(*n * sizeof *leaf + 1);
    uint32_t first = (uint32_t)*n;
    for (uint32_t i = newest; i != PREDICT_NONE && leaf; i = graph->link[i].next) {
        first--;
        leaf[first] = (struct sum_leaf){graph->link[i].host, first, graph->link[i].node};
    }
    if (leaf)
        qsort(leaf, *n, sizeof *leaf, leaf_compare);
    graph->failed |= !leaf;
    return leaf;
}

/* How many subtrees a host's n contributions make. `list` has room for them. */
static size_t leaves_combine(const struct sum_leaf *leaf, size_t n, struct data_subtrees *list)
{
    list->n = 0;
    for (size_t i = 0; i < n; i++)
        data_subtrees_push(list, (struct data_subtree){.first = leaf[i].first}, NULL, NULL);
    return list->n;
}

/* A host combines its n contributions, and sends `trees` subtrees. Returns the message. */
static uint32_t pieces_send(struct predict_graph *graph, uint32_t object,
                            const struct sum_leaf *leaf, size_t n, size_t trees)
{
    const struct predict_object *o = &graph->object[object];
    uint32_t pieces = predict_own_node(graph, PREDICT_TASK, leaf->host, TASK_PIECES, 0);
    uint32_t message =
        predict_own_node(graph, PREDICT_MESSAGE, leaf->host, 0, (uint64_t)trees * o->bytes);
    if (graph->failed)
        return PREDICT_NONE;
    graph->node[pieces].seconds = (float)n;
    graph->node[message].block = (uint32_t)o->home;
    for (size_t i = 0; i < n; i++)
        predict_edge(graph, leaf[i].node, pieces);
    predict_edge(graph, pieces, message);
    return message;
}

/* Each contributor has a value of its own. */
static void edge_contribution(struct predict_graph *graph, uint32_t from, uint32_t sum,
                              uint32_t object)
{
    predict_edge_kind(graph, from, sum, true);
    if (graph->plain && graph->node[from].block != graph->node[sum].block)
        graph->shown[from] += (float)graph->object[object].bytes;
}

/* The sum waits for the home's own contributions, and for the messages of other hosts, which stand
 * in place of their first contributions. */
static void sum_add(struct predict_graph *graph, uint32_t object, const struct sum_leaf *leaf,
                    size_t n, size_t combined)
{
    const uint32_t home = (uint32_t)graph->object[object].home;
    const uint32_t fetched = predict_fetch(graph, object, (int)home);
    uint32_t sum = predict_own_node(graph, PREDICT_TASK, home, TASK_COMBINE, 0);
    if (graph->failed)
        return;
    graph->node[sum].seconds = (float)combined;
    predict_edge_value(graph, fetched, sum, object);
    for (size_t i = 0; i < n; i++) {
        if (leaf[i].host == home)
            edge_contribution(graph, leaf[i].node, sum, object);
        else if (!i || leaf[i - 1].host != leaf[i].host)
            predict_edge(graph, leaf[i].node, sum);
    }
    predict_overwrite(graph, sum, object, (int)home);
}

void predict_reduce(struct predict_graph *graph, uint32_t object)
{
    struct predict_object *o = &graph->object[object];
    size_t n, combined = 0;
    struct sum_leaf *leaf = leaves_by_host(graph, object, &n);
    struct data_subtrees list = {.at = base_alloc(n * sizeof *list.at + 1)};
    graph->failed |= !list.at;
    for (size_t i = 0, end = 0; i < n && !graph->failed; i = end) {
        while (end < n && leaf[end].host == leaf[i].host)
            end++;
        const bool away = leaf[i].host != (uint32_t)o->home;
        const size_t trees = away ? leaves_combine(leaf + i, end - i, &list) : end - i;
        if (away)
            leaf[i].node = pieces_send(graph, object, leaf + i, end - i, trees);
        combined += trees;
    }
    if (!graph->failed)
        sum_add(graph, object, leaf, n, combined);
    predict_sum_count(graph, n, false);
    o->leaves = PREDICT_NONE;
    base_free(leaf);
    base_free(list.at);
}

/* ---- Seconds ---- */

/* One merge for each contribution, and one for each piece from a rank to another that added up. */
void predict_sum_count(struct predict_graph *graph, size_t contributions, bool all)
{
    const double ranks = graph->run->n_ranks;
    graph->merges += (double)contributions + (ranks - 1) * (all ? ranks : 1);
}

/* The seconds of a sum are merges until all sums of the trace are counted. */
void predict_sums_take(struct predict_graph *graph, double seconds)
{
    static const uint32_t sums = TASK_TYPE_BIT(TASK_COMBINE) | TASK_TYPE_BIT(TASK_PIECES) |
                                 TASK_TYPE_BIT(TASK_NODE_SUM) | TASK_TYPE_BIT(TASK_NODE_PARTIAL);
    const uint32_t first = graph->run->n_kernels;
    for (size_t i = 0; i < graph->n_nodes; i++) {
        struct predict_node *node = &graph->node[i];
        if (node->kernel >= first && sums >> (node->kernel - first) & 1)
            node->seconds *= (float)seconds;
    }
}
