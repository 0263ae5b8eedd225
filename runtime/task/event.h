#ifndef DUITE_TASK_EVENT_H
#define DUITE_TASK_EVENT_H

#include "runtime/task/task.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Tasks that end later than their bodies: event.c. */

/* The offset in task_rest of a HELD task's failure, behind its round (task_round_at). */
static inline size_t task_held_at(size_t args_size)
{
    return task_round_at(args_size) + sizeof(uint64_t);
}

/* The body of a HELD task is about to run, or its inputs are poisoned. */
void task_held_start(struct task *task);

/* The body or an event failed: the first failure counts when the task ends. Any thread. */
void task_held_fail(struct task *task, const struct data_failure *failure);

/* Ends a task whose body is over, unless an event is not completed (HELD), or all of whose events
 * are completed, too (ENDED). The caller has the task no more. */
void task_held_over(struct task_graph *graph, struct worker *worker, struct task *task);

/* duite_complete. Any thread. Errors: DUITE_E_OBJECT. */
int task_complete(struct task_graph *graph, duite_event event, int code);

/* Waits until no thread is in task_complete any more. All tasks are over. */
void task_events_settle(struct task_graph *graph);

/* For comm_guests: requests that a task of the graph waits for are over. */
comm_guest_over task_guest_over;

/* How many events the program has not completed. Shows these, and those that complete with n
 * requests of MPI; else n is 0. Any thread. */
uint32_t task_events_pending(struct task_graph *graph);
typedef void task_event_seen(void *context, const struct task *task, duite_event event, int n);
void task_events_look(struct task_graph *graph, task_event_seen *seen, void *context);

#pragma GCC visibility pop

#endif
