#ifndef DUITE_TASK_ABOVE_H
#define DUITE_TASK_ABOVE_H

#include <duite.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Functions of the workers that task/, plan/ and offload/ call. They know
 * only the names: workers/ defines the functions. `worker` is the caller. */
struct task;
struct task_graph;
struct task_scope;
struct work_pool;
struct worker;

/* A task may run. A SEND may be posted, and ends with work_finish when its bytes are gone; so do
 * NODE_SEND and NODE_RECEIVE when their message is written or read. */
void work_ready(struct work_pool *pool, struct worker *worker, struct task *task);

/* The task of another rank with this top scope is over, with all its descendants. */
void work_offloaded_over(struct task_scope *top, struct worker *worker);

/* So many more tasks of the main program are over; -1: one more is to come. work_over_one: one is
 * over, the usual case. */
void work_over(struct work_pool *pool, struct worker *worker, int tasks);
void work_over_one(struct work_pool *pool, struct worker *worker);

/* About how many bodies ran on this rank so far, and the seconds in them. Main thread. */
void work_bodies(struct work_pool *pool, uint64_t *bodies, double *seconds);

/* Something happened that the main program may wait for. pool NULL: nobody waits any more. */
void work_notify(struct work_pool *pool);

/* Checking mode: calls the body of the task with that number, and returns its code. */
int work_check_body(struct work_pool *pool, const duite_kernel *kernel, uint64_t number,
                    duite_call *call);

#pragma GCC visibility pop

#endif
