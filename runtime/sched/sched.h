#ifndef DUITE_SCHED_SCHED_H
#define DUITE_SCHED_SCHED_H

#include "runtime/base/policy.h"

#include <duite_policy.h>
#include <stdbool.h>

/* The built-in schedulers. A scheduler is a table in sched.c and a row here; the first is the
 * default. */
#define SCHED_ROWS(ROW)                                                                            \
    ROW(steal)                                                                                     \
    ROW(locality)                                                                                  \
    ROW(owner)                                                                                     \
    ROW(fifo)                                                                                      \
    ROW(lifo)                                                                                      \
    ROW(priority)                                                                                  \
    ROW(static)
/* Adversaries for tests: programs may name them, but no list of all has them. */
#define SCHED_TEST_ROWS(ROW) ROW(shuffle)

#define SCHED_DECLARE(name) extern const duite_scheduler sched_##name;
SCHED_ROWS(SCHED_DECLARE)
SCHED_TEST_ROWS(SCHED_DECLARE)

/* The names of those for tests, ended by NULL. */
const char *const *sched_test_names(void);

/* All of them. */
extern const struct base_policies sched_policies;

/* The decisions by affinity: a ready task stays with the worker that made it ready, but in a replay
 * goes to the worker that ran the last task on the same data. Chained: if that is this worker. */
unsigned sched_place_affinity(void *state, const duite_ready *task);
int sched_chain_affinity(void *state, const duite_ready *task);

#endif
