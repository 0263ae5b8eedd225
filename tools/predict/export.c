/* Writes the tasks of a trace, by the traced homes. For Graphviz each has the tasks that it waited
 * for; in a graph file, in fork order, the tasks whose results it reads. */
#include "tools/predict/graph.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"
#include "runtime/sched/sched.h"
#include "runtime/task/task.h"

#include <inttypes.h>
#include <math.h>

/* ---- Graphviz ---- */

static void dot_name(FILE *file, const char *name)
{
    for (; *name; name++)
        fprintf(file, *name == '"' || *name == '\\' ? "\\%c" : "%c", *name);
}

static void dot_node(const struct predict_graph *graph, size_t i, FILE *file)
{
    const struct predict_node *node = &graph->node[i];
    const struct trace_run *run = graph->run;
    fprintf(file, "  n%zu [", i);
    switch (node->kind) {
    case PREDICT_TASK:
        fputs("label=\"", file);
        dot_name(file, node->kernel < run->n_kernels
                           ? run->kernel_name[node->kernel]
                           : task_own_name(node->kernel - run->n_kernels));
        if (node->number)
            fprintf(file, " %" PRIu64, node->number);
        fprintf(file, "\\nrank %" PRIu32, node->host);
        fprintf(file, "\\n%.3f us\"", 1e6 * (double)node->seconds);
        break;
    case PREDICT_MESSAGE:
        fprintf(file, "shape=ellipse,label=\"%" PRIu32 " to %" PRIu32 "\\n%" PRIu64 " bytes\"",
                node->host, node->block, node->number);
        break;
    default:
        fputs("shape=point", file);
    }
    fputs("];\n", file);
}

int predict_write_dot(const struct trace_run *run, FILE *file)
{
    const struct predict_cluster cluster = {.hosts = run->n_ranks,
                                            .cores = 1,
                                            .bandwidth = INFINITY,
                                            .capacity = INFINITY,
                                            .core_speed = 1,
                                            .scheduler = &sched_steal};
    struct predict_graph graph = {.run = run, .cluster = &cluster};
    int code = predict_check(run, &cluster);
    if (!code)
        code = predict_build(&graph);
    if (!code) {
        fputs("digraph tasks {\n  node [shape=box];\n", file);
        for (size_t i = 0; i < graph.n_nodes; i++)
            dot_node(&graph, i, file);
        for (size_t i = 0; i < graph.n_nodes; i++)
            for (uint32_t e = graph.node[i].edge; e != PREDICT_NONE; e = graph.edge[e].next)
                fprintf(file, "  n%zu -> n%" PRIu32 ";\n", i, graph.edge[e].to);
        fputs("}\n", file);
    }
    predict_graph_free(&graph);
    return code;
}

/* ---- Graph files: the bytes of a task are those that other tasks read; tasks of one block share a
 * place ---- */

struct rows {
    uint32_t *line;  /* by node: of its task in the file, or NONE */
    size_t *start;   /* by line, plus 1 */
    uint32_t *reads; /* lines, each once in a row */
    uint32_t *seen;  /* by line: the last one that was found to read it, plus 1 */
    uint32_t *place; /* by block, or NONE: it has no line yet */
    void *memory;    /* of these arrays */
    uint32_t n, n_places;
};

static bool line_is_task(const struct predict_node *node)
{
    return node->kind == PREDICT_TASK;
}

static bool rows_room(struct rows *rows, const struct predict_graph *graph)
{
    const size_t nodes = graph->n_nodes + 2;
    const struct base_array arrays[] = {BASE_ARRAY(rows->line, nodes),
                                        BASE_ZEROS(rows->start, nodes),
                                        BASE_ARRAY(rows->reads, graph->n_edges + 1),
                                        BASE_ZEROS(rows->seen, nodes),
                                        BASE_ARRAY(rows->place, graph->n_objects + 1),
                                        {0}};
    return (rows->memory = base_arrays(arrays)) != NULL;
}

/* Edges are kept where they begin; rows where they end. */
static void rows_transpose(const struct predict_graph *graph, struct rows *rows)
{
    for (size_t i = 0; i < graph->n_nodes; i++)
        rows->line[i] = line_is_task(&graph->node[i]) ? rows->n++ : PREDICT_NONE;
    for (int fill = 0; fill < 2; fill++) {
        for (size_t i = 0; i < graph->n_nodes; i++) {
            if (rows->line[i] == PREDICT_NONE)
                continue;
            for (uint32_t e = graph->node[i].edge; e != PREDICT_NONE; e = graph->edge[e].next) {
                uint32_t to = rows->line[graph->edge[e].to];
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

static size_t row_unique(struct rows *rows, uint32_t line)
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
static void row_put_place(const struct predict_graph *graph, struct rows *rows, uint32_t block,
                          FILE *file)
{
    if (block >= graph->n_objects)
        return;
    if (rows->place[block] == PREDICT_NONE)
        rows->place[block] = rows->n_places++;
    fprintf(file, " @ %" PRIu32, rows->place[block]);
}

static void rows_put(const struct predict_graph *graph, struct rows *rows, FILE *file)
{
    fputs("duite-graph 1\n", file);
    for (size_t b = 0; b < graph->n_objects; b++)
        rows->place[b] = PREDICT_NONE;
    for (size_t i = 0; i < graph->n_nodes; i++) {
        const struct predict_node *node = &graph->node[i];
        uint32_t line = rows->line[i];
        if (line == PREDICT_NONE)
            continue;
        size_t n = row_unique(rows, line);
        fprintf(file, "%.9g %.0f %zu", (double)node->seconds,
                fmin((double)graph->shown[i], (double)UINT32_MAX), n);
        for (size_t k = 0; k < n; k++)
            fprintf(file, " %" PRIu32, rows->reads[rows->start[line] + k]);
        row_put_place(graph, rows, node->block, file);
        fputc('\n', file);
    }
}

int predict_write_graph(const struct trace_run *run, FILE *file)
{
    struct predict_graph graph;
    struct rows rows = {0};
    int code = predict_build_plain(&graph, run);
    if (!code && !rows_room(&rows, &graph))
        code = base_no_memory("the graph of a trace");
    if (!code) {
        rows_transpose(&graph, &rows);
        rows_put(&graph, &rows, file);
    }
    base_free(rows.memory);
    predict_graph_free(&graph);
    return code;
}
