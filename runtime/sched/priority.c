/* priority: one queue for all, served by the priorities that forks name, and in the order in which
 * tasks became ready among equals. Nothing runs directly after what made it ready: something more
 * urgent may wait. */
#include "runtime/sched/sched.h"

static unsigned place(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return DUITE_SHARED_QUEUE;
}

static duite_end serve(void *state)
{
    (void)state;
    return DUITE_HIGHEST;
}

static unsigned victim(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

static int chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return 0;
}

const duite_scheduler sched_priority = {
    .name = "priority",
    .summary = "one queue for all, the largest priority first",
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
