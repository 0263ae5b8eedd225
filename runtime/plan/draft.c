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
#include "runtime/plan/draft.h"
#include "runtime/task/internal.h"

#include "runtime/base/memory.h"

#include <stdlib.h>

/* ---- The nodes of a round ---- */

struct plan_draft_node *plan_draft_node(struct plan_draft *draft, enum task_type kind, size_t fork)
{
    struct plan_draft_node *node = &draft->node[draft->n_nodes++];
    *node = (struct plan_draft_node){.kind = kind,
                                     .fork = (uint32_t)fork,
                                     .first_use = draft->n_uses,
                                     .first_merge = draft->n_merges};
    return node;
}

void plan_draft_use(struct plan_draft *draft, struct plan_draft_node *node, size_t place,
                    bool reads, bool writes)
{
    draft->use[draft->n_uses++] = (struct plan_node_use){(uint32_t)place, reads, writes};
    node->n_uses++;
}

void plan_draft_merge(struct plan_draft *draft, struct plan_draft_node *node, size_t left,
                      size_t right)
{
    draft->merge[draft->n_merges++] = (struct plan_merge){(uint32_t)left, (uint32_t)right};
    node->n_merges++;
}

/* The two halves of one complete subtree? */
static bool siblings(const struct plan_draft_piece *l, const struct plan_draft_piece *r)
{
    uint64_t half = UINT64_C(1) << l->level;
    return l->level == r->level && l->first + half == r->first && l->first % (2 * half) == 0;
}

size_t plan_draft_push(struct plan_draft *draft, struct plan_draft_node *node,
                       struct plan_draft_piece *piece, size_t n)
{
    for (n++; n > 1 && siblings(&piece[n - 2], &piece[n - 1]); n--) {
        plan_draft_merge(draft, node, piece[n - 2].param, piece[n - 1].param);
        piece[n - 2].level++;
    }
    return n;
}

void plan_draft_fold(struct plan_draft *draft, struct plan_draft_node *node,
                     const struct plan_draft_piece *piece, size_t n)
{
    for (size_t i = n; i-- > 1;)
        plan_draft_merge(draft, node, piece[i - 1].param, piece[i].param);
}

/* A buffer for a contribution, and its place in the row of those that are open. */
static size_t add_leaf(struct plan_draft *draft, uint32_t object, const duite_law *law)
{
    struct plan_draft_place *whole = &draft->place[object];
    size_t leaf = draft->n_places++;
    draft->place[leaf] = (struct plan_draft_place){.object = object, .law = law};
    whole->law = law;
    if (whole->n_open++)
        draft->place[whole->last].next = (uint32_t)leaf;
    else
        whole->first = (uint32_t)leaf;
    whole->last = (uint32_t)leaf;
    return leaf;
}

static void close_sum(struct plan_draft *draft, uint32_t object, size_t fork)
{
    struct plan_draft_place *whole = &draft->place[object];
    if (!whole->n_open)
        return;
    struct plan_draft_node *node = plan_draft_node(draft, TASK_NODE_SUM, fork);
    struct plan_draft_piece piece[64]; /* a counter's bits */
    size_t n = 0;
    node->law = whole->law;
    plan_draft_use(draft, node, object, true, true);
    for (uint32_t leaf = whole->first, i = 0; whole->n_open; leaf = draft->place[leaf].next, i++) {
        plan_draft_use(draft, node, leaf, true, false);
        whole->n_open--;
        piece[n] = (struct plan_draft_piece){.first = i, .param = i + 1};
        if (draft->merge)
            n = plan_draft_push(draft, node, piece, n);
    }
    plan_draft_fold(draft, node, piece, n);
}

/* A view of an object that nobody writes is gathered before the replay. */
static void gather_view(struct plan_draft *draft, uint32_t view, size_t fork)
{
    const struct plan_recorded_object *objects = draft->record->object;
    if (!plan_recorded_gathers(objects, &objects[view]))
        return;
    uint32_t parent = objects[view].parent - 1;
    close_sum(draft, parent, fork);
    uint64_t now = draft->place[parent].writes + 1;
    if (draft->place[view].seen == now)
        return;
    draft->place[view].seen = now;
    struct plan_draft_node *node = plan_draft_node(draft, TASK_NODE_VIEW, fork);
    plan_draft_use(draft, node, parent, true, false);
    plan_draft_use(draft, node, view, false, true);
}

static void draft_fork(struct plan_draft *draft, size_t i)
{
    const struct plan_record *record = draft->record;
    const struct plan_recorded_fork *fork = &record->fork[i];
    bool sets = fork->kernel == PLAN_SETS;
    const duite_kernel *kernel = sets ? NULL : record->graph->kernels[fork->kernel];
    const uint32_t *object = record->use + fork->first;
    for (uint32_t k = 0; k < fork->n; k++) {
        if (plan_recorded_mode(record->graph, fork, k) != DUITE_CW ||
            draft->place[object[k]].law != data_law_of(kernel, k))
            close_sum(draft, object[k], i);
        gather_view(draft, object[k], i);
    }
    struct plan_draft_node *node = plan_draft_node(draft, sets ? TASK_NODE_SET : TASK_NODE, i);
    for (uint32_t k = 0; k < fork->n; k++) {
        duite_mode mode = plan_recorded_mode(record->graph, fork, k);
        draft->place[object[k]].writes += mode != DUITE_R;
        if (mode == DUITE_CW)
            plan_draft_use(draft, node, add_leaf(draft, object[k], data_law_of(kernel, k)), false,
                           true);
        else
            plan_draft_use(draft, node, object[k], mode != DUITE_W, mode != DUITE_R);
    }
}

/* Contributions that are open at the end of a round are added there: no plan is made for rounds
 * that begin with contributions to the same object. */
static void draft_nodes(struct plan_draft *draft, size_t flag)
{
    size_t n = draft->record->n_forks;
    for (size_t i = 0; i < n; i++)
        draft_fork(draft, i);
    for (uint32_t i = 0; i < draft->record->n_objects; i++)
        close_sum(draft, i, n ? n - 1 : 0);
    if (draft->decides)
        plan_draft_use(draft, plan_draft_node(draft, TASK_NODE_FLAG, n ? n - 1 : 0), flag, true,
                       false);
}

/* ---- Edges ---- */

/* From a node to the node `to`, both of two rounds. */
static void add_edge(struct plan_draft *draft, size_t from, size_t to)
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
        (struct plan_draft_edge){(uint32_t)(from % n), (uint32_t)(to % n), cyclic};
    struct plan_draft_node *before = &draft->node[from % n], *after = &draft->node[to % n];
    before->n_next++;
    before->n_next_cyclic += cyclic;
    after->within += !cyclic;
    after->cyclic += cyclic;
}

static void read_place(struct plan_draft *draft, struct plan_draft_place *place, size_t node)
{
    if (place->writer)
        add_edge(draft, place->writer - 1, node);
    draft->reader[draft->n_readers] = (struct plan_draft_reader){node, place->reader};
    place->reader = ++draft->n_readers;
}

static void write_place(struct plan_draft *draft, struct plan_draft_place *place, size_t node)
{
    if (!place->reader && place->writer)
        add_edge(draft, place->writer - 1, node);
    for (size_t i = place->reader; i; i = draft->reader[i - 1].next)
        add_edge(draft, draft->reader[i - 1].node, node);
    place->reader = 0;
    place->writer = node + 1;
}

static void add_edges(struct plan_draft *draft)
{
    size_t n = draft->n_nodes, decider = draft->decides ? n - 1 : n;
    for (size_t to = 0; to < 2 * n; to++) {
        struct plan_draft_node *node = &draft->node[to % n];
        for (size_t i = node->first_use; i < node->first_use + node->n_uses; i++) {
            struct plan_draft_place *place = &draft->place[draft->use[i].place];
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

void plan_draft_free(struct plan_draft *draft)
{
    base_free(draft->node);
    base_free(draft->use);
    base_free(draft->place);
    base_free(draft->reader);
    base_free(draft->mark);
    base_free(draft->merge);
    base_free(draft->channel);
    base_free(draft->path);
    free(draft->edge);
}

bool plan_draft_room(struct plan_draft *draft, size_t nodes, size_t uses, size_t places,
                     size_t merges, size_t channels)
{
    draft->node = base_alloc((nodes + 1) * sizeof *draft->node);
    draft->use = base_alloc((uses + 1) * sizeof *draft->use);
    draft->place = base_alloc_zero((places + 1) * sizeof *draft->place);
    draft->channel = base_alloc((channels + 1) * sizeof *draft->channel);
    if (merges)
        draft->merge = base_alloc(merges * sizeof *draft->merge);
    return draft->node && draft->use && draft->place && draft->channel && (!merges || draft->merge);
}

bool plan_draft_round(struct plan_draft *draft, size_t n_objects, size_t flag)
{
    size_t n = draft->record->n_uses;
    bool whole = draft->record->graph->n_ranks == 1;
    draft->n_places = draft->n_objects = n_objects;
    if (!plan_draft_room(draft, draft->record->n_forks + 2 * n + 1, 5 * n + 1, n_objects + n,
                         whole ? n + 1 : 0, 0))
        return false;
    draft_nodes(draft, flag);
    return true;
}

bool plan_draft_edges(struct plan_draft *draft)
{
    draft->reader = base_alloc((2 * draft->n_uses + 1) * sizeof *draft->reader);
    draft->mark = base_alloc_zero((2 * draft->n_nodes + 1) * sizeof *draft->mark);
    if (!draft->reader || !draft->mark)
        return false;
    add_edges(draft);
    return !draft->failed;
}

bool plan_draft_make(struct plan_draft *draft, size_t n_objects, size_t flag)
{
    return plan_draft_round(draft, n_objects, flag) && plan_draft_edges(draft);
}
