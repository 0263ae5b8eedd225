/* steal: a worker keeps what it makes ready and works on the newest, whose data are warm; an idle
 * one takes the oldest of a random victim. After Blumofe & Leiserson, Scheduling multithreaded
 * computations by work stealing, JACM 46(5), 1999. In a replay the next task on the same data goes
 * to the worker that ran the last one: stolen data stay with the thief. After Acar, Blelloch &
 * Blumofe, The data locality of work stealing, SPAA 2000. */
#include "runtime/sched/sched.h"

const duite_scheduler sched_steal = {
    .name = "steal",
    .summary = "own newest first, steal the oldest of a random victim",
    .state_size = sizeof(struct sched_state),
    .start = sched_start,
    .place = sched_place_affinity,
    .serve = sched_serve_newest,
    .victim = sched_any_victim,
    .chain = sched_chain_affinity,
};
