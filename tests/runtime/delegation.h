#ifndef TESTS_RUNTIME_DELEGATION_H
#define TESTS_RUNTIME_DELEGATION_H

#include <duite.h>
#include <stdatomic.h>

/* What the tests of tasks that run on other ranks share. */

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

/* Lets `fork` fork for each of TASKS objects what does MIX's work on it, also several times; all
 * that they touch lives on one rank, and they read 7. Cases ask whether all values are those of
 * fork order: `start` and `each` times its number in an object, `last` times its number in what all
 * overwrite, and `each` times the sum of the numbers in what they contribute to; and whether bodies
 * ran on other ranks if and only if they may. */
struct delegation_values {
    void (*fork)(duite *rt, int32_t number, const duite_object object[4]);
    int32_t start, each, last;
    const atomic_int *ran; /* bodies on this rank that fork MIX, if such are forked */
};
void delegation_values(duite *rt, const char *balance, const struct delegation_values *values);

/* A TAP line of a case by that balancer, as tap_case. */
void delegation_say(const char *balance, const char *what, int right);

#endif
