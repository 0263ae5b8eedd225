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

/* How many levels of the topology lie between two processing units and the smallest part of the
 * machine that has both; 0 if it is one or hwloc does not know them. After work_cores_find. */
unsigned work_cores_distance(int a, int b);

/* Binds the calling thread to one processing unit; -1: leaves it where it is. A refusal is not an
 * error: binding is a favour. */
void work_cores_bind(int unit);

/* How far the workers of a rank are from each other, as schedulers are told it: fixed at start. */
struct work_near {
    unsigned n;            /* workers */
    unsigned *distance;    /* n x n, row after row */
    unsigned *by_nearness; /* n rows of all others and of their distances */
    duite_near *of;        /* n: each one's view */
};

/* cores: n of them, or NULL: the workers are not bound, and as far from one as from the other.
 * False without memory; work_near_stop is due all the same. */
bool work_near_start(struct work_near *near, unsigned n, const int *cores);
void work_near_stop(struct work_near *near);

static inline const duite_near *work_near_of(const struct work_near *near, unsigned worker)
{
    return &near->of[worker];
}

/* Whether others are nearer to the worker than this one. */
static inline bool work_near_is_far(const struct work_near *near, unsigned worker, unsigned other)
{
    return near->distance[worker * near->n + other] > near->of[worker].distance[0];
}

#endif
