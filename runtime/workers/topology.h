#ifndef DUITE_WORKERS_TOPOLOGY_H
#define DUITE_WORKERS_TOPOLOGY_H

#include <duite_policy.h>
#include <stdbool.h>
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

/* Binds the calling thread to one processing unit; -1: leaves it where it is. A refusal is no
 * error. */
void work_cores_bind(int unit);

/* Distances between the workers of a rank, as schedulers see them: fixed at start. */
struct work_near {
    unsigned n;            /* workers */
    unsigned *distance;    /* n x n, row after row */
    unsigned *by_nearness; /* n rows of all others and of their distances */
    duite_near *of;        /* n: each one's view */
};

/* cores: n of them; NULL: the workers are not bound, and all distances are equal. False without
 * memory; work_near_stop is due all the same. */
bool work_near_start(struct work_near *near, unsigned n, const int *cores);
void work_near_stop(struct work_near *near);

/* True if another worker is nearer than `other`. */
static inline bool work_near_is_far(const struct work_near *near, unsigned worker, unsigned other)
{
    return near->distance[worker * near->n + other] > near->of[worker].distance[0];
}

#endif
