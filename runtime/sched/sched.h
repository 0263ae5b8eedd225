#ifndef DUITE_SCHED_SCHED_H
#define DUITE_SCHED_SCHED_H

#include <duite_policy.h>

/* The built-in schedulers, and the decisions that several of them share. */
extern const duite_scheduler sched_steal, sched_locality, sched_owner, sched_fifo, sched_lifo,
    sched_priority, sched_static, sched_shuffle;

struct sched_state {
    uint64_t random;
    unsigned worker, n_workers;
    unsigned first; /* of the victims of this round */
};

void sched_start(void *state, unsigned worker, unsigned n_workers, uint64_t seed);

/* All in one queue; each worker its own, but in a replay the one that ran the last task on the same
 * data; the worker of the task's block. */
unsigned sched_place_shared(void *state, const duite_ready *task);
unsigned sched_place_warm(void *state, const duite_ready *task);
unsigned sched_place_owner(void *state, const duite_ready *task);

duite_end sched_serve_newest(void *state);
duite_end sched_serve_oldest(void *state);
duite_end sched_serve_highest(void *state);

/* Nobody; or once around all others, from a random one on. */
unsigned sched_no_victim(void *state, unsigned attempt);
unsigned sched_any_victim(void *state, unsigned attempt);

int sched_never_chain(void *state, const duite_ready *task);
/* Where the last two would place it. */
int sched_chain_warm(void *state, const duite_ready *task);
int sched_chain_owner(void *state, const duite_ready *task);

#endif
