#ifndef BENCH_TASKS_FIB_H
#define BENCH_TASKS_FIB_H

#include <duite.h>

/* A Fibonacci number by the book: forks a task for the first of two and calls itself for the other,
 * as programs do that fork and join. */
static inline int fib_number(duite *rt, const duite_kernel *kernel, unsigned n, int64_t *number)
{
    int64_t first;
    duite_object object;
    if (n < 2) {
        *number = n;
        return 0;
    }
    duite_new(rt, DUITE_I64, 1, &object);
    DUITE_FORK(rt, kernel, DUITE_ARGS(unsigned, n - 1), object);
    int code = fib_number(rt, kernel, n - 2, number);
    if (!code)
        code = duite_get(rt, object, &first);
    if (!code)
        *number += first;
    return code;
}

/* The body of a task that writes it. args: n, unsigned; parameter 0: the number, int64_t, w. */
static inline int fib_wait(const duite_call *call, const duite_kernel *kernel)
{
    return fib_number(call->rt, kernel, *(const unsigned *)call->args, duite_out(call, 0, int64_t));
}

#endif
