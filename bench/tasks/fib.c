/* Tasks that fork tasks: Fibonacci numbers by the book. Once as OpenMP does it, a call forks a
 * task, calls itself, and waits for the number that the task leaves in an object; once by handing
 * on the right to write the result, without any waiting ("flow"). A figure is the time of a core
 * for a call. */
#include "bench/tasks/fib.h"
#include "bench/tasks/tasks.h"

#include <stdio.h>

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"", "flow", NULL};
    unsigned n = options->quick ? 8 : 22;
    char size[40];
    snprintf(size, sizeof size, "n=%u", n);
    tasks_plan_contest(measure, options,
                       &(struct tasks_contest){.name = "fib",
                                               .size = size,
                                               .tasks = (double)problem_fib_calls(n),
                                               .core = true,
                                               .variants = variants,
                                               .rivals = tasks_forking_rivals});
    const struct measure_series *series[2];
    for (unsigned i = 0; i < 2; i++) {
        unsigned threads = i ? options->threads : 1;
        series[i] = measure_series(measure, tasks_ours(threads), "fib n=%u threads=%u scheduler=%s",
                                   n, threads, options->scheduler);
    }
    measure_ratio(measure, series[0], series[1], "fib_speedup_t%u", options->threads);
}

static int fib(const duite_call *call)
{
    return fib_wait(call, &tasks_fib);
}

static int flow(const duite_call *call)
{
    unsigned n = *(const unsigned *)call->args;
    const duite_object result = call->param[0].object;
    duite_object a, b;
    if (n < 2)
        return DUITE_FORK(call->rt, &tasks_fib_put, &n, result);
    duite_new(call->rt, DUITE_I64, 1, &a);
    duite_new(call->rt, DUITE_I64, 1, &b);
    DUITE_FORK(call->rt, &tasks_fib_flow, DUITE_ARGS(unsigned, n - 1), a);
    DUITE_FORK(call->rt, &tasks_fib_flow, DUITE_ARGS(unsigned, n - 2), b);
    return DUITE_FORK(call->rt, &tasks_fib_add, NULL, a, b, result);
}

static int put(const duite_call *call)
{
    *duite_out(call, 0, int64_t) = *(const unsigned *)call->args;
    return 0;
}

static int add(const duite_call *call)
{
    *duite_out(call, 2, int64_t) = *duite_in(call, 0, int64_t) + *duite_in(call, 1, int64_t);
    return 0;
}

const duite_kernel tasks_fib = {
    .name = "fib", .body = fib, .access = {DUITE_W}, .args_size = sizeof(unsigned)};
const duite_kernel tasks_fib_flow = {
    .name = "fib_flow", .body = flow, .access = {DUITE_WP}, .args_size = sizeof(unsigned)};
const duite_kernel tasks_fib_put = {
    .name = "fib_put", .body = put, .access = {DUITE_W}, .args_size = sizeof(unsigned)};
const duite_kernel tasks_fib_add = {
    .name = "fib_add", .body = add, .access = {DUITE_R, DUITE_R, DUITE_W}};

static int time_fib(duite *rt, const duite_kernel *kernel, unsigned n, duite_object object,
                    double *value)
{
    int64_t got = -1;
    if (duite_wait(rt))
        return tasks_code(1);
    double start = serve_seconds();
    DUITE_FORK(rt, kernel, &n, object);
    int code = duite_wait(rt);
    *value = serve_seconds() - start;
    if (code || duite_get(rt, object, &got))
        return tasks_code(1);
    return got == problem_fib(n) ? 0 : serve_fail("wrong answer");
}

static int run(struct tasks_session *session, struct serve_request *request,
               const duite_kernel *kernel, double *value)
{
    unsigned n = (unsigned)serve_number(request, "n");
    duite_object object;
    int code = tasks_ready(session, request);
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, 1, &object);
    if (code)
        return code;
    code = time_fib(session->rt, kernel, n, object, value);
    if (!code)
        code = time_fib(session->rt, kernel, n, object, value);
    tasks_free_objects(session, 1, &object);
    return code;
}

static int waiting(void *context, struct serve_request *request, double *value)
{
    return run(context, request, &tasks_fib, value);
}

static int flowing(void *context, struct serve_request *request, double *value)
{
    return run(context, request, &tasks_fib_flow, value);
}

static int sequential(void *context, struct serve_request *request, double *value)
{
    unsigned n = (unsigned)serve_number(request, "n");
    int64_t warm = problem_fib(n);
    (void)context;
    double start = serve_seconds();
    int64_t got = problem_fib(n);
    *value = serve_seconds() - start;
    return got == warm ? 0 : serve_fail("wrong answer");
}

static const struct serve_run RUNS[] = {
    {"fib", waiting}, {"fib_flow", flowing}, {"fib_sequential", sequential}, {0}};

const struct bench_case tasks_fib_case = {"fib", "tasks that fork and wait: Fibonacci numbers",
                                          plan, RUNS, 0};
