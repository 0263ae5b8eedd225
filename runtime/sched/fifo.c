/* fifo: one queue for all, served in the order in which tasks became ready. The baseline that
 * balances best and knows nothing of where data are warm. */
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
    return DUITE_OLDEST;
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

const duite_scheduler sched_fifo = {
    .name = "fifo",
    .summary = "one queue for all, oldest first",
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
