/* The order of a round's nodes: the hosts' parts are merged, so that no edge within the round, the
 * messages between hosts among them, points back. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct parts_order {
    size_t *first;              /* by node, plus 1: of the edges that begin there, */
    uint32_t *to;               /* and where they end */
    uint32_t *before;           /* by node: how many edges to it are left */
    uint32_t *place;            /* by node: its new number */
    uint32_t *node;             /* by place */
    struct predict_node *nodes; /* in the new order */
    uint32_t *forks;
};

static bool order_room(struct parts_order *o, struct predict_round *round)
{
    const size_t n = round->n_nodes + 2;
    o->first = base_alloc_zero(n * sizeof *o->first);
    o->to = base_alloc((round->n_edges + 1) * sizeof *o->to);
    o->before = base_alloc_zero(n * sizeof *o->before);
    o->place = base_alloc(n * sizeof *o->place);
    o->node = base_alloc(n * sizeof *o->node);
    o->nodes = malloc(n * sizeof *o->nodes);
    o->forks = malloc(n * sizeof *o->forks);
    round->begins = base_alloc_zero(n * sizeof *round->begins);
    round->ends = base_alloc_zero(n * sizeof *round->ends);
    return o->first && o->to && o->before && o->place && o->node && o->nodes && o->forks &&
           round->begins && round->ends;
}

static void order_free(struct parts_order *o)
{
    base_free(o->first);
    base_free(o->to);
    base_free(o->before);
    base_free(o->place);
    base_free(o->node);
    free(o->nodes);
    free(o->forks);
}

/* Lists the edges within the round by the node where they begin. */
static void order_list(struct parts_order *o, const struct predict_round *round)
{
    for (size_t i = 0; i < round->n_edges; i++)
        if (!round->edge[i].cyclic)
            o->first[round->edge[i].from + 2]++;
    for (size_t i = 0; i < round->n_nodes; i++)
        o->first[i + 2] += o->first[i + 1];
    for (size_t i = 0; i < round->n_edges; i++) {
        const struct plan_round_edge *edge = &round->edge[i];
        if (edge->cyclic)
            continue;
        o->to[o->first[edge->from + 1]++] = edge->to;
        o->before[edge->to]++;
    }
}

/* Each node follows all that come before it in its round: first those that follow none. */
static size_t order_find(struct parts_order *o, const struct predict_round *round)
{
    size_t n = 0;
    for (uint32_t i = 0; i < round->n_nodes; i++)
        if (!o->before[i])
            o->node[n++] = i;
    for (size_t at = 0; at < n; at++)
        for (size_t k = o->first[o->node[at]]; k < o->first[o->node[at] + 1]; k++)
            if (!--o->before[o->to[k]])
                o->node[n++] = o->to[k];
    return n;
}

static void order_apply(struct parts_order *o, struct predict_round *round)
{
    for (uint32_t i = 0; i < round->n_nodes; i++) {
        const uint32_t old = o->node[i];
        o->place[old] = i;
        o->nodes[i] = round->node[old];
        o->forks[i] = round->fork[old];
        round->begins[i] = round->ends[i] = true;
    }
    for (size_t i = 0; i < round->n_edges; i++) {
        struct plan_round_edge *edge = &round->edge[i];
        *edge = (struct plan_round_edge){o->place[edge->from], o->place[edge->to], edge->cyclic};
        round->begins[edge->to] &= edge->cyclic;
        round->ends[edge->from] &= edge->cyclic;
    }
    memcpy(round->node, o->nodes, round->n_nodes * sizeof *round->node);
    memcpy(round->fork, o->forks, round->n_nodes * sizeof *round->fork);
}

bool predict_parts_sort(struct predict_round *round)
{
    struct parts_order o = {0};
    bool fine = order_room(&o, round);
    if (fine && round->n_nodes) {
        order_list(&o, round);
        fine = order_find(&o, round) == round->n_nodes;
        if (fine)
            order_apply(&o, round);
    }
    order_free(&o);
    return fine;
}
