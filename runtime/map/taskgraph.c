/* taskgraph: METIS on the tasks of a recorded graph instead of on hints. A block weighs the cost of
 * its tasks. Blocks are tied by the bytes that tasks of one read from tasks of the other, in a
 * round and from round to round. As in Zara's Athapascan (2001), the program unfolds the graph
 * itself and need not describe it. Until a graph is replayed, homes are those of `metis`. */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

struct tie {
    uint32_t from, to;
    double bytes;
};

struct taskgraph {
    uint32_t *node;  /* by block: its vertex, or DUITE_NO_BLOCK: no task runs for it */
    uint32_t *block; /* by vertex */
    double *weight, *tied;
    size_t *start;
    uint32_t *neighbour;
    int *part;
    struct tie *tie;
    size_t n, n_ties;
};

static int tie_compare(const void *a, const void *b)
{
    const struct tie *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

static bool taskgraph_allocate(struct taskgraph *work, const duite_task_graph *graph)
{
    size_t blocks = graph->n_blocks + 1, ties = 2 * graph->start[graph->n] + 1;
    work->node = base_alloc(blocks * sizeof *work->node);
    work->block = base_alloc(blocks * sizeof *work->block);
    work->weight = base_alloc_zero(blocks * sizeof *work->weight);
    work->start = base_alloc_zero((blocks + 1) * sizeof *work->start);
    work->part = base_alloc(blocks * sizeof *work->part);
    work->tie = base_alloc(ties * sizeof *work->tie);
    work->neighbour = base_alloc(ties * sizeof *work->neighbour);
    work->tied = base_alloc(ties * sizeof *work->tied);
    return work->node && work->block && work->weight && work->start && work->part && work->tie &&
           work->neighbour && work->tied;
}

static void taskgraph_release(struct taskgraph *work)
{
    base_free(work->node);
    base_free(work->block);
    base_free(work->weight);
    base_free(work->start);
    base_free(work->part);
    base_free(work->tie);
    base_free(work->neighbour);
    base_free(work->tied);
}

/* Blocks without tasks, and fixed ones, stay where they are. */
static void taskgraph_weigh(struct taskgraph *work, const duite_task_graph *graph)
{
    for (size_t b = 0; b < graph->n_blocks; b++)
        work->node[b] = DUITE_NO_BLOCK;
    for (size_t i = 0; i < graph->n; i++) {
        uint32_t block = graph->block[i];
        if (block == DUITE_NO_BLOCK || graph->fixed[block])
            continue;
        if (work->node[block] == DUITE_NO_BLOCK) {
            work->node[block] = (uint32_t)work->n;
            work->block[work->n++] = block;
        }
        work->weight[work->node[block]] += graph->cost[i];
    }
}

static void taskgraph_tie(struct taskgraph *work, const duite_task_graph *graph)
{
    for (size_t i = 0; i < graph->n; i++)
        for (size_t e = graph->start[i]; e < graph->start[i + 1]; e++) {
            uint32_t a = graph->block[i], b = graph->block[graph->from[e]];
            if (a == b || a == DUITE_NO_BLOCK || b == DUITE_NO_BLOCK)
                continue;
            a = work->node[a], b = work->node[b];
            if (a == DUITE_NO_BLOCK || b == DUITE_NO_BLOCK)
                continue;
            work->tie[work->n_ties++] = (struct tie){a, b, graph->bytes[e]};
            work->tie[work->n_ties++] = (struct tie){b, a, graph->bytes[e]};
        }
    if (work->n_ties)
        qsort(work->tie, work->n_ties, sizeof *work->tie, tie_compare);
    size_t n = 0;
    for (size_t i = 0; i < work->n_ties; i++) {
        if (!i || tie_compare(&work->tie[i], &work->tie[i - 1])) {
            work->start[work->tie[i].from + 1]++;
            work->neighbour[n] = work->tie[i].to;
            work->tied[n++] = 0;
        }
        work->tied[n - 1] += work->tie[i].bytes;
    }
    for (size_t i = 0; i < work->n; i++)
        work->start[i + 1] += work->start[i];
}

static int taskgraph_map_tasks(const duite_task_graph *graph, int *home)
{
    struct taskgraph work = {0};
    int code =
        taskgraph_allocate(&work, graph) ? DUITE_OK : base_no_memory("the mapping taskgraph");
    if (!code) {
        taskgraph_weigh(&work, graph);
        taskgraph_tie(&work, graph);
        const duite_object_graph blocks = {.n = work.n,
                                           .weight = work.weight,
                                           .start = work.start,
                                           .neighbour = work.neighbour,
                                           .edge_weight = work.tied};
        code = map_by_metis(&blocks, graph->n_ranks, graph->seed, work.part);
    }
    for (size_t i = 0; i < work.n && !code; i++)
        home[work.block[i]] = work.part[i];
    taskgraph_release(&work);
    return code;
}

const duite_mapping map_taskgraph = {
    .name = "taskgraph",
    .summary = "METIS on the tasks of a recorded graph, with what they cost and read",
    .map = map_by_metis,
    .map_tasks = taskgraph_map_tasks,
};
