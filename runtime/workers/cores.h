#ifndef DUITE_WORKERS_CORES_H
#define DUITE_WORKERS_CORES_H

#include <stdint.h>

/* The cores this process may use, as hwloc sees them: one processing unit each, in topological
 * order, so that neighbours in the list are neighbours in the machine. */
struct work_cores {
    unsigned n;
    int *unit;     /* n: the operating system's number of the core's first processing unit */
    uint64_t hash; /* of the list: processes with the same hash share their cores */
};

/* Errors: memory, DUITE_E_SYSTEM. */
int work_cores_find(struct work_cores *cores);
void work_cores_free(struct work_cores *cores);

/* How many levels of the topology lie between two processing units and the smallest part of the
 * machine that has both; 0 if it is one or hwloc does not know them. After work_cores_find. */
unsigned work_cores_distance(int a, int b);

/* Binds the calling thread to one processing unit; -1: leaves it where it is. A refusal is not an
 * error: binding is a favour. */
void work_cores_bind(int unit);

#endif
