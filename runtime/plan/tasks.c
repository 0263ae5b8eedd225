/* A round of a record as a graph of tasks: the nodes of a draft, the same on any number of ranks.
 * Rows say who reads whose result; paths count every dependence, those that carry nothing too. */
#include "runtime/plan/draft.h"
#include "runtime/task/internal.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

void plan_tasks_free(struct plan_tasks *tasks)
{
    base_free(tasks->kernel);
    base_free(tasks->cost);
    base_free(tasks->owner);
    base_free(tasks->start);
    base_free(tasks->from);
    base_free(tasks->bytes);
    *tasks = (struct plan_tasks){0};
}

static bool allocate(struct plan_tasks *tasks, const struct plan_draft *draft)
{
    size_t n = tasks->n = draft->n_nodes;
    tasks->kernel = base_alloc_zero((n + 1) * sizeof *tasks->kernel);
    tasks->cost = base_alloc_zero((n + 1) * sizeof *tasks->cost);
    tasks->owner = base_alloc((n + 1) * sizeof *tasks->owner);
    tasks->start = base_alloc_zero((n + 1) * sizeof *tasks->start);
    tasks->from = base_alloc((draft->n_uses + 1) * sizeof *tasks->from);
    tasks->bytes = base_alloc((draft->n_uses + 1) * sizeof *tasks->bytes);
    return tasks->kernel && tasks->cost && tasks->owner && tasks->start && tasks->from &&
           tasks->bytes;
}

/* The owner rule; a sum and a view are made for their object. */
static uint32_t owner_of(const struct plan_draft *draft, const struct plan_draft_node *node)
{
    if (node->kind == TASK_NODE && draft->record->fork[node->fork].kernel != PLAN_SETS)
        return plan_recorded_owner(draft->record, &draft->record->fork[node->fork]);
    return draft->use[node->first_use].place;
}

static void fill_nodes(struct plan_tasks *tasks, const struct plan_draft *draft)
{
    const struct plan_record *record = draft->record;
    for (size_t i = 0; i < draft->n_nodes; i++) {
        const struct plan_draft_node *node = &draft->node[i];
        tasks->owner[i] = owner_of(draft, node);
        if (node->kind != TASK_NODE)
            continue;
        tasks->kernel[i] = record->graph->kernels[record->fork[node->fork].kernel];
        tasks->cost[i] = record->fork[node->fork].how.cost;
    }
}

static double bytes_of(const struct plan_draft *draft, size_t place)
{
    size_t object = place < draft->n_objects ? place : draft->place[place].object;
    const struct plan_recorded_object *whole = &draft->record->object[object];
    return (double)(whole->count * data_type_size(whole->type));
}

/* Goes through two rounds with the last writer of each place, and keeps the rows of the second:
 * what was written last in the first one was written by the reader itself or after it. */
static bool fill_rows(struct plan_tasks *tasks, const struct plan_draft *draft)
{
    size_t n = draft->n_nodes, at = 0;
    size_t *writer = base_alloc_zero((draft->n_places + 1) * sizeof *writer); /* plus one */
    if (!writer)
        return false;
    for (size_t step = 0; step < 2 * n; step++) {
        const struct plan_draft_node *node = &draft->node[step % n];
        const struct plan_node_use *use = draft->use + node->first_use;
        for (size_t k = 0; k < node->n_uses && step >= n; k++) {
            if (!use[k].reads || !writer[use[k].place])
                continue;
            tasks->from[at] = (uint32_t)((writer[use[k].place] - 1) % n);
            tasks->bytes[at++] = bytes_of(draft, use[k].place);
        }
        for (size_t k = 0; k < node->n_uses; k++)
            if (use[k].writes)
                writer[use[k].place] = step + 1;
        tasks->start[step % n + 1] = at;
    }
    base_free(writer);
    return true;
}

int plan_record_tasks(const struct plan_record *record, struct plan_tasks *tasks)
{
    struct plan_draft draft = {.record = record};
    *tasks = (struct plan_tasks){0};
    bool fine = plan_draft_round(&draft, record->n_objects, 0) && allocate(tasks, &draft);
    if (fine) {
        fill_nodes(tasks, &draft);
        fine = fill_rows(tasks, &draft);
    }
    plan_draft_free(&draft);
    return fine ? DUITE_OK : base_no_memory("the tasks of a recorded graph");
}

/* ---- Paths ---- */

/* What a fork counts that did not say its cost: the mean of those that did, or 1. */
static double usual_cost(const struct plan_record *record)
{
    double sum = 0, said = 0;
    for (size_t i = 0; i < record->n_forks; i++) {
        sum += record->fork[i].how.cost;
        said += record->fork[i].how.cost > 0;
    }
    return said > 0 ? sum / said : 1;
}

/* Edges within a round lead to later nodes, and are found in their order: from the last one back,
 * what follows an edge is known when it is come to. `longest` is by node, without its own cost
 * until that is added. */
static void find_longest(const struct plan_draft *draft, double *longest)
{
    const struct plan_record *record = draft->record;
    double usual = usual_cost(record);
    size_t edge = draft->n_edges;
    for (size_t i = draft->n_nodes; i-- > 0;) {
        const struct plan_draft_node *node = &draft->node[i];
        double cost = node->kind == TASK_NODE ? record->fork[node->fork].how.cost : 0;
        longest[i] += node->kind == TASK_NODE && !(cost > 0) ? usual : cost;
        for (; edge && (draft->edge[edge - 1].cyclic || draft->edge[edge - 1].to >= i); edge--) {
            const struct plan_draft_edge *in = &draft->edge[edge - 1];
            if (!in->cyclic && longest[in->from] < longest[i])
                longest[in->from] = longest[i];
        }
    }
}

float *plan_record_paths(const struct plan_record *record)
{
    struct plan_draft draft = {.record = record};
    bool fine = plan_draft_make(&draft, record->n_objects, 0);
    double *longest = fine ? base_alloc_zero((draft.n_nodes + 1) * sizeof *longest) : NULL;
    float *path = longest ? base_alloc_zero((record->n_forks + 1) * sizeof *path) : NULL;
    if (path)
        find_longest(&draft, longest);
    for (size_t i = 0; path && i < draft.n_nodes; i++)
        if (draft.node[i].kind == TASK_NODE)
            path[draft.node[i].fork] = (float)longest[i];
    base_free(longest);
    plan_draft_free(&draft);
    return path;
}
