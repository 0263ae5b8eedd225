/* The unbalanced tree of bench/problem.h, all born on one rank, over one and two: with a second
 * rank the balancer `delegate` gives it whole subtrees. A node of the last levels is one task with
 * all below it, 80 nodes on average; nearer to the root a task forks its children's. No fork says
 * what it costs. */
#include "bench/ranks/ranks.h"

#include <duite_policy.h>

enum { LAST_LEVELS = 3 };

struct tree_args {
    struct problem_node node;
    uint32_t levels;
};

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned levels = options->quick ? 6 : 9;
    const struct measure_series *of[2];
    for (unsigned i = 0; i < 2; i++)
        of[i] = measure_series(measure, ranks_ours(i + 1, 1),
                               "rank_tree levels=%u threads=1 scheduler=%s", levels,
                               options->scheduler);
    measure_ratio(measure, of[0], of[1], "tree_speedup_r2");
}

static int leaf(const duite_call *call)
{
    const struct tree_args *args = call->args;
    duite_out(call, 0, int64_t)[0] += (int64_t)problem_tree_nodes(&args->node, args->levels);
    return 0;
}
static const duite_kernel LEAF = {
    .name = "tree_end", .body = leaf, .access = {DUITE_CW}, .args_size = sizeof(struct tree_args)};

static int branch(const duite_call *call);
static const duite_kernel BRANCH = {.name = "tree_top",
                                    .body = branch,
                                    .access = {DUITE_CWP},
                                    .args_size = sizeof(struct tree_args)};

static int branch(const duite_call *call)
{
    const struct tree_args *args = call->args;
    const uint32_t n = problem_tree_children(&args->node, args->levels);
    int64_t *own = duite_contribute(call, 0);
    int code = own ? 0 : DUITE_E_MEMORY;
    if (own)
        own[0] = 1;
    for (uint32_t i = 0; i < n && !code; i++) {
        const struct tree_args child = {problem_tree_child(&args->node, i), args->levels};
        const bool last = child.node.depth + LAST_LEVELS >= args->levels;
        code = DUITE_FORK(call->rt, last ? &LEAF : &BRANCH, &child, call->param[0].object);
    }
    return code;
}

static int time_tree(duite *rt, uint32_t levels, double *value)
{
    const struct tree_args root = {problem_tree_root(), levels};
    const int64_t nodes = (int64_t)problem_tree_nodes(&root.node, levels);
    return ranks_time_sum(rt, &BRANCH, &root, nodes, value);
}

static int run(void *context, struct serve_request *request, double *value)
{
    struct ranks_session *session = context;
    static const duite_kernel *const kernels[] = {&LEAF, &BRANCH, NULL};
    const uint32_t levels = (uint32_t)serve_number(request, "levels");
    duite *rt = NULL;
    duite_options options = duite_options_default();
    options.kernels = kernels;
    options.balance = duite_balancer_find("delegate");
    int code = ranks_start(session, request, &options, &rt);
    if (!code) /* the first tree tells what a leaf costs, and warms up */
        code = time_tree(rt, levels - LAST_LEVELS, value);
    if (!code)
        code = time_tree(rt, levels, value);
    return ranks_stop(&rt, code);
}

static const struct serve_run RUNS[] = {{"rank_tree", run}, {0}};

const struct bench_case ranks_tree = {
    "tree", "an unbalanced tree, 80 nodes a task, born on one rank, over one and two", plan, RUNS,
    0};
