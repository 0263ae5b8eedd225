#ifndef DUITE_SCHED_SCHED_H
#define DUITE_SCHED_SCHED_H

#include <duite_policy.h>
#include <stdbool.h>

/* The built-in schedulers, and the decisions that several of them share. A scheduler is one file,
 * which defines its table, and one row here; the first is the default. */
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

/* True if the scheduler is not built in. */
bool sched_is_foreign(const duite_scheduler *scheduler);

struct sched_state {
    uint64_t random;
    unsigned worker, n_workers;
    unsigned first; /* of the victims of this round */
};

void sched_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed);

/* Where a ready task goes. Shared: all to one queue. Affinity: to the worker that made it ready,
 * but in a replay to the worker that ran the last task on the same data. Owner: to the worker of
 * the task's block. */
unsigned sched_place_shared(void *state, const duite_ready *task);
unsigned sched_place_affinity(void *state, const duite_ready *task);
unsigned sched_place_owner(void *state, const duite_ready *task);

duite_end sched_serve_newest(void *state);
duite_end sched_serve_oldest(void *state);
duite_end sched_serve_highest(void *state);

/* The victims: no worker; or each other worker once a round, from a random one on. */
unsigned sched_no_victim(void *state, unsigned attempt);
unsigned sched_any_victim(void *state, unsigned attempt);

int sched_never_chain(void *state, const duite_ready *task);
/* True if affinity, or the owner, would place the task on this worker. */
int sched_chain_affinity(void *state, const duite_ready *task);
int sched_chain_owner(void *state, const duite_ready *task);

#endif
