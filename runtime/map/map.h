#ifndef DUITE_MAP_MAP_H
#define DUITE_MAP_MAP_H

#include "runtime/data/object.h"
#include "runtime/map/front.h"

#include <duite_policy.h>

/* The built-in mappings. A mapping is one file, which defines its table, and one row here; the
 * first is the default. */
#define MAP_ROWS(ROW)                                                                              \
    ROW(metis)                                                                                     \
    ROW(block)                                                                                     \
    ROW(cyclic)                                                                                    \
    ROW(random)                                                                                    \
    ROW(taskgraph)                                                                                 \
    ROW(list)

#define MAP_DECLARE(name) extern const duite_mapping map_##name;
MAP_ROWS(MAP_DECLARE)

/* That of `metis`: equal weights, few bytes between ranks. */
int map_by_metis(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home);

/* Notes a hint: the weight, and edges to n neighbours; or a leader. Homes that are settled stay.
 * Main thread, collective. Errors: objects, arguments, memory. */
int map_hint(struct data_table *table, duite_object object, double weight, size_t n,
             const duite_object *neighbours, const double *edge_weights);
int map_follow(struct data_table *table, duite_object object, duite_object leader);

/* Gives a home to all objects without one: leaders by the mapping, followers with them. Main
 * thread, collective. Errors: those of the mapping; memory; DUITE_E_ARGUMENT for a home that is no
 * rank. */
int map_settle(struct data_table *table, const struct map_front *mapping, uint64_t seed);

#endif
