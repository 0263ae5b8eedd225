#ifndef DUITE_TASK_BODY_H
#define DUITE_TASK_BODY_H

#include "runtime/task/task.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* A running body, and the functions behind its calls. They run on the body's thread. */

struct duite_call_private {
    struct duite_call_private *outer; /* the body that waits below on this thread */
    struct task_graph *graph;
    struct worker *worker;
    struct task *task;
    struct task_held *held;   /* of a HELD task; of others unset */
    const duite_param *param; /* as the runtime keeps them */
    struct task_scope *scope; /* what its children may use, or NULL as long as it has none */
    int refused;       /* code of a duite_resize or duite_contribute that failed, or 0: the body
                          then fails at least with it; DUITE_E_STATE: it holds MPI */
    int remembered;    /* the first error of its calls that it may not have looked at */
    char message[204]; /* of `remembered` */
    char text[sizeof((struct data_failure *)0)->text]; /* its message about its failure */
};

/* The innermost body on this thread, or NULL. task_running: the same if it runs for this graph. */
extern _Thread_local struct duite_call_private *task_innermost
    __attribute__((tls_model("initial-exec")));
/* A mark that only the calling thread has, found without a call. */
static inline const void *task_thread_mark(void)
{
    return &task_innermost;
}
static inline struct duite_call_private *task_running(const struct task_graph *graph)
{
    struct duite_call_private *body = task_innermost;
    return body && body->graph == graph ? body : NULL;
}

/* True between the body's duite_mpi_begin and duite_mpi_end. */
static inline bool task_holds_mpi(const struct duite_call_private *body)
{
    return comm_guests_are_held(&body->graph->guests, body);
}

/* True if a body, running or just over, forked a task or made an object. */
static inline bool task_body_forked(const duite_call *call)
{
    return call->own->scope != NULL;
}

/* The scope of a running body, made when it is first asked for. NULL without memory. */
struct task_scope *task_scope_begin(struct duite_call_private *body);
static inline struct task_scope *task_inside(struct duite_call_private *body)
{
    return body->scope ? body->scope : task_scope_begin(body);
}

/* Makes an object that belongs to the task, of `count` zeros; at most `max` elements if its size
 * changes. Errors: type, count, memory. */
int task_make_object(struct duite_call_private *body, duite_type type, size_t count, size_t max,
                     bool sized, duite_object *name);

/* True if all tasks forked in this scope are over, with their descendants. */
bool task_alone(struct task_scope *scope);

/* From now on, the body's actions come after the tasks that it forked so far. */
static inline void task_close_segment(struct task_scope *scope)
{
    scope->segment = ++scope->forks;
}

/* The first failure among the tasks of this scope and their descendants since the last time, or
 * NULL. */
const struct data_failure *task_first_failure(struct task_scope *scope);

/* DUITE_E_RIGHT or DUITE_E_OBJECT if a child of the body could not have the object with this mode.
 */
int task_check_call(struct duite_call_private *body, const char *call, duite_object object,
                    duite_mode wanted);
/* The version of the object that the forks so far leave, and the size of an element in bytes. The
 * version is or will be here, and stays the object's until the body's next call. Errors: those of
 * task_check_call for a child that reads; memory. */
int task_see(struct duite_call_private *body, const char *call, duite_object name,
             struct data_version **version, size_t *size);
/* The same version if nothing is to be done for it; else NULL. */
struct data_version *task_see_given(struct duite_call_private *body, duite_object name);
/* True if the object is a parameter of the body. Its name was checked. */
bool task_lent(const struct duite_call_private *body, duite_object object);

/* True if a body that waits in `scope` may run this task on top. It may run its descendants. If its
 * descendants may wait for tasks outside, it may also run tasks that come earlier in the reference
 * order. Local bodies may run all offloaded tasks and their descendants. Bodies of offloaded tasks
 * and of their descendants may run those that come earlier in the order of all ranks. */
bool task_may_run_other(const struct task_scope *scope, const struct task *task);
/* True if the task descends from the body of this scope. */
bool task_descends(const struct task_scope *scope, const struct task *task);
/* True if a comes before b in the reference order; offloaded tasks and their descendants come
 * before all others. Both may run on top of one body, and neither descends from the other. */
bool task_is_earlier(const struct task *a, const struct task *b);
static inline bool task_may_run(const struct task_scope *scope, const struct task *task)
{
    return task->scope == scope || task_may_run_other(scope, task); /* most are its children */
}

#pragma GCC visibility pop

#endif
