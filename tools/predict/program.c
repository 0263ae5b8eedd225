/* The main program once more: the predictor reads its words in order, and the code that gives homes
 * in a run gives them here. A slot of the trace stands for the last object that was made in it. */
#include "tools/predict/program.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/base/rank_set.h"

#include <math.h>
#include <stdlib.h>

/* s: of a message, and of a look at most, if not measured: in a host's memory. */
#define SOME_MESSAGE 5e-7
/* The cost of a fork on a rank that has no part in it, over that on a rank that runs it: 47 to 53
 * ms a step against 119 for cloth in 16,000 blocks, whose neighbours are partly on other ranks.
 * There, data about an object are never in the cache; where they always are, the ratio is a tenth.
 */
#define FOREIGN_FORK 0.40

/* ---- The main program ---- */

static bool op_is_everywhere(const struct predict_graph *graph, const struct predict_node *node)
{
    return node->kind == PREDICT_TASK && node->kernel < graph->run->n_kernels &&
           graph->run->kernel[node->kernel].replicated;
}

/* True if the main program takes time for the node: of a task that each host runs, for the first.
 */
static bool op_forks(const struct predict_graph *graph, const struct predict_node *node)
{
    return !node->host || !op_is_everywhere(graph, node);
}

/* An op for all nodes since the last one. Until op_end, `each` is the number of its forks. */
static struct predict_op *op_add(struct predict_program *p, bool forked)
{
    struct predict_graph *graph = p->graph;
    if (!predict_grew(graph, BASE_GROW(graph->op, graph->ops_capacity, graph->n_ops + 1)))
        return NULL;
    size_t begin = graph->n_ops ? graph->op[graph->n_ops - 1].end : 0;
    struct predict_op *op = &graph->op[graph->n_ops++];
    *op = (struct predict_op){.end = (uint32_t)graph->n_nodes, .node = PREDICT_NONE};
    for (size_t i = begin; i < graph->n_nodes && forked; i++)
        op->each += op_forks(graph, &graph->node[i]);
    p->forked += (uint64_t)op->each;
    return op;
}

void predict_op_replays(struct predict_program *p, bool begins)
{
    op_add(p, begins);
}

void predict_op_wait(struct predict_program *p)
{
    struct predict_op *last = op_add(p, true);
    if (last)
        last->waits = true;
}

/* The mean time of n forks, so many of them a rank's own, over that of one of its own. */
static double op_share(double own, double n)
{
    return n > 0 ? (own + FOREIGN_FORK * (n - own)) / n : 1;
}

/* Each host forks its own tasks and passes over others'. Returns the busiest one's time for each
 * node of an op, over that of a fork of its own on a core of the traced speed. */
static double op_busiest(struct predict_graph *graph, size_t op)
{
    const uint32_t begin = op ? graph->op[op - 1].end : 0, end = graph->op[op].end;
    const double forks = graph->op[op].each;
    uint32_t all = 0;
    for (uint32_t i = begin; i < end; i++) {
        const struct predict_node *node = &graph->node[i];
        const bool everywhere = op_is_everywhere(graph, node);
        all += everywhere && op_forks(graph, node);
        graph->count[node->host] += !everywhere && op_forks(graph, node);
    }
    double most = op_share(all, forks) / graph->slowest;
    const bool few = end - begin < graph->cluster->hosts;
    const uint32_t n = few ? end - begin : graph->cluster->hosts;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t host = few ? graph->node[begin + i].host : i;
        most = fmax(most, op_share(all + graph->count[host], forks) / predict_speed(graph, host));
    }
    for (uint32_t i = 0; i < n; i++)
        graph->count[few ? graph->node[begin + i].host : i] = 0;
    return most * forks / (end - begin);
}

/* The main program forked until `from`, and waits until `to`: each fork takes its share of the
 * time, in which the traced rank passed over those of others, too. */
static void op_end(struct predict_program *p, uint64_t from, uint64_t to, uint32_t node, bool waits)
{
    struct predict_graph *graph = p->graph;
    struct predict_op *last = op_add(p, true);
    if (!last)
        return;
    last->node = node;
    last->waits = waits;
    double tick = graph->run->rank[0].header->tick;
    double seconds = from > p->since ? tick * (double)(from - p->since) : 0;
    const double own = p->forked ? seconds / (double)p->forked : 0;
    for (size_t i = p->first_op; i < graph->n_ops; i++)
        if (graph->op[i].each > 0)
            graph->op[i].each = own / op_share(1, graph->run->n_ranks) * op_busiest(graph, i);
    p->first_op = graph->n_ops;
    p->forked = 0;
    p->since = to;
}

static void entry_get(struct predict_program *p)
{
    uint32_t own = predict_object_at(p, trace_words_next(&p->words));
    int rank = (int32_t)trace_words_next(&p->words);
    uint64_t from = trace_words_next2(&p->words), to = trace_words_next2(&p->words);
    if (p->damaged || p->words.short_of)
        return;
    const int host = rank % (int)p->graph->cluster->hosts;
    const uint32_t node = rank < 0 ? predict_prepare_all(p->graph, own, DUITE_R)
                                   : predict_prepare(p->graph, own, DUITE_R, host);
    op_end(p, from, to, node, host <= 0 && node != PREDICT_NONE);
}

/* The value is that of the begin, and on its way from then on. */
static void entry_get_begin(struct predict_program *p)
{
    const uint32_t number = trace_words_next(&p->words);
    const uint32_t own = predict_object_at(p, trace_words_next(&p->words));
    if (p->damaged || p->words.short_of)
        return;
    const uint32_t node = predict_prepare_all(p->graph, own, DUITE_R);
    if (predict_grew(p->graph, BASE_GROW(p->begun, p->begun_capacity, p->n_begun + 1)))
        p->begun[p->n_begun++] = (struct predict_begun){number, node};
}

/* A get that was begun before the trace waits for nothing. */
static void entry_get_end(struct predict_program *p)
{
    const uint32_t number = trace_words_next(&p->words);
    const uint64_t from = trace_words_next2(&p->words), to = trace_words_next2(&p->words);
    uint32_t node = PREDICT_NONE;
    for (size_t i = 0; i < p->n_begun; i++)
        if (p->begun[i].number == number) {
            node = p->begun[i].node;
            p->begun[i] = p->begun[--p->n_begun];
        }
    if (!p->words.short_of)
        op_end(p, from, to, node, node != PREDICT_NONE);
}

static void entry_wait(struct predict_program *p)
{
    uint64_t from = trace_words_next2(&p->words), to = trace_words_next2(&p->words);
    op_end(p, from, to, PREDICT_NONE, true);
}

/* Finds the values that last: their readers have them since before the trace. One walk over the
 * whole trace finds them, on one host, where nothing travels. */
static void lasting_find(struct predict_program *p)
{
    struct predict_graph *graph = p->graph;
    struct predict_cluster one = *graph->cluster;
    one.hosts = 1;
    one.platform = NULL;
    struct predict_graph whole = {.run = graph->run, .cluster = &one, .plain = true};
    p->code = predict_build(&whole);
    for (size_t i = 0; i < graph->n_objects && !p->code; i++)
        graph->object[i].lasts = !whole.object[i].written && whole.object[i].leaves == PREDICT_NONE;
    predict_graph_free(&whole);
}

/* The first part of a run that is traced may begin behind others. */
static void entry_switch(struct predict_program *p, bool on)
{
    const bool first = !p->forks && !p->tasks;
    p->forks = trace_words_next2(&p->words);
    trace_words_next2(&p->words);
    uint64_t now = trace_words_next2(&p->words);
    if (!on)
        op_end(p, now, now, PREDICT_NONE, true);
    else if (first && p->forks && p->graph->cluster->hosts > 1)
        lasting_find(p);
    p->since = now;
}

static void entry_read(struct predict_program *p)
{
    uint32_t first = trace_words_next(&p->words);
    size_t n = first >> 8; /* of things that have a word at least */
    if (n > trace_words_left(&p->words)) {
        p->damaged = true;
        return;
    }
    switch (first & 0xff) {
    case TRACE_OBJECT:
        predict_make(p);
        break;
    case TRACE_FREE:
        predict_drop(p);
        break;
    case TRACE_HINT:
        predict_hint(p, n);
        break;
    case TRACE_COLOCATE:
        predict_follow(p);
        break;
    case TRACE_HOMES:
        predict_homes(p, n);
        break;
    case TRACE_ON:
    case TRACE_OFF:
        entry_switch(p, (first & 0xff) == TRACE_ON);
        break;
    case TRACE_FORK:
    case TRACE_FORKED:
        predict_take_fork(p, n, (first & 0xff) == TRACE_FORKED);
        break;
    case TRACE_SET: {
        uint32_t own = predict_object_at(p, trace_words_next(&p->words));
        if (!p->damaged)
            predict_set(p->graph, own);
        break;
    }
    case TRACE_GET:
        entry_get(p);
        break;
    case TRACE_GET_BEGIN:
        entry_get_begin(p);
        break;
    case TRACE_GET_END:
        entry_get_end(p);
        break;
    case TRACE_WAIT:
        entry_wait(p);
        break;
    case TRACE_GRAPH:
        predict_take_graph(p, n);
        break;
    case TRACE_REPLAY:
        predict_replay(p, n);
        break;
    default:
        p->damaged = true;
    }
}

/* ---- All of it ---- */

static int program_walk(struct predict_program *p)
{
    struct predict_graph *graph = p->graph;
    while (trace_words_left(&p->words) && !p->damaged && !graph->failed && !p->code)
        entry_read(p);
    if (graph->failed)
        return base_no_memory("the graph of a trace");
    if (p->code)
        return p->code;
    if (p->damaged || p->words.short_of)
        return base_error(DUITE_E_ARGUMENT,
                          "the trace is damaged: word %zu of its program is invalid", p->words.at);
    if (!p->tasks)
        return base_error(DUITE_E_ARGUMENT, "the trace has no tasks of the main program");
    op_end(p, p->since, p->since, PREDICT_NONE, true);
    return graph->failed ? base_no_memory("the graph of a trace") : DUITE_OK;
}

/* Each task that ran left an event. In rounds that count at least one task in 16 ran; the others
 * were poisoned. The constant is for rounds without tasks. */
static uint64_t program_max_replayed(const struct trace_run *run)
{
    uint64_t n = 0;
    for (uint32_t r = 0; r < run->n_ranks; r++)
        n += run->rank[r].n_events;
    return 16 * n + 1000;
}

/* The cores' time between tasks and for messages: as the cluster says, else as in the trace. */
static void program_costs(struct predict_graph *graph, const struct predict_times *times)
{
    const struct predict_cluster *cluster = graph->cluster;
    const double gap = predict_times_gap(times);
    double message, look;
    const bool seen = predict_times_messages(times, &message, &look);
    for (uint32_t host = 0; host < cluster->hosts; host++) {
        struct predict_costs *costs = &graph->costs[host];
        const double speed = predict_speed(graph, host);
        costs->overhead = cluster->overhead < 0 ? gap / speed : cluster->overhead;
        costs->message = seen ? message / speed : SOME_MESSAGE;
        if (cluster->message >= 0)
            costs->message = cluster->message;
        costs->look = seen ? look / speed : fmin(costs->message, SOME_MESSAGE);
        if (cluster->look >= 0)
            costs->look = cluster->look;
        if (cluster->hosts == 1)
            costs->look = 0;
    }
}

/* The platform of the cluster, or the one that its numbers describe. */
static bool program_platform(struct predict_graph *graph)
{
    const struct predict_cluster *cluster = graph->cluster;
    const struct predict_place host = {.cores = cluster->cores,
                                       .speed = cluster->core_speed,
                                       .latency = cluster->latency,
                                       .bandwidth = cluster->bandwidth,
                                       .capacity = INFINITY};
    graph->platform = cluster->platform ? cluster->platform : &graph->flat;
    if (!cluster->platform &&
        !predict_platform_flat(&graph->flat, cluster->hosts, &host, cluster->capacity))
        return false;
    graph->slowest = INFINITY;
    for (uint32_t h = 0; h < cluster->hosts; h++)
        graph->slowest = fmin(graph->slowest, predict_speed(graph, h));
    return true;
}

/* All nodes are there: their seconds become those of the cores of their hosts. */
static void program_pace(struct predict_graph *graph)
{
    for (size_t i = 0; i < graph->n_nodes; i++) {
        struct predict_node *node = &graph->node[i];
        node->seconds = (float)((double)node->seconds / predict_speed(graph, node->host));
    }
}

static bool program_prepare(struct predict_program *p)
{
    struct predict_graph *graph = p->graph;
    const uint32_t hosts = graph->cluster->hosts;
    p->times = predict_times_new(graph->run, graph->cluster->steady);
    const struct base_array arrays[] = {BASE_ARRAY(graph->began, hosts),
                                        BASE_ZEROS(graph->count, hosts),
                                        BASE_ARRAY(graph->over, hosts),
                                        BASE_ZEROS(graph->all, base_ranks_words((int)hosts)),
                                        BASE_ZEROS(p->blocks_on, hosts),
                                        BASE_ARRAY(graph->costs, hosts),
                                        {0}};
    graph->memory = base_arrays(arrays);
    graph->round = PREDICT_NONE;
    if (!p->times || !graph->memory || !program_platform(graph) ||
        data_table_start(&p->table, graph->cluster->mapping ? (int)hosts : 1) ||
        !predict_moves_start(p))
        return false;
    for (uint32_t host = 0; host < hosts; host++)
        base_ranks_add(graph->all, (int)host);
    for (uint32_t kind = 0; kind < sizeof graph->own / sizeof graph->own[0]; kind++)
        graph->own[kind] = predict_times_own(p->times, kind);
    program_costs(graph, p->times);
    predict_times_spread(p->times, &graph->bodies, &graph->medians);
    return true;
}

int predict_build(struct predict_graph *graph)
{
    struct predict_program p = {.graph = graph,
                                .words = trace_words_of(graph->run),
                                .max_replayed = program_max_replayed(graph->run)};
    int code = program_prepare(&p) ? program_walk(&p) : base_no_memory("the graph of a trace");
    graph->n_tasks = p.tasks;
    if (!code && graph->merges > 0)
        predict_sums_take(graph, predict_times_sums(p.times) / graph->merges);
    if (!code)
        program_pace(graph);
    predict_moves_stop(&p);
    data_table_stop(&p.table);
    free(p.block);
    predict_times_free(p.times);
    predict_graphs_free(&p);
    free(p.slot);
    free(p.begun);
    free(p.name);
    free(p.prepared);
    free(p.objects);
    return code;
}
