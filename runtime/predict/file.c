/* The tasks as a graph file: who reads whose result, in fork order. What a task shows to others is
 * its bytes, and its block stays together, as what it keeps for itself does. */
#include "runtime/predict/graph.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/map/map.h"
#include "runtime/sched/sched.h"

#include <inttypes.h>
#include <math.h>

struct rows {
    uint32_t *line;  /* by node: of its task in the file, or NONE */
    size_t *start;   /* by line, plus 1 */
    uint32_t *reads; /* lines, each once in a row */
    uint32_t *seen;  /* by line: the last one that was found to read it, plus 1 */
    uint32_t *place; /* by block, or NONE: it has no line yet */
    uint32_t n, n_places;
};

static bool is_task(const struct predict_node *node)
{
    return node->kind == PREDICT_TASK;
}

static bool allocate(struct rows *rows, const struct predict_graph *graph)
{
    rows->line = base_alloc((graph->n_nodes + 1) * sizeof *rows->line);
    rows->start = base_alloc_zero((graph->n_nodes + 2) * sizeof *rows->start);
    rows->reads = base_alloc((graph->n_edges + 1) * sizeof *rows->reads);
    rows->seen = base_alloc_zero((graph->n_nodes + 1) * sizeof *rows->seen);
    rows->place = base_alloc((graph->n_objects + 1) * sizeof *rows->place);
    return rows->place && rows->line && rows->start && rows->reads && rows->seen;
}

static void release(struct rows *rows)
{
    base_free(rows->line);
    base_free(rows->start);
    base_free(rows->reads);
    base_free(rows->seen);
    base_free(rows->place);
}

/* The line that an edge leads to, from a task that is read; NONE: another kind of edge. */
static uint32_t reader(const struct predict_graph *graph, const struct rows *rows, uint32_t edge)
{
    return graph->edge[edge].reads ? rows->line[graph->edge[edge].to] : PREDICT_NONE;
}

/* Edges are kept where they begin; rows where they end. */
static void turn(const struct predict_graph *graph, struct rows *rows)
{
    for (size_t i = 0; i < graph->n_nodes; i++)
        rows->line[i] = is_task(&graph->node[i]) ? rows->n++ : PREDICT_NONE;
    for (int fill = 0; fill < 2; fill++) {
        for (size_t i = 0; i < graph->n_nodes; i++) {
            if (rows->line[i] == PREDICT_NONE)
                continue;
            for (uint32_t e = graph->node[i].edge; e != PREDICT_NONE; e = graph->edge[e].next) {
                uint32_t to = reader(graph, rows, e);
                if (to == PREDICT_NONE)
                    continue;
                if (fill)
                    rows->reads[rows->start[to + 1]++] = rows->line[i];
                else
                    rows->start[to + 2]++;
            }
        }
        for (uint32_t i = 0; i < rows->n && !fill; i++)
            rows->start[i + 2] += rows->start[i + 1];
    }
}

static size_t count_row(struct rows *rows, uint32_t line)
{
    size_t n = 0;
    for (size_t k = rows->start[line]; k < rows->start[line + 1]; k++) {
        if (rows->seen[rows->reads[k]] == line + 1)
            continue;
        rows->seen[rows->reads[k]] = line + 1;
        rows->reads[rows->start[line] + n++] = rows->reads[k];
    }
    return n;
}

/* Blocks are fewer than objects; a task that has none has its own number. */
static void put_place(const struct predict_graph *graph, struct rows *rows, uint32_t block,
                      FILE *file)
{
    if (block >= graph->n_objects)
        return;
    if (rows->place[block] == PREDICT_NONE)
        rows->place[block] = rows->n_places++;
    fprintf(file, " @ %" PRIu32, rows->place[block]);
}

static void put(const struct predict_graph *graph, struct rows *rows, FILE *file)
{
    fputs("duite-graph 1\n", file);
    for (size_t b = 0; b < graph->n_objects; b++)
        rows->place[b] = PREDICT_NONE;
    for (size_t i = 0; i < graph->n_nodes; i++) {
        const struct predict_node *node = &graph->node[i];
        uint32_t line = rows->line[i];
        if (line == PREDICT_NONE)
            continue;
        size_t n = count_row(rows, line);
        fprintf(file, "%.9g %.0f %zu", (double)node->seconds,
                fmin((double)graph->shown[i], (double)UINT32_MAX), n);
        for (size_t k = 0; k < n; k++)
            fprintf(file, " %" PRIu32, rows->reads[rows->start[line] + k]);
        put_place(graph, rows, node->block, file);
        fputc('\n', file);
    }
}

int predict_write_graph(const struct trace_run *run, FILE *file)
{
    const struct predict_cluster cluster = {.hosts = 1,
                                            .cores = 1,
                                            .bandwidth = INFINITY,
                                            .capacity = INFINITY,
                                            .core_speed = 1,
                                            .mapping = &map_block,
                                            .scheduler = &sched_steal};
    struct predict_graph graph = {.run = run, .cluster = &cluster, .plain = true};
    struct rows rows = {0};
    int code = predict_check(run, &cluster);
    if (!code)
        code = predict_build(&graph);
    if (!code && !allocate(&rows, &graph))
        code = base_no_memory("the graph of a trace");
    if (!code) {
        turn(&graph, &rows);
        put(&graph, &rows, file);
    }
    release(&rows);
    predict_graph_free(&graph);
    return code;
}
