/* Tasks as mappings see them: the tasks of a record, the block that each runs for, and its cost.
 * The cost is the fork's, else the measured one, else a guess. */
#include "runtime/map/tasks.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#define GUESSED_SECONDS 1e-6

static bool task_lacks_cost(const struct plan_tasks *tasks, size_t i)
{
    return tasks->program[i] && !(tasks->cost[i] > 0);
}

/* Splits the measured seconds of each block evenly over its tasks whose forks named no cost. */
static bool tasks_share_out(struct map_tasks *tasks, size_t n_blocks, const double *seconds)
{
    struct plan_tasks *all = &tasks->tasks;
    double *lacking = base_alloc_zero((n_blocks + 1) * sizeof *lacking);
    if (!lacking)
        return false;
    for (size_t i = 0; i < all->n; i++) {
        bool is = task_lacks_cost(all, i);
        tasks->guessed |= is;
        if (is && tasks->block[i] != DUITE_NO_BLOCK)
            lacking[tasks->block[i]]++;
    }
    for (size_t i = 0; i < all->n; i++)
        if (task_lacks_cost(all, i) && tasks->block[i] != DUITE_NO_BLOCK)
            all->cost[i] = seconds[tasks->block[i]] / lacking[tasks->block[i]];
    base_free(lacking);
    return true;
}

static void tasks_guess(struct plan_tasks *tasks)
{
    double sum = 0, known = 0;
    for (size_t i = 0; i < tasks->n; i++) {
        sum += tasks->cost[i];
        known += tasks->cost[i] > 0;
    }
    for (size_t i = 0; i < tasks->n; i++)
        if (task_lacks_cost(tasks, i))
            tasks->cost[i] = known > 0 ? sum / known : GUESSED_SECONDS;
}

int map_tasks_complete(struct map_tasks *tasks, size_t n_blocks, const double *seconds)
{
    struct plan_tasks *all = &tasks->tasks;
    if (!tasks_share_out(tasks, n_blocks, seconds))
        return base_no_memory("the tasks of a recorded graph");
    tasks_guess(all);
    tasks->graph = (duite_task_graph){.n = all->n,
                                      .cost = all->cost,
                                      .block = tasks->block,
                                      .start = all->start,
                                      .from = all->from,
                                      .bytes = all->bytes,
                                      .n_blocks = n_blocks};
    return DUITE_OK;
}

int map_tasks_find(struct map_tasks *tasks, const struct plan_record *record,
                   const struct map_blocks *blocks, const double *seconds)
{
    struct plan_tasks *all = &tasks->tasks;
    *tasks = (struct map_tasks){0};
    int code = plan_record_tasks(record, all);
    if (code)
        return code;
    tasks->block = base_alloc((all->n + 1) * sizeof *tasks->block);
    if (!tasks->block)
        return base_no_memory("the tasks of a recorded graph");
    for (size_t i = 0; i < all->n; i++)
        tasks->block[i] = all->owner[i] == PLAN_NONE
                              ? DUITE_NO_BLOCK
                              : blocks->of[record->object[all->owner[i]].bound.slot];
    return map_tasks_complete(tasks, blocks->n, seconds);
}

void map_tasks_free(struct map_tasks *tasks)
{
    plan_tasks_free(&tasks->tasks);
    base_free(tasks->block);
}
