/* lifo: one queue for all, newest first. A new task runs while its data are warm, on any worker;
 * the oldest may starve until the rest is done. */
#include "runtime/sched/sched.h"

const duite_scheduler sched_lifo = {
    .name = "lifo",
    .summary = "one queue for all, newest first",
    .place = sched_place_shared,
    .serve = sched_serve_newest,
    .victim = sched_no_victim,
    .chain = sched_never_chain,
};
