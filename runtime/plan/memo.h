#ifndef DUITE_PLAN_MEMO_H
#define DUITE_PLAN_MEMO_H

#include "runtime/task/task.h"

/* Repeated forks are recognised: if a main program forks the same tasks round after round,
 * arguments aside, they are replayed without being asked for. Bytes, failures, numbers and windows
 * stay the same. Main thread of a runtime of one rank.
 *
 * Each fork is hashed (kernel and objects). When the last forks repeat those before them, and
 * bodies are short, the next round is recorded while it is forked, and compiled to a plan. Then
 * each fork that is the expected one becomes a run of its node, in an open replay. Any other fork
 * or call closes that. Only forks without options, of plain kernels that write something, on
 * objects of fixed size are recognised. */
struct plan_memo;

/* Always: replays even long bodies. NULL without memory. */
struct plan_memo *plan_memo_new(struct task_graph *graph, struct worker *worker, bool always);
/* No task is left: frees it. NULL is fine. */
void plan_memo_stop(struct plan_memo *memo);

/* A fork without options by the main program, outside builds and with homes settled. True: it is
 * made. */
bool plan_memo_fork(struct plan_memo *memo, const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects);
/* Any other call of the main program comes. */
void plan_memo_break(struct plan_memo *memo);

/* Adds the tasks so far, and the whole rounds of plans, that were recognised. */
void plan_memo_count(const struct plan_memo *memo, duite_counters *counters);

#endif
