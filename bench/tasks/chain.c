/* One object that every task changes: nothing but the hand-over from one task to the next. */
#include "bench/tasks/tasks.h"

#include <stdio.h>

static problem_link *const volatile NEXT = problem_next;

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"dynamic", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", "starpu", NULL};
    unsigned tasks = options->quick ? 200 : 20000;
    char size[40];
    snprintf(size, sizeof size, "tasks=%u", tasks);
    tasks_plan_contest(
        measure, options,
        &(struct tasks_contest){
            .name = "chain", .size = size, .tasks = tasks, .variants = variants, .rivals = rivals});
}

static int next(const duite_call *call)
{
    problem_next(duite_out(call, 0, uint64_t), *(const uint64_t *)call->args);
    return 0;
}

const duite_kernel tasks_chain_next = {
    .name = "chain_next", .body = next, .access = {DUITE_RW}, .args_size = sizeof(uint64_t)};

static int time_chain(duite *rt, duite_object object, uint64_t n, double *value)
{
    uint64_t got = 0;
    duite_set(rt, object, NULL);
    if (duite_wait(rt))
        return tasks_code(1);
    double start = serve_seconds();
    for (uint64_t i = 0; i < n; i++)
        duite_fork(rt, &tasks_chain_next, &i, 1, &object);
    int code = duite_wait(rt);
    *value = serve_seconds() - start;
    if (code || duite_get(rt, object, &got))
        return tasks_code(1);
    return got == problem_chain(n, &NEXT) ? 0 : serve_fail("wrong answer");
}

static int dynamic(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    uint64_t n = serve_number(request, "tasks");
    duite_object object;
    int code = tasks_ready(session, request);
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, 1, &object);
    if (code)
        return code;
    code = time_chain(session->rt, object, n, value);
    if (!code)
        code = time_chain(session->rt, object, n, value);
    tasks_free_objects(session, 1, &object);
    return code;
}

static int sequential(void *context, struct serve_request *request, double *value)
{
    uint64_t n = serve_number(request, "tasks"), warm = problem_chain(n, &NEXT);
    (void)context;
    double start = serve_seconds();
    uint64_t got = problem_chain(n, &NEXT);
    *value = serve_seconds() - start;
    return got == warm ? 0 : serve_fail("wrong answer");
}

static const struct serve_run RUNS[] = {
    {"chain_dynamic", dynamic}, {"chain_sequential", sequential}, {0}};

const struct bench_case tasks_chain = {"chain", "tasks that all change one object (rw)", plan,
                                       RUNS};
