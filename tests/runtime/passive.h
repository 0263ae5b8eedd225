#ifndef TESTS_RUNTIME_PASSIVE_H
#define TESTS_RUNTIME_PASSIVE_H

#include <duite_policy.h>

/* Answers of a scheduler that leaves each task where it was placed: oldest first, nothing is
 * stolen, nothing runs inline. Tests add what they look at. */

static inline duite_end passive_serve(void *state)
{
    (void)state;
    return DUITE_OLDEST;
}

static inline unsigned passive_victim(void *state, unsigned attempt)
{
    (void)state;
    (void)attempt;
    return DUITE_NO_QUEUE;
}

static inline int passive_chain(void *state, const duite_ready *task)
{
    (void)state;
    (void)task;
    return 0;
}

#endif
