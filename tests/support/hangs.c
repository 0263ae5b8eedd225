/* A scheduler from a shared library that does not return from its 21st call on, until the file
 * NAMED of the environment is there. */
#include <duite_policy.h>
#include <stdlib.h>
#include <unistd.h>

static unsigned place(void *state, const duite_ready *task)
{
    const char *named = getenv("NAMED");
    (void)task;
    for (++*(int *)state; *(int *)state > 20 && access(named ? named : "", F_OK);)
        usleep(1000);
    return DUITE_SHARED_QUEUE;
}

static duite_end serve(void *state)
{
    (void)state;
    return DUITE_OLDEST;
}

static unsigned victim(void *state, unsigned attempt)
{
    (void)state, (void)attempt;
    return DUITE_NO_QUEUE;
}

static int chain(void *state, const duite_ready *task)
{
    (void)state, (void)task;
    return 0;
}

const duite_scheduler duite_own_scheduler = {.size = sizeof(duite_scheduler),
                                             .name = "hangs",
                                             .summary = "",
                                             .state_size = sizeof(int),
                                             .place = place,
                                             .serve = serve,
                                             .victim = victim,
                                             .chain = chain};
