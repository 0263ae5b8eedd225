/* Tasks as mappings see them: those of a round, the block that each runs for, and its cost. The
 * cost is the fork's, else the measured one, else a guess. */
#include "runtime/map/blocks.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

#define GUESSED_SECONDS 1e-6

static bool task_lacks_cost(const struct plan_tasks *tasks, size_t i)
{
    return tasks->program[i] && !(tasks->cost[i] > 0);
}

/* Splits the measured seconds of each block evenly over its tasks whose forks named no cost. */
static bool tasks_share_out(struct plan_tasks *tasks, const struct map_moves *moves, bool *guessed)
{
    const uint32_t *block = tasks->owner;
    double *lacking = base_alloc_zero((moves->blocks.n + 1) * sizeof *lacking);
    if (!lacking)
        return false;
    for (size_t i = 0; i < tasks->n; i++) {
        bool is = task_lacks_cost(tasks, i);
        *guessed |= is;
        if (is && block[i] != DUITE_NO_BLOCK)
            lacking[block[i]]++;
    }
    for (size_t i = 0; i < tasks->n; i++)
        if (task_lacks_cost(tasks, i) && block[i] != DUITE_NO_BLOCK)
            tasks->cost[i] = moves->seconds[block[i]] / lacking[block[i]];
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

static int tasks_ask(const struct plan_tasks *tasks, const struct map_moves *moves)
{
    const duite_task_graph graph = {.n = tasks->n,
                                    .cost = tasks->cost,
                                    .block = tasks->owner,
                                    .start = tasks->start,
                                    .from = tasks->from,
                                    .bytes = tasks->bytes,
                                    .n_blocks = moves->blocks.n,
                                    .fixed = moves->fixed,
                                    .n_ranks = moves->n_ranks,
                                    .workers = moves->workers,
                                    .byte_seconds = moves->byte_seconds,
                                    .message_seconds = moves->message_seconds,
                                    .seed = moves->seed};
    return map_ask_tasks(moves->mapping, &graph, moves->home);
}

_Static_assert(PLAN_NONE == DUITE_NO_BLOCK, "a task that runs for no object runs for no block");

int map_moves_ask(struct map_moves *moves, const struct plan_source *source, const uint32_t *block,
                  bool *guessed)
{
    struct plan_round round = {0};
    struct plan_tasks tasks = {0};
    bool fine = plan_lower(&round, source) && plan_tasks_find(&tasks, &round);
    for (size_t i = 0; i < tasks.n && fine; i++)
        if (tasks.owner[i] != PLAN_NONE)
            tasks.owner[i] = block[tasks.owner[i]];
    *guessed = false;
    fine = fine && tasks_share_out(&tasks, moves, guessed);
    if (fine)
        tasks_guess(&tasks);
    const int code =
        fine ? tasks_ask(&tasks, moves) : base_no_memory("the tasks of a recorded graph");
    plan_tasks_free(&tasks);
    plan_round_free(&round);
    return code;
}
