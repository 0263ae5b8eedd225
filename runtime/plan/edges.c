/* Edges: what a node waits for. The pass goes through two rounds in a row with the last writer of
 * each place and the readers since. A node that waits for one of its own round gives an edge within
 * a round; a node that waits for one of the round before gives an edge from round to round. Each
 * edge joins two uses of one place, one of which writes, but for edges of the deciding node: so
 * conflicts are symmetric. A node that comes after T in a round and releases T of the next one runs
 * after T; one that comes before T runs, in the next round, after T. So nothing counts a node down
 * for the next round before the node has begun this one. The roots of a round and the deciding node
 * are joined both ways for the same reason. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

/* Nodes here are those of two rounds: the second round's follow the first one's. All are kept plus
 * one; 0: none. */
struct edge_place {
    uint32_t writer; /* the last one */
    uint32_t reader; /* the first in a list of those since */
};

struct edge_reader {
    uint32_t node, next;
};

struct edges {
    struct plan_round *round;
    struct edge_place *place;
    struct edge_reader *reader;
    uint32_t n_readers;
    uint32_t *mark;   /* by node: the last one that an edge goes to from here */
    size_t n_pending; /* places that the first round writes, and the second one does not yet */
};

static void edge_add(struct edges *e, uint32_t from, uint32_t to)
{
    struct plan_round *round = e->round;
    const uint32_t n = (uint32_t)round->n_nodes;
    const bool cyclic = to >= n;
    if (from >= n || e->mark[from] == to + 1)
        return;
    e->mark[from] = to + 1;
    struct plan_round_edge *edge = &round->edge[round->n_edges++];
    *edge = (struct plan_round_edge){from, cyclic ? to - n : to, cyclic};
    struct plan_round_node *before = &round->node[from], *after = &round->node[edge->to];
    before->n_next++;
    before->n_next_cyclic += cyclic;
    after->within += !cyclic;
    after->cyclic += cyclic;
}

static void edge_to_reader(struct edges *e, struct edge_place *place, uint32_t node)
{
    if (place->writer)
        edge_add(e, place->writer - 1, node);
    e->reader[e->n_readers] = (struct edge_reader){node, place->reader};
    place->reader = ++e->n_readers;
}

static void edge_to_writer(struct edges *e, struct edge_place *place, uint32_t node)
{
    const uint32_t n = (uint32_t)e->round->n_nodes;
    if (!place->reader && place->writer)
        edge_add(e, place->writer - 1, node);
    for (uint32_t i = place->reader; i; i = e->reader[i - 1].next)
        edge_add(e, e->reader[i - 1].node, node);
    if (node < n)
        e->n_pending += !place->writer;
    else
        e->n_pending -= place->writer <= n;
    place->reader = 0;
    place->writer = node + 1;
}

/* Once the second round has written all that the first one did, places join no more nodes of both.
 */
static void edges_of_places(struct edges *e, uint32_t to)
{
    const struct plan_round *round = e->round;
    const uint32_t n = (uint32_t)round->n_nodes;
    const struct plan_round_node *node = &round->node[to < n ? to : to - n];
    if (to >= n && !e->n_pending)
        return;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        struct edge_place *place = &e->place[round->use[i].place];
        if (round->use[i].writes)
            edge_to_writer(e, place, to);
        else
            edge_to_reader(e, place, to);
    }
}

/* What orders rounds, beside places. */
static void edges_of_rounds(struct edges *e, uint32_t to)
{
    const struct plan_round *round = e->round;
    const uint32_t n = (uint32_t)round->n_nodes, decider = n - 1;
    const struct plan_round_node *node = &round->node[to < n ? to : to - n];
    bool decides = round->source->flag != PLAN_NONE;
    if (decides && to == decider)
        for (uint32_t root = 0; root < decider; root++)
            if (!round->node[root].within)
                edge_add(e, root, decider);
    if (to < n || node->within)
        return;
    if (decides)
        edge_add(e, decider, to);
    else if (!node->cyclic) /* it conflicts with nothing: one round after the other */
        edge_add(e, to - n, to);
}

/* A use joins its node to at most one of the first round in each of both, and as one of the first
 * round to at most one that comes later; rounds are joined by at most two edges a node. */
static bool edges_room(struct edges *e)
{
    struct plan_round *round = e->round;
    const size_t nodes = round->n_nodes, uses = round->n_uses;
    e->place = base_alloc_zero((round->n_places + 1) * sizeof *e->place);
    e->reader = base_alloc((2 * uses + 1) * sizeof *e->reader);
    e->mark = base_alloc_zero((nodes + 1) * sizeof *e->mark);
    round->edge = base_alloc((3 * uses + 2 * nodes + 1) * sizeof *round->edge);
    return e->place && e->reader && e->mark && round->edge;
}

bool plan_edges(struct plan_round *round)
{
    struct edges e = {.round = round};
    const bool fine = edges_room(&e);
    for (uint32_t to = 0; to < 2 * round->n_nodes && fine; to++) {
        edges_of_places(&e, to);
        edges_of_rounds(&e, to);
    }
    base_free(e.place);
    base_free(e.reader);
    base_free(e.mark);
    return fine;
}
