#ifndef DUITE_MAP_TASKS_H
#define DUITE_MAP_TASKS_H

#include "runtime/map/blocks.h"
#include "runtime/plan/record.h"

#include <duite_policy.h>

/* A round of a record as mappings see it. */
struct map_tasks {
    duite_task_graph graph; /* n, cost, block and the rows are filled in; points into the rest */
    struct plan_tasks tasks;
    uint32_t *block;
    bool guessed; /* some of the program's tasks had no cost */
};

/* seconds: of each block, as measured. Errors: memory; map_tasks_free is due all the same. */
int map_tasks_find(struct map_tasks *tasks, const struct plan_record *record,
                   const struct map_blocks *blocks, const double *seconds);
/* Fills in unknown costs and `graph`, once `block` and `tasks` are there. Errors: memory. */
int map_tasks_complete(struct map_tasks *tasks, size_t n_blocks, const double *seconds);
void map_tasks_free(struct map_tasks *tasks);

#endif
