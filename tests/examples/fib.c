/* Fibonacci numbers by the book, a task a call: once by tasks that wait for their children and read
 * what these left, once by tasks that hand their right to write the result on and never wait. And
 * how many calls that takes, each of which counts itself. */

#include <duite.h>

#include <stdio.h>

enum { N = 18 };

static int fib(const duite_call *call);
static int flow(const duite_call *call);
static int calls(const duite_call *call);
static int put(const duite_call *call);
static int add(const duite_call *call);

static const duite_kernel FIB = {
    .name = "fib", .body = fib, .access = {DUITE_W}, .args_size = sizeof(int)};
static const duite_kernel FLOW = {
    .name = "flow", .body = flow, .access = {DUITE_WP}, .args_size = sizeof(int)};
static const duite_kernel CALLS = {
    .name = "calls", .body = calls, .access = {DUITE_CWP}, .args_size = sizeof(int)};
static const duite_kernel PUT = {
    .name = "put", .body = put, .access = {DUITE_W}, .args_size = sizeof(int)};
static const duite_kernel ADD = {.name = "add", .body = add, .access = {DUITE_R, DUITE_R, DUITE_W}};

static int fib(const duite_call *call)
{
    const int n = *(const int *)call->args;
    int64_t *result = duite_out(call, 0, int64_t), first = n, second = 0;
    duite_object a, b;
    if (n >= 2) {
        duite_new(call->rt, DUITE_I64, 1, &a);
        duite_new(call->rt, DUITE_I64, 1, &b);
        DUITE_FORK(call->rt, &FIB, DUITE_ARGS(int, n - 1), a);
        DUITE_FORK(call->rt, &FIB, DUITE_ARGS(int, n - 2), b);
        int code = duite_get(call->rt, a, &first);
        if (code || (code = duite_get(call->rt, b, &second)))
            return code;
    }
    *result = first + second;
    return 0;
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

static int calls(const duite_call *call)
{
    const int n = *(const int *)call->args;
    int64_t *count = duite_contribute(call, 0);
    if (!count)
        return DUITE_E_MEMORY;
    count[0] = 1;
    if (n < 2)
        return 0;
    DUITE_FORK(call->rt, &CALLS, DUITE_ARGS(int, n - 1), call->param[0].object);
    return DUITE_FORK(call->rt, &CALLS, DUITE_ARGS(int, n - 2), call->param[0].object);
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

static int run(duite *rt)
{
    int64_t waited = -1, flowed = -1, counted = -1, expected = 0, after = 1;
    duite_object x, y, z;
    duite_new(rt, DUITE_I64, 1, &x);
    duite_new(rt, DUITE_I64, 1, &y);
    duite_new(rt, DUITE_I64, 1, &z);
    DUITE_FORK(rt, &FIB, DUITE_ARGS(int, N), x);
    DUITE_FORK(rt, &FLOW, DUITE_ARGS(int, N), y);
    DUITE_FORK(rt, &CALLS, DUITE_ARGS(int, N), z);
    if (duite_get(rt, x, &waited) || duite_get(rt, y, &flowed) || duite_get(rt, z, &counted))
        fprintf(stderr, "fib: %s\n", duite_message());
    duite_free(rt, x);
    duite_free(rt, y);
    duite_free(rt, z);
    for (int i = 0; i < N; i++) {
        after += expected;
        expected = after - expected;
    }
    if (duite_rank(rt) == 0)
        printf("fib: %d and %d\n", (int)waited, (int)flowed);
    return waited != expected || flowed != expected || counted != 2 * after - 1;
}

int main(int argc, char **argv)
{
    duite_options options = duite_options_default();
    duite *rt;
    options.kernels = (const duite_kernel *const[]){&FIB, &FLOW, &CALLS, &PUT, &ADD, NULL};
    if (argc > 1)
        options.scheduler = duite_scheduler_find(argv[1]);
    if (duite_start(&rt, &options))
        return fprintf(stderr, "fib: %s\n", duite_message()), 1;
    int wrong = run(rt);
    if (duite_stop(&rt)) /* tells the errors that nobody asked for */
        return fprintf(stderr, "fib: %s\n", duite_message()), 1;
    return wrong;
}
