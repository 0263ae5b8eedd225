#ifndef DUITE_PLAN_MEMO_H
#define DUITE_PLAN_MEMO_H

#include "runtime/task/task.h"

/* Repeated forks are recognised: if a main program forks the same tasks round after round,
 * arguments aside, they are replayed without being asked for. Bytes, failures, numbers and windows
 * stay the same. Main thread of a runtime of one rank.
 *
 * Each fork is hashed (kernel and objects). When the last forks repeat those before them, and
 * bodies are short, the next round is recorded while it is forked, and a thread compiles it to a
 * plan. Then each fork that is the expected one becomes a run of its node, in an open replay. Any
 * other fork or call closes that. Only forks without options, of plain kernels that write
 * something, on objects of fixed size are recognised. */

/* Always: replays even long bodies, and compiles plans at once. NULL without memory. */
struct task_taker *plan_memo_new(struct task_graph *graph, struct worker *worker, bool always);

#endif
