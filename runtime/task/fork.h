#ifndef DUITE_TASK_FORK_H
#define DUITE_TASK_FORK_H

#include "runtime/task/task.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Forks. In the main program the scope is the graph's root: collective, the homes of all objects
 * are settled. In a body it is the body's own: local, and the task runs here. */

/* A fork's options. Priority and cost are the running rank's and stay out of the fingerprint. */
struct task_options {
    int at; /* a rank, or TASK_ANYWHERE */
    int32_t priority;
    double cost;    /* seconds; 0: not said */
    uint64_t round; /* of the replay that forks it; task_fork_any alone looks at it */
};

extern const struct task_options task_no_options;

int task_fork(struct task_scope *scope, struct worker *worker, const struct task_options *options,
              const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects);
/* The same without options, for the main program of several ranks. */
int task_fork_ranks(struct task_graph *graph, struct worker *worker, const duite_kernel *kernel,
                    const void *args, size_t n, const duite_object *objects);
/* The same by the general way, for rounds of replays. */
int task_fork_any(struct task_scope *scope, struct worker *worker,
                  const struct task_options *options, const duite_kernel *kernel, const void *args,
                  size_t n, const duite_object *objects);
/* The same without options: for the main program, and for a body. */
int task_fork_main(struct task_graph *graph, struct worker *worker, const duite_kernel *kernel,
                   const void *args, size_t n, const duite_object *objects);
int task_fork_nested(struct task_scope *scope, struct worker *worker, const duite_kernel *kernel,
                     const void *args, size_t n, const duite_object *objects);

#pragma GCC visibility pop

#endif
