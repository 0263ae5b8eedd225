#ifndef DUITE_WORKERS_NEAR_H
#define DUITE_WORKERS_NEAR_H

#include <duite_policy.h>
#include <stdbool.h>

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
