#ifndef DUITE_MAP_FRONT_H
#define DUITE_MAP_FRONT_H

#include "runtime/base/guard.h"

#include <duite_policy.h>

/* A mapping and who asks it: one that is not ours under a guard, with a caller. A call that was
 * left is the guard's error. */
struct map_front {
    const duite_mapping *own;
    struct base_caller *caller; /* NULL: the mapping is ours, or nobody guards it */
};

/* Whether it is none of the built-in ones. */
bool map_is_foreign(const duite_mapping *mapping);

/* duite_mapping.map and map_tasks. */
int map_ask(const struct map_front *mapping, const duite_object_graph *graph, int n_ranks,
            uint64_t seed, int *home);
int map_ask_tasks(const struct map_front *mapping, const duite_task_graph *graph, int *home);

#endif
