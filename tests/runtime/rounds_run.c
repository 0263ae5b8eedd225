/* The reference and the run keep to one rule for values: what a task writes is a number made of all
 * that it read, its round and its place. So equal numbers mean equal histories. */
#include "tests/runtime/rounds_run.h"

#include <duite_policy.h>

#include <check.h>
#include <stdlib.h>

static uint64_t mix(uint64_t a, uint64_t b)
{
    uint64_t state = a * 0x9e3779b97f4a7c15u + b;
    return duite_random(&state);
}

/* ---- The reference ---- */

uint64_t initial(uint32_t object)
{
    return mix(17, object);
}

static uint64_t combine(uint64_t left, uint64_t right)
{
    return mix(mix(7, left), right);
}

/* Leaves first .. first + n - 1: the largest complete subtree, and the rest. */
static uint64_t tree(const uint64_t *leaf, size_t n)
{
    size_t half = 1;
    if (n == 1)
        return leaf[0];
    while (2 * half < n)
        half *= 2;
    return combine(tree(leaf, half), tree(leaf + half, n - half));
}

static void reference_sum(struct reference *r, uint32_t object)
{
    if (r->n_open[object])
        r->value[object] = combine(r->value[object], tree(r->open[object], r->n_open[object]));
    r->n_open[object] = 0;
}

static void reference_fork(struct reference *r, int round, size_t i)
{
    const struct plan_source_fork *fork = &r->source->fork[i];
    const struct plan_access *access = r->source->access + fork->first;
    uint64_t found = i;
    for (uint32_t k = 0; k < fork->n; k++) {
        uint32_t object = access[k].object;
        if (access[k].mode != DUITE_CW || access[k].law != r->law[object])
            reference_sum(r, object);
    }
    for (uint32_t k = 0; k < fork->n; k++)
        if (access[k].mode == DUITE_R || access[k].mode == DUITE_RW)
            found = mix(found, r->value[access[k].object]);
    for (uint32_t k = 0; k < fork->n; k++) {
        uint32_t object = access[k].object;
        if (access[k].mode == DUITE_CW) {
            r->open[object][r->n_open[object]++] = mix(found, k);
            r->law[object] = access[k].law;
        } else if (access[k].mode != DUITE_R) {
            r->value[object] = mix(found, k);
        }
    }
    r->found[round][i] = found;
}

void reference_run(struct reference *r, const struct plan_source *source)
{
    *r = (struct reference){.source = source};
    for (uint32_t i = 0; i < source->n_objects; i++)
        r->value[i] = initial(i);
    for (int round = 0; round < ROUNDS; round++) {
        for (size_t i = 0; i < source->n_forks; i++)
            reference_fork(r, round, i);
        for (uint32_t i = 0; i < source->n_objects; i++)
            reference_sum(r, i);
    }
}

/* ---- Running what the passes left ---- */

/* From a rank to another in a phase. */
static struct queue *queue_of(struct run *run, int from, int to, uint32_t phase)
{
    ck_assert_uint_lt(phase, PHASES);
    return &run->queue[from][to][phase];
}

static struct queue *queue_of_node(struct run *run, int at, const struct plan_round_node *node)
{
    return node->kind == PLAN_SEND ? queue_of(run, at, node->peer, node->phase)
                                   : queue_of(run, node->peer, at, node->phase);
}

static void run_message(struct run *run, int at, const struct plan_round_node *node)
{
    struct rank *rank = &run->rank[at];
    struct queue *queue = queue_of_node(run, at, node);
    if (node->kind == PLAN_SEND)
        ck_assert_uint_le(queue->last + node->n_uses, QUEUE);
    for (size_t i = 0; i < node->n_uses; i++) {
        uint64_t *value = &rank->value[rank->part.use[node->first_use + i].place];
        if (node->kind == PLAN_SEND)
            queue->value[queue->last++] = *value;
        else
            *value = queue->value[queue->first++];
    }
    queue->messages += node->kind == PLAN_SEND ? 1 : (size_t)-1;
}

static void run_task(struct run *run, struct rank *rank, const struct plan_round_node *node,
                     uint32_t round)
{
    const struct plan_node_use *use = &rank->part.use[node->first_use];
    uint64_t found = node->fork;
    for (size_t i = 0; i < node->n_uses; i++)
        if (use[i].reads)
            found = mix(found, rank->value[use[i].place]);
    ck_assert_msg(found == run->reference->found[round][node->fork],
                  "fork %u found something else in round %u", node->fork, round);
    for (size_t i = 0; i < node->n_uses; i++)
        if (use[i].writes)
            rank->value[use[i].place] = mix(found, i);
    run->tasks++;
}

static void run_sum(struct rank *rank, const struct plan_round_node *node)
{
    const struct plan_node_use *use = &rank->part.use[node->first_use];
    for (size_t i = 0; i < node->n_merges; i++) {
        const struct plan_merge *merge = &rank->part.merge[node->first_merge + i];
        uint64_t *left = &rank->value[use[merge->left].place];
        *left = combine(*left, rank->value[use[merge->right].place]);
    }
    if (node->kind == PLAN_SUM)
        rank->value[use[0].place] = combine(rank->value[use[0].place], rank->value[use[1].place]);
}

static void run_node(struct run *run, int at, size_t n)
{
    struct rank *rank = &run->rank[at];
    const struct plan_round_node *node = &rank->part.node[n];
    const struct plan_node_use *use = &rank->part.use[node->first_use];
    switch (node->kind) {
    case PLAN_TASK:
    case PLAN_SET:
        run_task(run, rank, node, rank->over[n]);
        break;
    case PLAN_SUM:
    case PLAN_PARTIAL:
        run_sum(rank, node);
        break;
    case PLAN_COPY:
        rank->value[use[1].place] = rank->value[use[0].place];
        break;
    case PLAN_FLAG:
        break;
    default:
        run_message(run, at, node);
    }
}

/* A node's counter goes back to steady before its successors hear of it, as in a replay. */
static void run_finish(struct run *run, int at, size_t n)
{
    struct rank *rank = &run->rank[at];
    bool last = ++rank->over[n] == ROUNDS;
    rank->pending[n] = rank->part.node[n].within + rank->part.node[n].cyclic;
    for (size_t i = 0; i < rank->part.n_edges; i++) {
        const struct plan_round_edge *edge = &rank->part.edge[i];
        if (edge->from != n || (edge->cyclic && last))
            continue;
        ck_assert_msg(rank->pending[edge->to], "node %u hears of a round too early", edge->to);
        rank->pending[edge->to]--;
    }
}

static bool run_is_ready(struct run *run, int at, size_t n)
{
    const struct rank *rank = &run->rank[at];
    const struct plan_round_node *node = &rank->part.node[n];
    return !rank->pending[n] && rank->over[n] < ROUNDS &&
           (node->kind != PLAN_RECEIVE || queue_of_node(run, at, node)->messages);
}

/* Runs one node that is ready; false: none is. */
static bool run_one(struct run *run)
{
    int first = (int)draw(&run->random, (uint64_t)run->n_ranks);
    for (int r = 0; r < run->n_ranks; r++) {
        int at = (first + r) % run->n_ranks;
        size_t n = run->rank[at].part.n_nodes, from = n ? draw(&run->random, n) : 0;
        for (size_t i = 0; i < n; i++) {
            size_t node = (from + i) % n;
            if (!run_is_ready(run, at, node))
                continue;
            run_node(run, at, node);
            run_finish(run, at, node);
            return true;
        }
    }
    return false;
}

static void rank_begin(struct rank *rank)
{
    size_t n = rank->part.n_nodes;
    ck_assert_uint_le(rank->part.n_places, PLACES);
    rank->pending = calloc(n + 1, sizeof *rank->pending);
    rank->over = calloc(n + 1, sizeof *rank->over);
    for (size_t i = 0; i < n; i++)
        rank->pending[i] = rank->part.node[i].within;
}

void run_all(struct run *run, int rounds_of)
{
    for (int r = 0; r < run->n_ranks; r++)
        rank_begin(&run->rank[r]);
    while (run_one(run))
        ;
    for (int r = 0; r < run->n_ranks; r++) {
        for (size_t n = 0; n < run->rank[r].part.n_nodes; n++)
            ck_assert_msg(run->rank[r].over[n] == (uint32_t)rounds_of,
                          "node %zu of rank %d is stuck in round %u", n, r, run->rank[r].over[n]);
        free(run->rank[r].pending);
        free(run->rank[r].over);
    }
}
