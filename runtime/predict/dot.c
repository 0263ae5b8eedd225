/* The tasks that ran as a graph of Graphviz: what each waited for, on the ranks on which it ran. */
#include "runtime/predict/graph.h"

#include "runtime/sched/sched.h"
#include "runtime/task/task.h"

#include <inttypes.h>
#include <math.h>

static void put_name(FILE *file, const char *name)
{
    for (; *name; name++)
        fprintf(file, *name == '"' || *name == '\\' ? "\\%c" : "%c", *name);
}

static void put_node(const struct predict_graph *graph, size_t i, FILE *file)
{
    const struct predict_node *node = &graph->node[i];
    const struct trace_run *run = graph->run;
    fprintf(file, "  n%zu [", i);
    switch (node->kind) {
    case PREDICT_TASK:
    case PREDICT_EVERYWHERE:
        fputs("label=\"", file);
        put_name(file, node->kernel < run->n_kernels
                           ? run->kernel_name[node->kernel]
                           : task_own_name(node->kernel - run->n_kernels));
        if (node->number)
            fprintf(file, " %" PRIu64, node->number);
        if (node->kind == PREDICT_TASK)
            fprintf(file, "\\nrank %" PRIu32, node->host);
        else
            fputs("\\nevery rank", file);
        fprintf(file, "\\n%.3f us\"", 1e6 * (double)node->seconds);
        break;
    case PREDICT_MESSAGE:
        fprintf(file, "shape=ellipse,label=\"%" PRIu32 " to %" PRIu32 "\\n%" PRIu64 " bytes\"",
                node->host, node->block, node->number);
        break;
    case PREDICT_EXCHANGE:
        fprintf(file, "shape=ellipse,label=\"to all\\n%" PRIu64 " bytes\"", node->number);
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
            put_node(&graph, i, file);
        for (size_t i = 0; i < graph.n_nodes; i++)
            for (uint32_t e = graph.node[i].edge; e != PREDICT_NONE; e = graph.edge[e].next)
                fprintf(file, "  n%zu -> n%" PRIu32 ";\n", i, graph.edge[e].to);
        fputs("}\n", file);
    }
    predict_graph_free(&graph);
    return code;
}
