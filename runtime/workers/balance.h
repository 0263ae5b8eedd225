#ifndef DUITE_WORKERS_BALANCE_H
#define DUITE_WORKERS_BALANCE_H

#include "runtime/task/task.h"

#include <duite_policy.h>

/* What workers do for a balancer: they measure what bodies cost, ask other ranks for tasks when
 * there are none, and give some to those who ask. A pool without a balancer, or with one that moves
 * nothing, or on one rank, has none of this (NULL). */
struct work_balance;
struct work_pool;
struct worker;

/* The pool has its setup and its workers. *balance NULL: nothing moves. Errors: memory. */
int work_balance_start(struct work_balance **balance, struct work_pool *pool);
void work_balance_stop(struct work_pool *pool); /* it may have none */

/* A task became ready: true if it was sent to another rank. */
bool work_placed_away(struct worker *worker, struct task *task);

/* A task of another rank came. */
void work_offloaded_came(struct work_balance *balance, const struct task *task);

/* A task is about to run: one of the last of other ranks', with nothing else here, is the moment to
 * ask for more. Whether that took time. */
bool work_begins(struct worker *worker, const struct task *task);

/* The body of a task took so many ticks. */
void work_learn(struct worker *worker, const struct task *task, uint64_t ticks);

/* Between tasks: gives to those who ask. */
void work_serve(struct worker *worker);

/* The worker, which polls for all that idle, has nothing to do since so many ticks: asks. */
void work_beg(struct worker *worker, uint64_t idle);

#endif
