/* One object that every task changes: nothing but the hand-over from one task to the next. */
#include "bench/tasks/tasks.h"

#include <stdio.h>

static problem_link *const volatile NEXT = problem_next;

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"replay", "dynamic", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", "starpu", NULL};
    unsigned tasks = PROBLEM_PERIOD * (options->quick ? 4 : 320);
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

static int fork_round(duite *rt, void *context)
{
    const duite_object *object = context;
    int code = 0;
    for (uint64_t i = 0; i < PROBLEM_PERIOD; i++)
        code |= duite_fork(rt, &tasks_chain_next, &i, 1, object);
    return code;
}

static int time_chain(struct tasks_rounds *rounds, double *value)
{
    const duite_object *object = rounds->context;
    uint64_t got = 0;
    duite_set(rounds->rt, *object, NULL);
    if (tasks_run(rounds, value))
        return 1;
    if (duite_get(rounds->rt, *object, &got))
        return tasks_code(1);
    return got == problem_chain(rounds->rounds * PROBLEM_PERIOD, &NEXT)
               ? 0
               : serve_fail("wrong answer");
}

static int run(struct tasks_session *session, struct serve_request *request, bool replayed,
               double *value)
{
    uint64_t n = serve_number(request, "tasks");
    duite_object object;
    int code = tasks_ready(session, request);
    if (!code)
        code = tasks_objects(session, DUITE_I64, 1, 1, &object);
    if (code)
        return code;
    struct tasks_rounds rounds = {.rt = session->rt,
                                  .fork = fork_round,
                                  .context = &object,
                                  .rounds = n / PROBLEM_PERIOD,
                                  .replayed = replayed};
    code = tasks_record(&rounds);
    if (!code)
        code = time_chain(&rounds, value);
    if (!code)
        code = time_chain(&rounds, value);
    tasks_forget(&rounds);
    tasks_free_objects(session, 1, &object);
    return code;
}

static int dynamic(void *context, struct serve_request *request, double *value)
{
    return run(context, request, false, value);
}

static int replay(void *context, struct serve_request *request, double *value)
{
    return run(context, request, true, value);
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
    {"chain_dynamic", dynamic}, {"chain_replay", replay}, {"chain_sequential", sequential}, {0}};

const struct bench_case tasks_chain = {"chain", "tasks that all change one object (rw)", plan, RUNS,
                                       0};
