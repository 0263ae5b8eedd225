/* An irregular tree of tasks that is all born on one rank: with a second rank the balancer
 * `delegate` gives it some of the leaves. A leaf multiplies for 40 to 360 us, 200 on average; what
 * a task is follows from its seed. The sum over all leaves is the same however they ran. */
#include "bench/ranks/ranks.h"

#include <duite_policy.h>

enum { SEED = 1, STEPS_PER_US = 880 };

struct tree_args {
    uint64_t seed;
    uint32_t depth;
};

static void plan(struct measure *measure, const struct bench_options *options)
{
    const unsigned depth = options->quick ? 3 : 7;
    const struct measure_series *of[2];
    for (unsigned i = 0; i < 2; i++)
        of[i] = measure_series(measure, ranks_ours(i + 1, 1),
                               "delegate seed=%d depth=%u threads=1 scheduler=%s", SEED, depth,
                               options->scheduler);
    measure_ratio(measure, of[0], of[1], "delegate_speedup_r2");
}

static uint64_t multiply(uint64_t x, uint64_t steps)
{
    for (uint64_t i = 0; i < steps; i++)
        x = x * 6364136223846793005u + 1442695040888963407u;
    return x;
}

static int leaf(const duite_call *call)
{
    const struct tree_args *args = call->args;
    uint64_t random = args->seed, us = 40 * (1 + duite_random(&random) % 9);
    duite_out(call, 0, int64_t)[0] += (int64_t)(multiply(args->seed, us * STEPS_PER_US) >> 40);
    return 0;
}
static const duite_kernel LEAF = {
    .name = "tree_leaf", .body = leaf, .access = {DUITE_CW}, .args_size = sizeof(struct tree_args)};

static int branch(const duite_call *call);
static const duite_kernel BRANCH = {.name = "tree_branch",
                                    .body = branch,
                                    .access = {DUITE_CWP},
                                    .args_size = sizeof(struct tree_args)};

static int branch(const duite_call *call)
{
    const struct tree_args *args = call->args;
    uint64_t random = args->seed;
    int code = 0;
    for (uint64_t n = 2 + duite_random(&random) % 4; n && !code; n--) {
        const struct tree_args child = {duite_random(&random), args->depth - 1};
        bool last = !child.depth || child.seed % 3 == 0;
        code = DUITE_FORK(call->rt, last ? &LEAF : &BRANCH, &child, call->param[0].object);
    }
    return code;
}

/* The same tree by hand. */
static int64_t expected(struct tree_args args, bool last)
{
    uint64_t random = args.seed;
    int64_t sum = 0;
    if (last) {
        const uint64_t us = 40 * (1 + duite_random(&random) % 9);
        return (int64_t)(multiply(args.seed, us * STEPS_PER_US) >> 40);
    }
    for (uint64_t n = 2 + duite_random(&random) % 4; n; n--) {
        const struct tree_args child = {duite_random(&random), args.depth - 1};
        sum += expected(child, !child.depth || child.seed % 3 == 0);
    }
    return sum;
}

static int time_tree(duite *rt, const struct tree_args *args, double *value)
{
    return ranks_time_sum(rt, &BRANCH, args, expected(*args, false), value);
}

static int run(void *context, struct serve_request *request, double *value)
{
    struct ranks_session *session = context;
    static const duite_kernel *const kernels[] = {&LEAF, &BRANCH, NULL};
    const struct tree_args args = {(uint64_t)serve_number(request, "seed"),
                                   (uint32_t)serve_number(request, "depth")};
    duite *rt = NULL;
    duite_options options = duite_options_default();
    options.kernels = kernels;
    options.balance = duite_balancer_find("delegate");
    int code = ranks_start(session, request, &options, &rt);
    if (!code) /* the first tree tells what a leaf costs, and warms up */
        code = time_tree(rt, &args, value);
    if (!code)
        code = time_tree(rt, &args, value);
    return ranks_stop(&rt, code);
}

static const struct serve_run RUNS[] = {{"delegate", run}, {0}};

const struct bench_case ranks_delegate = {
    "delegate", "an irregular tree of tasks, all born on one rank, over one and two", plan, RUNS,
    0};
