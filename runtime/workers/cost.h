#ifndef DUITE_WORKERS_COST_H
#define DUITE_WORKERS_COST_H

#include "runtime/task/task.h"

#include <duite_policy.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* Ticks that one worker spent for each block of its rank. The worker adds; the main thread takes,
 * at any time, the ticks added since its last take. */
struct work_spent_for {
    _Atomic uint64_t ticks;
    uint64_t taken; /* of them; the main thread's */
};

enum { WORK_SPENT_ROWS = 33 };

/* Zeroed to begin with. Row k has 2^k blocks; it is made when it is needed and never moves. */
struct work_spent {
    _Atomic(struct work_spent_for *) row[WORK_SPENT_ROWS];
};

/* Adds ticks for a block, or DUITE_NO_BLOCK; without memory for a row they are dropped. Take:
 * returns the ticks added since the last take. */
void work_spend(struct work_spent *spent, uint32_t block, uint64_t ticks);
uint64_t work_spent_take(struct work_spent *spent, uint32_t block);
void work_spent_free(struct work_spent *spent);

/* The cost of bodies, measured by the workers of a rank: a mean for each kernel and, if blocks may
 * move, the ticks of each block. */
struct work_cost {
    unsigned workers;
    size_t row;
    _Atomic uint64_t *mean;   /* ticks, a row of kernels for each worker; 0: none ran */
    struct work_spent *spent; /* one a worker; NULL: blocks are not measured */
};

/* False without memory; work_cost_stop is due all the same. */
bool work_cost_start(struct work_cost *cost, unsigned workers, uint32_t kernels, bool by_block);
void work_cost_stop(struct work_cost *cost);
/* There are so many kernels now; no body runs. False without memory: nothing has changed. */
bool work_cost_grow(struct work_cost *cost, uint32_t kernels);

/* Notes the ticks that the body of a task took on `worker`, the caller. */
void work_cost_learn(struct work_cost *cost, unsigned worker, const struct task *task,
                     uint64_t ticks);

/* Mean ticks of a body of the kernel, over the workers that ran one; 0: none did. Any worker. */
double work_cost_mean(const struct work_cost *cost, uint32_t kernel);

/* Ticks since the last call in bodies that ran for the block. Main thread. */
uint64_t work_cost_take(struct work_cost *cost, uint32_t block);

#endif
