/* The nodes of a round on all hosts: those that the runtime's passes (plan/passes.h) give each rank
 * in a run, with the edges that they derive. The two ends of a message meet here: it is a node of
 * its sender, and the moment at which it has come is one of its receiver. */
#include "tools/predict/program.h"

#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"
#include "runtime/task/task.h"

#include <stdlib.h>

/* An end of a message. */
struct part_end {
    int from, to;
    uint32_t phase, node;
};

struct parting {
    const struct predict_graph *graph;
    const struct predict_recorded *recorded;
    struct predict_round *round;
    float *path;             /* by fork; NULL: the scheduler does not ask */
    struct part_end *end[2]; /* what comes, what goes: as many */
    size_t n_ends[2], capacity[2];
    bool failed;
};

/* An array has room for one more, or not for want of memory. False: p->failed, now or before. */
static bool part_grew(struct parting *p, bool grew)
{
    p->failed |= !grew;
    return !p->failed;
}

/* ---- Nodes ---- */

static uint32_t part_object(const struct parting *p, uint32_t object)
{
    return object < p->recorded->n_objects ? p->recorded->bound[object] : p->round->flag;
}

static uint64_t part_message_bytes(const struct parting *p, const struct plan_messages *m,
                                   uint32_t channel)
{
    const struct plan_message *message = &m->message[channel];
    uint64_t bytes = 0;
    for (size_t i = message->first; i; i = m->item[i - 1].next) {
        const struct plan_item *item = &m->item[i - 1];
        bytes +=
            item->version == PLAN_NONE
                ? p->round->source.bytes[item->object]
                : predict_bytes_to(p->graph, part_object(p, item->object), (uint32_t)message->to);
    }
    return bytes;
}

/* A merge takes the same time in each sum: see predict_sums_take. */
static struct predict_node part_node(const struct parting *p, const struct plan_messages *m,
                                     const struct plan_round_node *from)
{
    const uint32_t own = p->graph->run->n_kernels, host = (uint32_t)m->rank;
    const struct predict_fork *fork = &p->recorded->fork[from->fork];
    struct predict_node node = {.host = host, .block = host, .priority = INT32_MAX};
    switch (from->kind) {
    case PLAN_TASK:
        node.kind = PREDICT_TASK;
        node.kernel = fork->kernel;
        node.priority = fork->priority;
        node.cost = fork->cost;
        node.path = p->path ? p->path[from->fork] : 0;
        break;
    case PLAN_SUM:
        node.kernel = own + TASK_NODE_SUM;
        node.seconds = (float)(from->n_merges + 1);
        break;
    case PLAN_PARTIAL:
        node.kernel = own + TASK_NODE_PARTIAL;
        node.seconds = (float)from->n_merges;
        break;
    case PLAN_COPY:
        node.kernel = own + TASK_NODE_COPY;
        node.seconds = (float)p->graph->own[TASK_NODE_COPY];
        break;
    case PLAN_SEND:
        node.kind = PREDICT_MESSAGE;
        node.block = (uint32_t)from->peer;
        node.number = part_message_bytes(p, m, from->channel);
        break;
    default:
        node.kind = PREDICT_INSTANT;
    }
    return node;
}

static void part_end_note(struct parting *p, const struct plan_messages *m,
                          const struct plan_round_node *from)
{
    const bool sends = from->kind == PLAN_SEND;
    const int from_rank = sends ? m->rank : from->peer, to_rank = sends ? from->peer : m->rank;
    if (!part_grew(p, BASE_GROW(p->end[sends], p->capacity[sends], p->n_ends[sends] + 1)))
        return;
    p->end[sends][p->n_ends[sends]++] =
        (struct part_end){from_rank, to_rank, from->phase, (uint32_t)p->round->n_nodes};
}

static void part_node_add(struct parting *p, const struct plan_messages *m,
                          const struct plan_round_node *from)
{
    struct predict_round *round = p->round;
    if (from->kind == PLAN_SEND || from->kind == PLAN_RECEIVE)
        part_end_note(p, m, from);
    if (!part_grew(p, BASE_GROW(round->node, round->nodes_capacity, round->n_nodes + 1) &&
                          BASE_GROW(round->fork, round->forks_capacity, round->n_nodes + 1)))
        return;
    round->fork[round->n_nodes] = from->kind == PLAN_TASK ? from->fork : PREDICT_NONE;
    round->node[round->n_nodes++] = part_node(p, m, from);
}

static void part_edge_add(struct parting *p, uint32_t from, uint32_t to, bool cyclic)
{
    struct predict_round *round = p->round;
    if (from == to && !cyclic) /* a task that names an object twice */
        return;
    if (part_grew(p, BASE_GROW(round->edge, round->edges_capacity, round->n_edges + 1)))
        round->edge[round->n_edges++] = (struct plan_round_edge){from, to, cyclic};
}

/* The nodes of one host. */
static void part_add(struct parting *p, int host)
{
    const uint32_t base = (uint32_t)p->round->n_nodes;
    struct plan_messages m = {0};
    struct plan_round part = {0};
    p->failed |= !plan_messages_find(&m, &p->round->assignment, host) || !plan_part(&part, &m) ||
                 !plan_edges(&part);
    for (size_t i = 0; i < part.n_nodes && !p->failed; i++)
        part_node_add(p, &m, &part.node[i]);
    for (size_t i = 0; i < part.n_edges && !p->failed; i++)
        part_edge_add(p, base + part.edge[i].from, base + part.edge[i].to, part.edge[i].cyclic);
    plan_round_free(&part);
    plan_messages_free(&m);
}

/* ---- Messages ---- */

static int end_compare(const void *left, const void *right)
{
    const struct part_end *a = left, *b = right;
    if (a->phase != b->phase)
        return a->phase < b->phase ? -1 : 1;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return (a->to > b->to) - (a->to < b->to);
}

/* A message has a sender, a receiver and a phase, of which no two have all the same. */
static void part_ends_join(struct parting *p)
{
    for (int sends = 0; sends < 2; sends++)
        if (p->n_ends[sends])
            qsort(p->end[sends], p->n_ends[sends], sizeof **p->end, end_compare);
    for (size_t i = 0; i < p->n_ends[0]; i++)
        part_edge_add(p, p->end[1][i].node, p->end[0][i].node, false);
}

/* ---- All hosts ---- */

/* Finds the nodes that begin and end the round. */
static bool part_find_ends(struct predict_round *round)
{
    round->begins = base_alloc(round->n_nodes + 1);
    round->ends = base_alloc(round->n_nodes + 1);
    if (!round->begins || !round->ends)
        return false;
    for (size_t i = 0; i < round->n_nodes; i++)
        round->begins[i] = round->ends[i] = true;
    for (size_t i = 0; i < round->n_edges; i++) {
        round->begins[round->edge[i].to] &= round->edge[i].cyclic;
        round->ends[round->edge[i].from] &= round->edge[i].cyclic;
    }
    return true;
}

/* The scheduler's paths are those of the round of all ranks, as in a run. */
static void part_paths(struct parting *p)
{
    struct plan_round *lowered = &p->round->lowered;
    if (p->graph->cluster->scheduler->paths)
        p->failed |= !plan_edges(lowered) || !(p->path = plan_paths_find(lowered));
}

bool predict_parts_make(const struct predict_program *program,
                        const struct predict_recorded *recorded, struct predict_round *round)
{
    const struct plan_assignment *a = &round->assignment;
    struct parting p = {.graph = program->graph, .recorded = recorded, .round = round};
    uint64_t *hosts = base_alloc_zero(a->words * sizeof *hosts + 1);
    p.failed = !hosts;
    for (size_t n = 0; n < round->lowered.n_nodes && hosts; n++)
        base_ranks_join(hosts, plan_runs_set(a, n), a->words);
    part_paths(&p);
    for (int host = 0; host < a->n_ranks && !p.failed; host++)
        if (base_ranks_has(hosts, host))
            part_add(&p, host);
    part_ends_join(&p);
    base_free(hosts);
    base_free(p.path);
    free(p.end[0]);
    free(p.end[1]);
    return !p.failed && part_find_ends(round);
}

void predict_parts_free(struct predict_round *round)
{
    free(round->node);
    free(round->fork);
    free(round->edge);
    base_free(round->begins);
    base_free(round->ends);
}
