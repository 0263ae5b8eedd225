/* list: earliest finish time. The tasks of a recorded graph are visited by their upward rank: the
 * longest path of costs and transfers to the end. The first task of each block takes the block to
 * the rank where that task would end first, given when a worker there is idle and the task's inputs
 * arrive. The block's other tasks follow. After Topcuoglu, Hariri & Wu, Performance-effective and
 * low-complexity task scheduling for heterogeneous computing (HEFT), IEEE TPDS 13(3), 2002, without
 * insertion into gaps. Only reads within a round count. Until a graph is replayed, homes are those
 * of `metis`. */
#include "runtime/map/map.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#include <stdlib.h>

struct list_plan {
    void *memory; /* of the arrays */
    const duite_task_graph *graph;
    int *home;
    bool *placed;    /* by block */
    double *upward;  /* by task */
    uint32_t *order; /* tasks by upward rank */
    double *end;     /* by task: when it ends */
    int *rank;       /* by task: where it runs; DUITE_NO_RANK: everywhere */
    double *free;    /* by worker, rank after rank: when it becomes idle */
    size_t *first;   /* n_ranks + 1: of each rank's workers */
};

static double list_edge_seconds(const duite_task_graph *graph, size_t edge)
{
    return graph->message_seconds + graph->bytes[edge] * graph->byte_seconds;
}

/* Rows name earlier tasks, so a pass from the last task back visits all readers of a result before
 * its task. */
static void list_rank_upward(struct list_plan *plan)
{
    const duite_task_graph *graph = plan->graph;
    for (size_t i = graph->n; i-- > 0;) {
        plan->upward[i] += graph->cost[i];
        for (size_t e = graph->start[i]; e < graph->start[i + 1]; e++) {
            double *before = &plan->upward[graph->from[e]];
            if (graph->from[e] < i && *before < plan->upward[i] + list_edge_seconds(graph, e))
                *before = plan->upward[i] + list_edge_seconds(graph, e);
        }
    }
}

static int list_compare(const void *a, const void *b, void *context)
{
    const struct list_plan *plan = context;
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    double left = plan->upward[x], right = plan->upward[y];
    return left != right ? (left > right ? -1 : 1) : (x < y ? -1 : x > y);
}

/* The time when all inputs of the task have arrived on the rank. */
static double list_arrival(const struct list_plan *plan, size_t task, int rank)
{
    const duite_task_graph *graph = plan->graph;
    double all = 0;
    for (size_t e = graph->start[task]; e < graph->start[task + 1]; e++) {
        size_t from = graph->from[e];
        if (from >= task)
            continue;
        bool here = plan->rank[from] == rank || plan->rank[from] == DUITE_NO_RANK;
        double there = plan->end[from] + (here ? 0 : list_edge_seconds(graph, e));
        all = there > all ? there : all;
    }
    return all;
}

/* The rank's worker that becomes idle first. */
static size_t list_first_idle(const struct list_plan *plan, int rank)
{
    size_t best = plan->first[rank];
    for (size_t w = best; w < plan->first[rank + 1]; w++)
        if (plan->free[w] < plan->free[best])
            best = w;
    return best;
}

static double list_finish(const struct list_plan *plan, size_t task, int rank)
{
    double free = plan->free[list_first_idle(plan, rank)], there = list_arrival(plan, task, rank);
    return (free > there ? free : there) + plan->graph->cost[task];
}

static int list_choose(const struct list_plan *plan, size_t task)
{
    int best = 0;
    double least = list_finish(plan, task, 0);
    for (int rank = 1; rank < plan->graph->n_ranks; rank++) {
        double over = list_finish(plan, task, rank);
        if (over < least) {
            least = over;
            best = rank;
        }
    }
    return best;
}

static void list_place(struct list_plan *plan, size_t task)
{
    const duite_task_graph *graph = plan->graph;
    uint32_t block = graph->block[task];
    if (block == DUITE_NO_BLOCK) {
        plan->rank[task] = DUITE_NO_RANK;
        plan->end[task] = list_arrival(plan, task, DUITE_NO_RANK) + graph->cost[task];
        return;
    }
    if (!plan->placed[block] && !graph->fixed[block])
        plan->home[block] = list_choose(plan, task);
    plan->placed[block] = true;
    int rank = plan->rank[task] = plan->home[block];
    plan->end[task] = list_finish(plan, task, rank);
    if (graph->cost[task] > 0)
        plan->free[list_first_idle(plan, rank)] = plan->end[task];
}

static bool list_allocate(struct list_plan *plan)
{
    const duite_task_graph *graph = plan->graph;
    const size_t n = graph->n + 1, ranks = (size_t)graph->n_ranks;
    size_t workers = 0;
    for (size_t r = 0; r < ranks; r++)
        workers += graph->workers[r];
    const struct base_array arrays[] = {
        BASE_ZEROS(plan->first, ranks + 1), BASE_ZEROS(plan->placed, graph->n_blocks + 1),
        BASE_ZEROS(plan->upward, n),        BASE_ARRAY(plan->order, n),
        BASE_ARRAY(plan->end, n),           BASE_ARRAY(plan->rank, n),
        BASE_ZEROS(plan->free, workers),    {0}};
    plan->memory = base_arrays(arrays);
    for (size_t r = 0; r < ranks && plan->memory; r++)
        plan->first[r + 1] = plan->first[r] + graph->workers[r];
    return plan->memory;
}

static int list_map_tasks(const duite_task_graph *graph, int *home)
{
    struct list_plan plan = {.graph = graph, .home = home};
    bool fine = list_allocate(&plan);
    if (fine) {
        list_rank_upward(&plan);
        for (size_t i = 0; i < graph->n; i++)
            plan.order[i] = (uint32_t)i;
        qsort_r(plan.order, graph->n, sizeof *plan.order, list_compare, &plan);
        for (size_t i = 0; i < graph->n; i++)
            list_place(&plan, plan.order[i]);
    }
    base_free(plan.memory);
    return fine ? DUITE_OK : base_no_memory("the mapping list");
}

const duite_mapping map_list = {
    .size = sizeof(duite_mapping),
    .name = "list",
    .summary = "blocks where the tasks of a recorded graph are over first (HEFT)",
    .map = map_by_metis,
    .map_tasks = list_map_tasks,
};
