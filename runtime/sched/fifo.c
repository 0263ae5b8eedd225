/* fifo: one queue for all, served in the order in which tasks became ready. The baseline that
 * balances best and ignores affinity. */
#include "runtime/sched/sched.h"

const duite_scheduler sched_fifo = {
    .name = "fifo",
    .summary = "one queue for all, oldest first",
    .place = sched_place_shared,
    .serve = sched_serve_oldest,
    .victim = sched_no_victim,
    .chain = sched_never_chain,
};
