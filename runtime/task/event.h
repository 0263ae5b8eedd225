#ifndef DUITE_TASK_EVENT_H
#define DUITE_TASK_EVENT_H

#include "runtime/task/task.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Tasks that end later than their bodies: event.c. */

/* What holds a HELD task. A BODY has it in its task_rest, a plan those of its nodes. */
struct task_held {
    _Atomic(const struct data_failure *) failure; /* the first one of the body and the events */
    _Atomic uint32_t left; /* events that are not completed, and 1 while the body runs */
};

/* Its offset in task_rest, behind the round (task_round_at). */
static inline size_t task_held_at(size_t args_size)
{
    return task_round_at(args_size) + sizeof(uint64_t);
}

static inline struct task_held *task_held_of(const struct task_graph *graph, struct task *task)
{
    const size_t args_size = graph->kernels[task->kernel]->args_size;
    return (void *)((char *)task_rest(task, task->n) + task_held_at(args_size));
}

/* The body is about to run, or its inputs are poisoned. */
void task_held_start(struct task_held *held);

/* The body or an event failed: the first failure counts when the task ends. Any thread. */
void task_held_fail(struct task_held *held, const struct data_failure *failure);

/* The body is over, or an event is completed. Returns whether nothing holds the task any more; else
 * the caller has the task no more. Any thread. */
bool task_held_release(struct task_held *held);

/* Ends a BODY whose body is over, unless an event is not completed (HELD), or all of whose events
 * are completed, too (ENDED). The caller has the task no more. */
void task_held_over(struct task_graph *graph, struct worker *worker, struct task *task);

/* duite_complete. Any thread. Errors: DUITE_E_OBJECT. */
int task_complete(struct task_graph *graph, duite_event event, int code);

/* Waits until no thread is in task_complete any more. All tasks are over. */
void task_events_settle(struct task_graph *graph);

/* Requests that a task of the graph waits for are over, and the guest with them. Returns the task
 * if nothing holds it any more: it is ENDED, to be finished by the caller or by task_end_later. */
struct task *task_guest_over(struct task_graph *graph, struct comm_guest *guest);
/* Hands an ENDED task to the workers. Any thread; the program may stop the runtime. */
void task_end_later(struct task_graph *graph, struct task *task);

/* How many events the program has not completed. Shows these, and those that complete with n
 * requests of MPI; else n is 0. Any thread. */
uint32_t task_events_pending(struct task_graph *graph);
typedef void task_event_seen(void *context, const struct task *task, duite_event event, int n);
void task_events_look(struct task_graph *graph, task_event_seen *seen, void *context);

#pragma GCC visibility pop

#endif
