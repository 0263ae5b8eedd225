/* priority: one queue for all, served by the priorities that forks name. Equals come by the longest
 * path to the end of their recorded graph, then the one ready first. No task runs inline: a more
 * urgent one may wait. Longest paths: the critical path method of Kelley & Walker, 1959; as a rule
 * for schedules Hu, Parallel sequencing and assembly line problems, Operations Research 9(6),
 * 1961. */
#include "runtime/sched/sched.h"

const duite_scheduler sched_priority = {
    .name = "priority",
    .summary = "one queue for all, the largest priority first, then the longest path to the end",
    .place = sched_place_shared,
    .serve = sched_serve_highest,
    .victim = sched_no_victim,
    .chain = sched_never_chain,
    .paths = 1,
};
