#ifndef BENCH_TASKS_FIB_H
#define BENCH_TASKS_FIB_H

#include <duite.h>

/* The body of a task that writes a Fibonacci number by the book: it forks two of its kind and waits
 * for what they leave. args: n, unsigned; parameter 0: the number, int64_t, w. */
static inline int fib_wait(const duite_call *call, const duite_kernel *kernel)
{
    const unsigned n = *(const unsigned *)call->args;
    int64_t first, second;
    duite_object a, b;
    if (n < 2) {
        *duite_out(call, 0, int64_t) = n;
        return 0;
    }
    duite_new(call->rt, DUITE_I64, 1, &a);
    duite_new(call->rt, DUITE_I64, 1, &b);
    DUITE_FORK(call->rt, kernel, DUITE_ARGS(unsigned, n - 1), a);
    DUITE_FORK(call->rt, kernel, DUITE_ARGS(unsigned, n - 2), b);
    int code = duite_get(call->rt, a, &first);
    if (!code)
        code = duite_get(call->rt, b, &second);
    if (!code)
        *duite_out(call, 0, int64_t) = first + second;
    return code;
}

#endif
