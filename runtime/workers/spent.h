#ifndef DUITE_WORKERS_SPENT_H
#define DUITE_WORKERS_SPENT_H

#include <stdatomic.h>
#include <stdint.h>

/* Ticks that one worker spent for each block of its rank. The worker adds; the main thread takes
 * what was added since it took last, at any time. */
struct work_spent_for {
    _Atomic uint64_t ticks;
    uint64_t taken; /* of them; the main thread's */
};

enum { WORK_SPENT_ROWS = 33 };

/* Zeroed to begin with. Row k, made when it is needed and never moved, has 2^k blocks. */
struct work_spent {
    _Alignas(64) struct work_spent_for otherwise; /* for no block */
    _Atomic(struct work_spent_for *) row[WORK_SPENT_ROWS];
};

/* Without memory they are forgotten. */
void work_spend(struct work_spent *spent, uint32_t block, uint64_t ticks);
void work_spend_else(struct work_spent *spent, uint64_t ticks);
uint64_t work_spent_take(struct work_spent *spent, uint32_t block);
uint64_t work_spent_take_else(struct work_spent *spent);
void work_spent_free(struct work_spent *spent);

#endif
