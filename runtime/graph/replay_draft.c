/* A draft lists the nodes of one round in order: the forks, before each access that ends
 * contributions the node that adds them, before the first one that reads a view, and the first
 * after its object was written, the node that gathers it, and last the node that reads the flag.
 * Two rounds of it are then gone through with the last writer of each place and the readers since:
 * what waits for a node of its own round gives the edges within a round, what waits for one of the
 * round before gives those from round to round. Every edge but one to or from the deciding node
 * joins two uses of one place of which one writes: conflicts are symmetric, so a node that comes
 * after T in a round and releases T of the next one runs after T, and one that comes before T runs,
 * in the next round, after T. A node thus never hears of the next round before it has begun this
 * one. The roots of a round and the deciding node are joined both ways for the same reason. */
#include "runtime/graph/replay_draft.h"
#include "runtime/graph/internal.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

/* ---- The nodes of a round ---- */

static struct graph_draft_node *add_node(struct graph_draft *draft, enum graph_kind kind,
                                         size_t fork)
{
    struct graph_draft_node *node = &draft->node[draft->n_nodes++];
    *node =
        (struct graph_draft_node){.kind = kind, .fork = (uint32_t)fork, .first_use = draft->n_uses};
    return node;
}

static void add_use(struct graph_draft *draft, struct graph_draft_node *node, size_t place,
                    bool reads, bool writes)
{
    draft->use[draft->n_uses++] = (struct graph_node_use){(uint32_t)place, reads, writes};
    node->n_uses++;
}

/* A buffer for a contribution, and its place in the row of those that are open. */
static size_t add_leaf(struct graph_draft *draft, uint32_t object, const duite_law *law)
{
    struct graph_draft_place *whole = &draft->place[object];
    size_t leaf = draft->n_places++;
    draft->place[leaf] = (struct graph_draft_place){.object = object, .law = law};
    whole->law = law;
    if (whole->n_open++)
        draft->place[whole->last].next = (uint32_t)leaf;
    else
        whole->first = (uint32_t)leaf;
    whole->last = (uint32_t)leaf;
    return leaf;
}

static void close_sum(struct graph_draft *draft, uint32_t object, size_t fork)
{
    struct graph_draft_place *whole = &draft->place[object];
    if (!whole->n_open)
        return;
    struct graph_draft_node *node = add_node(draft, GRAPH_NODE_SUM, fork);
    add_use(draft, node, object, true, true);
    for (uint32_t leaf = whole->first; whole->n_open; leaf = draft->place[leaf].next) {
        add_use(draft, node, leaf, true, false);
        whole->n_open--;
    }
}

/* A view of an object that nobody writes is gathered before the replay. */
static void gather_view(struct graph_draft *draft, uint32_t view, size_t fork)
{
    const struct graph_recorded_object *objects = draft->record->object;
    if (!graph_recorded_gathers(objects, &objects[view]))
        return;
    uint32_t parent = objects[view].parent - 1;
    close_sum(draft, parent, fork);
    uint64_t now = draft->place[parent].writes + 1;
    if (draft->place[view].seen == now)
        return;
    draft->place[view].seen = now;
    struct graph_draft_node *node = add_node(draft, GRAPH_NODE_VIEW, fork);
    add_use(draft, node, parent, true, false);
    add_use(draft, node, view, false, true);
}

static void draft_fork(struct graph_draft *draft, size_t i)
{
    const struct graph_record *record = draft->record;
    const struct graph_recorded_fork *fork = &record->fork[i];
    bool sets = fork->kernel == GRAPH_SETS;
    const duite_kernel *kernel = sets ? NULL : record->graph->kernels[fork->kernel];
    const uint32_t *object = record->use + fork->first;
    for (uint32_t k = 0; k < fork->n; k++) {
        if (graph_recorded_mode(record->graph, fork, k) != DUITE_CW ||
            draft->place[object[k]].law != data_law_of(kernel, k))
            close_sum(draft, object[k], i);
        gather_view(draft, object[k], i);
    }
    struct graph_draft_node *node = add_node(draft, sets ? GRAPH_NODE_SET : GRAPH_NODE, i);
    for (uint32_t k = 0; k < fork->n; k++) {
        duite_mode mode = graph_recorded_mode(record->graph, fork, k);
        draft->place[object[k]].writes += mode != DUITE_R;
        if (mode == DUITE_CW)
            add_use(draft, node, add_leaf(draft, object[k], data_law_of(kernel, k)), false, true);
        else
            add_use(draft, node, object[k], mode != DUITE_W, mode != DUITE_R);
    }
}

/* Contributions that are open at the end of a round are added there: no plan is made for rounds
 * that begin with contributions to the same object. */
static void draft_round(struct graph_draft *draft, size_t flag)
{
    size_t n = draft->record->n_forks;
    for (size_t i = 0; i < n; i++)
        draft_fork(draft, i);
    for (uint32_t i = 0; i < draft->record->n_objects; i++)
        close_sum(draft, i, n ? n - 1 : 0);
    if (draft->decides)
        add_use(draft, add_node(draft, GRAPH_NODE_FLAG, n ? n - 1 : 0), flag, true, false);
}

/* ---- Edges ---- */

/* From a node to the node `to`, both of two rounds. */
static void add_edge(struct graph_draft *draft, size_t from, size_t to)
{
    size_t n = draft->n_nodes;
    bool cyclic = from < n && to >= n;
    if (draft->mark[from] == to + 1 || (to >= n && !cyclic))
        return;
    draft->mark[from] = to + 1;
    void *moved =
        base_grow(draft->edge, &draft->edges_capacity, draft->n_edges + 1, sizeof *draft->edge);
    if (!moved) {
        draft->failed = true;
        return;
    }
    draft->edge = moved;
    draft->edge[draft->n_edges++] =
        (struct graph_draft_edge){(uint32_t)(from % n), (uint32_t)(to % n), cyclic};
    struct graph_draft_node *before = &draft->node[from % n], *after = &draft->node[to % n];
    before->n_next++;
    before->n_next_cyclic += cyclic;
    after->within += !cyclic;
    after->cyclic += cyclic;
}

static void read_place(struct graph_draft *draft, struct graph_draft_place *place, size_t node)
{
    if (place->writer)
        add_edge(draft, place->writer - 1, node);
    draft->reader[draft->n_readers] = (struct graph_draft_reader){node, place->reader};
    place->reader = ++draft->n_readers;
}

static void write_place(struct graph_draft *draft, struct graph_draft_place *place, size_t node)
{
    if (!place->reader && place->writer)
        add_edge(draft, place->writer - 1, node);
    for (size_t i = place->reader; i; i = draft->reader[i - 1].next)
        add_edge(draft, draft->reader[i - 1].node, node);
    place->reader = 0;
    place->writer = node + 1;
}

static void add_edges(struct graph_draft *draft)
{
    size_t n = draft->n_nodes, decider = draft->decides ? n - 1 : n;
    for (size_t to = 0; to < 2 * n; to++) {
        struct graph_draft_node *node = &draft->node[to % n];
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            struct graph_draft_place *place = &draft->place[draft->use[i].place];
            if (draft->use[i].writes)
                write_place(draft, place, to);
            else
                read_place(draft, place, to);
        }
        if (draft->decides && to == decider)
            for (size_t root = 0; root < decider; root++)
                if (!draft->node[root].within)
                    add_edge(draft, root, decider);
        if (to < n || node->within)
            continue;
        if (draft->decides)
            add_edge(draft, decider, to);
        else if (!node->cyclic) /* it conflicts with nothing: one round after the other */
            add_edge(draft, to - n, to);
    }
}

/* ---- The draft ---- */

void graph_draft_free(struct graph_draft *draft)
{
    base_free(draft->node);
    base_free(draft->use);
    base_free(draft->place);
    base_free(draft->reader);
    base_free(draft->mark);
    free(draft->edge);
}

bool graph_draft_make(struct graph_draft *draft, size_t n_objects, size_t flag)
{
    size_t n = draft->record->n_uses, nodes = draft->record->n_forks + 2 * n + 1, uses = 5 * n + 1;
    size_t places = n_objects + n;
    draft->n_places = draft->n_objects = n_objects;
    draft->node = base_alloc(nodes * sizeof *draft->node);
    draft->use = base_alloc(uses * sizeof *draft->use);
    draft->place = base_alloc_zero((places + 1) * sizeof *draft->place);
    if (!draft->node || !draft->use || !draft->place)
        return false;
    draft_round(draft, flag);
    draft->reader = base_alloc((2 * draft->n_uses + 1) * sizeof *draft->reader);
    draft->mark = base_alloc_zero((2 * draft->n_nodes + 1) * sizeof *draft->mark);
    if (!draft->reader || !draft->mark)
        return false;
    add_edges(draft);
    return !draft->failed;
}
