/* lifo: one queue for all, served from the end where tasks became ready last. What was made just
 * now is run while its data are warm, on whichever worker; the oldest may starve until the rest is
 * done.
 */
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
    return DUITE_NEWEST;
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

const duite_scheduler sched_lifo = {
    .name = "lifo",
    .summary = "one queue for all, newest first",
    .place = place,
    .serve = serve,
    .victim = victim,
    .chain = chain,
};
