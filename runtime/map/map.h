#ifndef DUITE_MAP_MAP_H
#define DUITE_MAP_MAP_H

#include "runtime/base/policy.h"
#include "runtime/data/object.h"

#include <duite_policy.h>

/* The built-in mappings. A mapping is a table and a row here; the first is the default. */
#define MAP_ROWS(ROW)                                                                              \
    ROW(metis)                                                                                     \
    ROW(block)                                                                                     \
    ROW(cyclic)                                                                                    \
    ROW(random)                                                                                    \
    ROW(taskgraph)                                                                                 \
    ROW(list)

#define MAP_DECLARE(name) extern const duite_mapping map_##name;
MAP_ROWS(MAP_DECLARE)

/* The function `map` of `metis`: equal weights, few bytes between ranks. Other mappings use it,
 * too. */
int map_by_metis(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home);

/* All of them. */
extern const struct base_policies map_policies;

/* A mapping, and the mark of the worker that asks it. */
struct map_policy {
    const duite_mapping *own;
    struct base_mark *mark; /* NULL: the mapping is built in, or predicted with */
};

/* Call duite_mapping.map and map_tasks. Main thread. Errors: those of the mapping. */
int map_ask(const struct map_policy *mapping, const duite_object_graph *graph, int n_ranks,
            uint64_t seed, int *home);
int map_ask_tasks(const struct map_policy *mapping, const duite_task_graph *graph, int *home);

/* Note a hint: the weight, and edges to n neighbours; or a leader to live with. Homes that are
 * settled do not change. Main thread, collective. Errors: objects, arguments, memory. */
int map_hint(struct data_table *table, duite_object object, double weight, size_t n,
             const duite_object *neighbours, const double *edge_weights);
int map_colocate(struct data_table *table, duite_object object, duite_object leader);

/* Gives a home to all objects without one: leaders get theirs from the mapping, colocated objects
 * get that of their leader. Main thread, collective. Errors: those of the mapping; memory;
 * DUITE_E_ARGUMENT for a home that is no rank. */
int map_settle(struct data_table *table, const struct map_policy *mapping, uint64_t seed);

#endif
