/* Edges: the predecessors of each node. The pass goes through two rounds in a row, and asks the
 * order rule (data/order.h) at each use of a place. Waiting for a node of the same round gives an
 * edge within a round, waiting for a node of the previous round an edge from round to round. Each
 * edge, except those of the deciding node, joins two uses of one place, one of which writes: so
 * conflicts are symmetric. A node after T in the round that releases T of the next round runs after
 * T; a node before T runs, in the next round, after T. So no node is counted down for the next
 * round before it has begun this one. The roots of a round and the deciding node are joined both
 * ways for the same reason.
 *
 * A barrier is a node that runs after all nodes before it in the round, such as the sum of the
 * contributions of all blocks. An edge from a node before a barrier to one that runs after it is
 * left out, since the barrier orders both. So the same nodes are in order, by longer ways. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"
#include "runtime/data/order.h"

/* Nodes of two rounds: the second round's numbers follow the first one's. */
struct edges {
    struct plan_round *round;
    struct data_order_chain *place;
    struct data_order_reader *reader;
    uint32_t n_readers;
    uint32_t *mark;    /* by node: the last one that an edge from here goes to, plus 1 */
    uint32_t *barrier; /* by node of two rounds: the last one that it is or runs after, plus 1 */
    size_t n_pending;  /* places written in the first round, but not yet in the second */
    size_t n_ends;     /* nodes of the first round from which no edge leads on in it, so far */
};

static uint32_t edge_later(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static void edge_add(struct edges *e, uint32_t from, uint32_t to)
{
    struct plan_round *round = e->round;
    const uint32_t n = (uint32_t)round->n_nodes;
    const bool cyclic = to >= n;
    e->barrier[to] = edge_later(e->barrier[to], e->barrier[from]);
    if (from >= n || e->mark[from] == to + 1)
        return;
    e->mark[from] = to + 1;
    round->edge[round->n_edges++] = (struct plan_round_edge){from, cyclic ? to - n : to, cyclic};
}

/* Keeps those edges from number `first` on, all to one node, that no barrier makes needless. */
static void edges_keep(struct edges *e, size_t first, uint32_t to)
{
    struct plan_round *round = e->round;
    const size_t end = round->n_edges;
    round->n_edges = first;
    for (size_t i = first; i < end; i++) {
        const struct plan_round_edge edge = round->edge[i];
        struct plan_round_node *before = &round->node[edge.from], *after = &round->node[edge.to];
        if (edge.from + 1 < e->barrier[to])
            continue;
        round->edge[round->n_edges++] = edge;
        e->n_ends -= !edge.cyclic && before->n_next == before->n_next_cyclic;
        before->n_next++;
        before->n_next_cyclic += edge.cyclic;
        after->within += !edge.cyclic;
        after->cyclic += edge.cyclic;
    }
}

static bool edge_of_order(void *edges, uint32_t from, uint32_t to)
{
    edge_add(edges, from, to);
    return true;
}

/* No place joins nodes of both rounds once the second has written every place of the first. */
static void edges_of_places(struct edges *e, uint32_t to)
{
    const struct plan_round *round = e->round;
    const uint32_t n = (uint32_t)round->n_nodes;
    const struct plan_round_node *node = &round->node[to < n ? to : to - n];
    if (to >= n && !e->n_pending)
        return;
    for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
        struct data_order_chain *place = &e->place[round->use[i].place];
        const bool writes = round->use[i].writes;
        e->n_pending += writes && to < n && !place->writer;
        e->n_pending -= writes && to >= n && place->writer <= n;
        data_order_next(place, e->reader, &e->n_readers, to, writes, edge_of_order, e);
    }
}

/* Edges that order rounds, beside those of places. */
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
    else if (!node->cyclic) /* no conflict orders its rounds */
        edge_add(e, to - n, to);
}

/* Each use gives at most three edges: one from a node of the first round in each of the two rounds,
 * and one to a later node. Rounds are joined by at most two edges per node. */
static bool edges_room(struct edges *e)
{
    struct plan_round *round = e->round;
    const size_t nodes = round->n_nodes, uses = round->n_uses;
    e->place = base_alloc_zero((round->n_places + 1) * sizeof *e->place);
    e->reader = base_alloc((2 * uses + 1) * sizeof *e->reader);
    e->mark = base_alloc_zero((nodes + 1) * sizeof *e->mark);
    e->barrier = base_alloc_zero((2 * nodes + 1) * sizeof *e->barrier);
    round->edge = base_alloc((3 * uses + 2 * nodes + 1) * sizeof *round->edge);
    return e->place && e->reader && e->mark && e->barrier && round->edge;
}

bool plan_edges(struct plan_round *round)
{
    struct edges e = {.round = round};
    const bool fine = edges_room(&e);
    for (uint32_t to = 0; to < 2 * round->n_nodes && fine; to++) {
        const size_t first = round->n_edges;
        edges_of_places(&e, to);
        edges_keep(&e, first, to);
        const size_t more = round->n_edges;
        edges_of_rounds(&e, to);
        edges_keep(&e, more, to);
        if (to < round->n_nodes && !e.n_ends++)
            e.barrier[to] = to + 1;
    }
    base_free(e.place);
    base_free(e.reader);
    base_free(e.mark);
    base_free(e.barrier);
    return fine;
}
