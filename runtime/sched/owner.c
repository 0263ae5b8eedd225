/* owner: each block of objects has a worker, which gets its tasks, newest first; an idle worker
 * takes the oldest of a random other. Data stay in the cache of one core, as with `static`, and
 * stealing evens out unequal work. After Markatos & LeBlanc, Using processor affinity in loop
 * scheduling on shared-memory multiprocessors, IEEE TPDS 5(4), 1994. */
#include "runtime/sched/sched.h"

const duite_scheduler sched_owner = {
    .name = "owner",
    .summary = "the worker of each block of objects, newest first; idle ones steal",
    .state_size = sizeof(struct sched_state),
    .start = sched_start,
    .place = sched_place_owner,
    .serve = sched_serve_newest,
    .victim = sched_any_victim,
    .chain = sched_chain_owner,
};
