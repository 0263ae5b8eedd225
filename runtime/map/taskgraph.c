/* taskgraph: METIS on the tasks of a recorded graph instead of on hints. A block weighs the cost of
 * its tasks. Blocks are tied by the bytes that tasks of one read from tasks of the other, in a
 * round and from round to round. As in Zara's Athapascan (2001), the program unfolds the graph
 * itself and need not describe it. Until a graph is replayed, homes are those of `metis`. */
#include "runtime/map/blocks.h"
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

struct taskgraph {
    void *memory;    /* of the arrays */
    uint32_t *node;  /* by block: its vertex, or DUITE_NO_BLOCK: no task runs for it */
    uint32_t *block; /* by vertex */
    double *weight;
    int *part;
    struct map_traffic traffic; /* between vertices */
    size_t n;
};

static bool taskgraph_room(struct taskgraph *work, size_t n_blocks)
{
    const struct base_array arrays[] = {BASE_ARRAY(work->node, n_blocks + 1),
                                        BASE_ARRAY(work->block, n_blocks + 1),
                                        BASE_ZEROS(work->weight, n_blocks + 1),
                                        BASE_ARRAY(work->part, n_blocks + 1),
                                        {0}};
    return (work->memory = base_arrays(arrays)) != NULL;
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

static bool taskgraph_tie(struct taskgraph *work, const duite_task_graph *graph)
{
    bool fine = true;
    for (size_t i = 0; i < graph->n && fine; i++)
        for (size_t e = graph->start[i]; e < graph->start[i + 1] && fine; e++) {
            const uint32_t a = graph->block[i], b = graph->block[graph->from[e]];
            if (a != b && a != DUITE_NO_BLOCK && b != DUITE_NO_BLOCK)
                fine =
                    map_traffic_read(&work->traffic, work->node[a], work->node[b], graph->bytes[e]);
        }
    return fine && !map_traffic_end(&work->traffic, work->n);
}

static int taskgraph_map_tasks(const duite_task_graph *graph, int *home)
{
    struct taskgraph work = {0};
    int code = DUITE_OK;
    if (taskgraph_room(&work, graph->n_blocks))
        taskgraph_weigh(&work, graph);
    if (!work.memory || !taskgraph_tie(&work, graph))
        code = base_no_memory("the mapping taskgraph");
    if (!code) {
        const duite_object_graph blocks = {.n = work.n,
                                           .weight = work.weight,
                                           .start = work.traffic.start,
                                           .neighbour = work.traffic.neighbour,
                                           .edge_weight = work.traffic.bytes};
        code = map_by_metis(&blocks, graph->n_ranks, graph->seed, work.part);
    }
    for (size_t i = 0; i < work.n && !code; i++)
        home[work.block[i]] = work.part[i];
    map_traffic_free(&work.traffic);
    base_free(work.memory);
    return code;
}

const duite_mapping map_taskgraph = {
    .size = sizeof(duite_mapping),
    .name = "taskgraph",
    .summary = "METIS on the tasks of a recorded graph, with what they cost and read",
    .map = map_by_metis,
    .map_tasks = taskgraph_map_tasks,
};
