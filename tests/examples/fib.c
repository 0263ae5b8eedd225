/* Fibonacci numbers by the book: a task a call. Once with tasks that wait for their children and
 * read what these left (fib), once with postponed rights and no waiting at all (flow): there the
 * task hands its right to write the result on to the child that adds. */

#include <duite.h>

#include <inttypes.h>
#include <stdio.h>

enum { N = 16 };

static int fib(const duite_call *call);
static int flow(const duite_call *call);
static int put(const duite_call *call);
static int add(const duite_call *call);

static const duite_kernel FIB = {
    .name = "fib", .body = fib, .access = {DUITE_W}, .args_size = sizeof(int)};
static const duite_kernel FLOW = {
    .name = "flow", .body = flow, .access = {DUITE_WP}, .args_size = sizeof(int)};
static const duite_kernel PUT = {
    .name = "put", .body = put, .access = {DUITE_W}, .args_size = sizeof(int)};
static const duite_kernel ADD = {.name = "add", .body = add, .access = {DUITE_R, DUITE_R, DUITE_W}};

static int fib(const duite_call *call)
{
    const int n = *(const int *)call->args;
    int64_t *result = duite_out(call, 0, int64_t);
    int64_t first, second;
    duite_object a, b;

    if (n < 2) {
        *result = n;
        return 0;
    }
    duite_new(call->rt, DUITE_I64, 1, &a);
    duite_new(call->rt, DUITE_I64, 1, &b);
    DUITE_FORK(call->rt, &FIB, DUITE_ARGS(int, n - 1), a);
    DUITE_FORK(call->rt, &FIB, DUITE_ARGS(int, n - 2), b);
    int code = duite_get(call->rt, a, &first);

    if (!code)
        code = duite_get(call->rt, b, &second);
    if (!code)
        *result = first + second;
    return code;
}

static int flow(const duite_call *call)
{
    const int n = *(const int *)call->args;
    const duite_object result = call->param[0].object;
    duite_object a, b;

    if (n < 2)
        return DUITE_FORK(call->rt, &PUT, &n, result);
    duite_new(call->rt, DUITE_I64, 1, &a);
    duite_new(call->rt, DUITE_I64, 1, &b);
    DUITE_FORK(call->rt, &FLOW, DUITE_ARGS(int, n - 1), a);
    DUITE_FORK(call->rt, &FLOW, DUITE_ARGS(int, n - 2), b);
    return DUITE_FORK(call->rt, &ADD, NULL, a, b, result);
}

static int put(const duite_call *call)
{
    *duite_out(call, 0, int64_t) = *(const int *)call->args;
    return 0;
}

static int add(const duite_call *call)
{
    *duite_out(call, 2, int64_t) = *duite_in(call, 0, int64_t) + *duite_in(call, 1, int64_t);
    return 0;
}

int main(int argc, char **argv)
{
    const duite_kernel *kernels[] = {&FIB, &FLOW, &PUT, &ADD, NULL};
    duite_options options = duite_options_default();
    int64_t expected = 0, after = 1, waited = -1, flowed = -1;
    duite_object x, y;
    duite *rt;

    options.kernels = kernels;
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options)) {
        fprintf(stderr, "fib: %s\n", duite_message());
        return 1;
    }
    for (int i = 0; i < N; i++) {
        const int64_t sum = expected + after;

        expected = after;
        after = sum;
    }
    duite_new(rt, DUITE_I64, 1, &x);
    duite_new(rt, DUITE_I64, 1, &y);
    DUITE_FORK(rt, &FIB, DUITE_ARGS(int, N), x);
    DUITE_FORK(rt, &FLOW, DUITE_ARGS(int, N), y);
    duite_get(rt, x, &waited);
    duite_get(rt, y, &flowed);
    duite_free(rt, x);
    duite_free(rt, y);

    const int print = duite_rank(rt) == 0;
    const int code = duite_stop(&rt);

    if (code)
        fprintf(stderr, "fib: %s\n", duite_message());
    if (print)
        printf("fib(%d) %" PRId64 " and %" PRId64 " expected %" PRId64 "\n", N, waited, flowed,
               expected);
    return code || waited != expected || flowed != expected;
}
