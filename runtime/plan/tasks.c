/* A round for mappings and schedulers: rows with the results that each node reads, and the paths to
 * the round's end. Paths count every dependence, even those without data. */
#include "runtime/plan/passes.h"

#include "runtime/base/memory.h"

/* ---- Rows ---- */

void plan_tasks_free(struct plan_tasks *tasks)
{
    base_free(tasks->memory);
    *tasks = (struct plan_tasks){0};
}

static bool tasks_room(struct plan_tasks *tasks, const struct plan_round *round)
{
    const size_t n = tasks->n = round->n_nodes;
    const struct base_array arrays[] = {BASE_ZEROS(tasks->program, n + 1),
                                        BASE_ZEROS(tasks->cost, n + 1),
                                        BASE_ARRAY(tasks->owner, n + 1),
                                        BASE_ZEROS(tasks->start, n + 1),
                                        BASE_ARRAY(tasks->from, round->n_uses + 1),
                                        BASE_ARRAY(tasks->bytes, round->n_uses + 1),
                                        {0}};
    return (tasks->memory = base_arrays(arrays)) != NULL;
}

static uint32_t tasks_owner(const struct plan_round *round, const struct plan_round_node *node)
{
    const struct plan_source_fork *fork = &round->source->fork[node->fork];
    if (node->kind == PLAN_TASK && (fork->replicated || fork->rank != PLAN_BY_OWNER))
        return PLAN_NONE;
    return node->owner;
}

static void tasks_fill_nodes(struct plan_tasks *tasks, const struct plan_round *round)
{
    for (size_t i = 0; i < round->n_nodes; i++) {
        const struct plan_round_node *node = &round->node[i];
        tasks->owner[i] = tasks_owner(round, node);
        tasks->program[i] = node->kind == PLAN_TASK;
        if (tasks->program[i])
            tasks->cost[i] = round->source->fork[node->fork].cost;
    }
}

static double tasks_bytes(const struct plan_round *round, size_t place)
{
    return (double)round->source->bytes[round->place[place].object];
}

/* Goes through two rounds with the last writer of each place, and keeps the rows of the second. A
 * writer from the first round is then the reader itself or comes after it. */
static bool tasks_fill_rows(struct plan_tasks *tasks, const struct plan_round *round)
{
    size_t n = round->n_nodes, at = 0;
    size_t *writer = base_alloc_zero((round->n_places + 1) * sizeof *writer); /* plus one */
    if (!writer)
        return false;
    for (size_t step = 0; step < 2 * n; step++) {
        const struct plan_round_node *node = &round->node[step % n];
        const struct plan_node_use *use = round->use + node->first_use;
        for (size_t k = 0; k < node->n_uses && step >= n; k++) {
            if (!use[k].reads || !writer[use[k].place])
                continue;
            tasks->from[at] = (uint32_t)((writer[use[k].place] - 1) % n);
            tasks->bytes[at++] = tasks_bytes(round, use[k].place);
        }
        for (size_t k = 0; k < node->n_uses; k++)
            if (use[k].writes)
                writer[use[k].place] = step + 1;
        tasks->start[step % n + 1] = at;
    }
    base_free(writer);
    return true;
}

bool plan_tasks_find(struct plan_tasks *tasks, const struct plan_round *round)
{
    *tasks = (struct plan_tasks){0};
    if (!tasks_room(tasks, round))
        return false;
    tasks_fill_nodes(tasks, round);
    return tasks_fill_rows(tasks, round);
}

/* ---- Paths ---- */

/* The cost of a fork without one: the mean of the others, or 1. */
static double path_usual_cost(const struct plan_source *source)
{
    double sum = 0, said = 0;
    for (size_t i = 0; i < source->n_forks; i++) {
        sum += source->fork[i].cost;
        said += source->fork[i].cost > 0;
    }
    return said > 0 ? sum / said : 1;
}

/* Edges within a round lead to later nodes, and are in their order. So the pass goes backwards from
 * the last edge, and the path behind each edge is already known. `longest` is by node, without the
 * node's own cost until that is added. */
static void path_find(const struct plan_round *round, double *longest)
{
    double usual = path_usual_cost(round->source);
    size_t edge = round->n_edges;
    for (size_t i = round->n_nodes; i-- > 0;) {
        const struct plan_round_node *node = &round->node[i];
        double cost = node->kind == PLAN_TASK ? round->source->fork[node->fork].cost : 0;
        longest[i] += node->kind == PLAN_TASK && !(cost > 0) ? usual : cost;
        for (; edge && (round->edge[edge - 1].cyclic || round->edge[edge - 1].to >= i); edge--) {
            const struct plan_round_edge *in = &round->edge[edge - 1];
            if (!in->cyclic && longest[in->from] < longest[i])
                longest[in->from] = longest[i];
        }
    }
}

float *plan_paths_find(const struct plan_round *round)
{
    double *longest = base_alloc_zero((round->n_nodes + 1) * sizeof *longest);
    float *path = longest ? base_alloc_zero((round->source->n_forks + 1) * sizeof *path) : NULL;
    if (path)
        path_find(round, longest);
    for (size_t i = 0; path && i < round->n_nodes; i++)
        if (round->node[i].kind == PLAN_TASK)
            path[round->node[i].fork] = (float)longest[i];
    base_free(longest);
    return path;
}
