#ifndef DUITE_TASK_PARTS_H
#define DUITE_TASK_PARTS_H

#include "runtime/task/task.h"

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Parts of objects. `body` NULL: the call is the main program's. */

extern const duite_kernel task_split_kernel, task_join_kernel;

/* The object becomes n parts of so many elements. Errors: objects, DUITE_E_ARGUMENT, DUITE_E_SIZE,
 * memory. */
int task_split(struct task_graph *graph, struct duite_call_private *body, struct worker *worker,
               duite_object object, size_t n, const size_t *counts);
/* The object and its n parts, as the tasks of split and join name them, until the join; NULL, with
 * the error's message: it is not split, or a part is. */
const duite_object *task_split_names(struct task_graph *graph, struct duite_call_private *body,
                                     duite_object object, size_t *n);
/* The object is whole again, and its parts are gone. Errors: objects, memory. */
int task_join(struct task_graph *graph, struct duite_call_private *body, struct worker *worker,
              duite_object object);

#pragma GCC visibility pop

#endif
