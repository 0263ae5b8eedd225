/* An unbalanced tree, one node a task: each task works out its children and forks a task for each,
 * and nobody waits but the main program for all. Nodes are counted by the worker that runs them, as
 * by the thread in OpenMP. */
#include "bench/tasks/tasks.h"

#include <stdio.h>
#include <string.h>

static void plan(struct measure *measure, const struct bench_options *options)
{
    static const char *const variants[] = {"", NULL};
    static const char *const rivals[] = {"libomp", "libgomp", NULL};
    const unsigned levels = options->quick ? 3 : 7;
    const struct problem_node root = problem_tree_root();
    char size[40];
    snprintf(size, sizeof size, "levels=%u", levels);
    tasks_plan_contest(measure, options,
                       &(struct tasks_contest){.name = "tree",
                                               .size = size,
                                               .tasks = (double)problem_tree_nodes(&root, levels),
                                               .brief = true,
                                               .variants = variants,
                                               .rivals = rivals});
}

struct tree_args {
    struct problem_node node;
    uint32_t levels;
};

static int node(const duite_call *call)
{
    struct tasks_session *session = call->context;
    const struct tree_args *args = call->args;
    const uint32_t n = problem_tree_children(&args->node, args->levels);
    session->counted[call->worker].nodes++;
    for (uint32_t i = 0; i < n; i++)
        duite_fork(call->rt, &tasks_tree_node,
                   &(struct tree_args){problem_tree_child(&args->node, i), args->levels}, 0, NULL);
    return 0;
}

const duite_kernel tasks_tree_node = {
    .name = "tree_node", .body = node, .args_size = sizeof(struct tree_args)};

static int time_tree(struct tasks_session *session, uint32_t levels, double *value)
{
    const struct tree_args root = {problem_tree_root(), levels};
    uint64_t nodes = 0;
    memset(session->counted, 0, sizeof session->counted);
    const double start = serve_seconds();
    int code = duite_fork(session->rt, &tasks_tree_node, &root, 0, NULL);
    if (!code)
        code = duite_wait(session->rt);
    *value = serve_seconds() - start;
    for (size_t i = 0; i < TASKS_WORKERS; i++)
        nodes += session->counted[i].nodes;
    if (code)
        return tasks_code(code);
    return nodes == problem_tree_nodes(&root.node, levels) ? 0 : serve_fail("wrong answer");
}

static int tree(void *context, struct serve_request *request, double *value)
{
    struct tasks_session *session = context;
    const uint32_t levels = (uint32_t)serve_number(request, "levels");
    int code = tasks_ready(session, request);
    if (!code && session->threads > TASKS_WORKERS)
        code = serve_fail("more than %d threads", TASKS_WORKERS);
    if (!code)
        code = time_tree(session, levels, value);
    return code ? code : time_tree(session, levels, value);
}

static int sequential(void *context, struct serve_request *request, double *value)
{
    const uint32_t levels = (uint32_t)serve_number(request, "levels");
    const struct problem_node root = problem_tree_root();
    const uint64_t warm = problem_tree_nodes(&root, levels);
    (void)context;
    const double start = serve_seconds();
    const uint64_t nodes = problem_tree_nodes(&root, levels);
    *value = serve_seconds() - start;
    return nodes == warm ? 0 : serve_fail("wrong answer");
}

static const struct serve_run RUNS[] = {{"tree", tree}, {"tree_sequential", sequential}, {0}};

const struct bench_case tasks_tree = {"tree", "an unbalanced tree, one node a task", plan, RUNS, 0};
