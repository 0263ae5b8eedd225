#ifndef TESTS_RUNTIME_DELEGATION_H
#define TESTS_RUNTIME_DELEGATION_H

#include <duite.h>
#include <stdatomic.h>

/* Shared by the tests of tasks that run on other ranks. */

enum { TASKS = 40 };

/* Adds what it reads and its argument: a sum over what all kinds of parameters hold. */
extern const duite_kernel MIX;
/* One element more than there were, each as large as their number. */
extern const duite_kernel GROW;

/* A runtime of one thread a rank with these kernels, ended by NULL, and the balancer of that name.
 * NULL, and a comment that says why, if it does not start. */
duite *delegation_start(const duite_kernel *const *kernels, const char *balance);

/* A number that lives where the leader does. */
duite_object delegation_beside(duite *rt, duite_object leader);

/* -1 if it cannot be got. */
int32_t delegation_value(duite *rt, duite_object number);

/* Waits; the tasks so far, of all ranks, that ran on another rank. */
uint64_t delegation_count(duite *rt);

/* Cases that ask whether all values are those of fork order. `fork` forks what does MIX's work on
 * one of TASKS objects, once or several times; all objects live on one rank, and what is read is 7.
 * An object then holds `start` and `each` times its number. The object that all overwrite holds
 * `last` times the last number; the one that they contribute to, `each` times the sum of the
 * numbers. Bodies run on other ranks if and only if they may. */
struct delegation_values {
    void (*fork)(duite *rt, int32_t number, const duite_object object[4]);
    int32_t start, each, last;
    const atomic_int *ran; /* bodies on this rank that fork MIX, if such are forked */
};
void delegation_values(duite *rt, const char *balance, const struct delegation_values *values);

/* A TAP line of a case by that balancer, as tap_case. */
void delegation_say(const char *balance, const char *what, int right);

#endif
