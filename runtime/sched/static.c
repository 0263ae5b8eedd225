/* static: the worker of each block is fixed, its tasks run in the order in which they became ready,
 * and nobody steals. The baseline of every comparison: data stay where they are, and uneven blocks
 * stay uneven. */
#include "runtime/sched/sched.h"

const duite_scheduler sched_static = {
    .name = "static",
    .summary = "a fixed worker for each block of objects, no stealing",
    .state_size = sizeof(struct sched_state),
    .start = sched_start,
    .place = sched_place_owner,
    .serve = sched_serve_oldest,
    .victim = sched_no_victim,
    .chain = sched_chain_owner,
};
