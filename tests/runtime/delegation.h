#ifndef TESTS_RUNTIME_DELEGATION_H
#define TESTS_RUNTIME_DELEGATION_H

#include <duite.h>

/* What the tests of tasks that run on other ranks share. */

/* A runtime of one thread a rank with these kernels, ended by NULL, and the balancer of that name.
 * NULL, and a comment that says why, if it does not start. */
duite *delegation_start(const duite_kernel *const *kernels, const char *balance);

/* A number that lives where the leader does. */
duite_object delegation_beside(duite *rt, duite_object leader);

/* -1 if it cannot be got. */
int32_t delegation_value(duite *rt, duite_object number);

/* Waits; the tasks so far, of all ranks, that ran on another rank. */
uint64_t delegation_count(duite *rt);

/* A TAP line of a case by that balancer, as tap_case. */
void delegation_say(const char *balance, const char *what, int right);

#endif
