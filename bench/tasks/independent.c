/* Tasks without objects: each leaves its mark, and all marks are counted. */
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <stdlib.h>

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"dynamic", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", "starpu", NULL};
    unsigned tasks = options->quick ? 200 : 20000;
    char size[40];
    snprintf(size, sizeof size, "tasks=%u", tasks);
    tasks_plan_contest(measure, options,
                       &(struct tasks_contest){.name = "independent",
                                               .size = size,
                                               .tasks = tasks,
                                               .variants = variants,
                                               .rivals = rivals});
}

static int mark(const duite_call *call)
{
    struct tasks_session *session = call->context;
    problem_mark(session->mark, *(const uint64_t *)call->args);
    return 0;
}

const duite_kernel tasks_independent_mark = {
    .name = "independent_mark", .body = mark, .args_size = sizeof(uint64_t)};

static int time_tasks(struct tasks_session *session, uint64_t n, double *value)
{
    double start = serve_seconds();
    for (uint64_t i = 0; i < n; i++)
        duite_fork(session->rt, &tasks_independent_mark, &i, 0, NULL);
    int code = duite_wait(session->rt);
    *value = serve_seconds() - start;
    if (code)
        return tasks_code(code);
    return problem_marks_wrong(session->mark, n) ? serve_fail("wrong answer") : 0;
}

static int dynamic(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    uint64_t n = serve_number(request, "tasks");
    int code = tasks_ready(session, request);
    if (code)
        return code;
    session->mark = calloc(n, sizeof *session->mark);
    if (!session->mark)
        return serve_no_memory();
    code = time_tasks(session, n, value);
    if (!code)
        code = time_tasks(session, n, value);
    free(session->mark);
    return code;
}

static int sequential(void *context, struct serve_request *request, double *value)
{
    static problem_mark_body *const volatile body = problem_mark;
    uint64_t n = serve_number(request, "tasks");
    uint64_t *marks = calloc(n, sizeof *marks);
    (void)context;
    if (!marks)
        return serve_no_memory();
    for (int warm = 1; warm >= 0; warm--) {
        double start = serve_seconds();
        for (uint64_t i = 0; i < n; i++)
            body(marks, i);
        *value = serve_seconds() - start;
        if (warm)
            problem_marks_wrong(marks, n);
    }
    int wrong = problem_marks_wrong(marks, n);
    free(marks);
    return wrong ? serve_fail("wrong answer") : 0;
}

static const struct serve_run RUNS[] = {
    {"independent_dynamic", dynamic}, {"independent_sequential", sequential}, {0}};

const struct bench_case tasks_independent = {"independent", "tasks that share nothing", plan, RUNS,
                                             0};
