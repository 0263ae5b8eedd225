/* The first and the last pass of the compiler of recorded graphs, on a record made by hand: what
 * becomes plain data, and the flat arrays of the plan. */
#include "runtime/plan/plan.h"
#include "tests/support/unit.h"

#include <string.h>

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

static const duite_kernel FILL = {
    .name = "fill", .body = nothing, .access = {DUITE_W}, .args_size = sizeof(double)};
static const duite_kernel GIVE = {.name = "give", .body = nothing, .access = {DUITE_R, DUITE_CW}};
static const duite_kernel READ = {
    .name = "read", .body = nothing, .access = {DUITE_R}, .replicated = true};
static const duite_law SUM = {.name = "by hand"};

/* fill x; give x to s, twice; read s. */
struct made {
    const duite_kernel *kernel[3];
    struct task_graph graph;
    struct plan_recorded_fork fork[4];
    struct plan_access access[6];
    struct plan_recorded_object object[2];
    double args[2];
    struct plan_record record;
};

static void make(struct made *made)
{
    const struct task_options anywhere = {.at = TASK_ANYWHERE, .priority = 3, .cost = 0.5};
    *made = (struct made){.kernel = {&FILL, &GIVE, &READ}, .args = {7}};
    made->graph.n_ranks = 1;
    made->graph.kernels = made->kernel;
    made->object[0] = (struct plan_recorded_object){.type = DUITE_F64, .count = 3, .written = true};
    made->object[1] = (struct plan_recorded_object){
        .type = DUITE_F32, .count = 5, .sums = true, .reads_old = true};
    made->access[0] = (struct plan_access){0, DUITE_W, NULL};
    made->access[1] = made->access[3] = (struct plan_access){0, DUITE_R, NULL};
    made->access[2] = made->access[4] = (struct plan_access){1, DUITE_CW, &SUM};
    made->access[5] = (struct plan_access){1, DUITE_R, NULL};
    static const struct {
        uint32_t kernel, n, owner;
        size_t first;
    } fork[4] = {{0, 1, 0, 0}, {1, 2, 0, 1}, {1, 2, 0, 3}, {2, 1, 1, 5}};
    for (uint32_t i = 0; i < 4; i++)
        made->fork[i] = (struct plan_recorded_fork){.kernel = fork[i].kernel,
                                                    .n = fork[i].n,
                                                    .options = anywhere,
                                                    .owner = fork[i].owner,
                                                    .call = i,
                                                    .first = fork[i].first};
    made->record = (struct plan_record){.graph = &made->graph,
                                        .fork = made->fork,
                                        .n_forks = 4,
                                        .access = made->access,
                                        .n_accesses = 6,
                                        .args = (unsigned char *)made->args,
                                        .args_bytes = sizeof made->args,
                                        .n_calls = 4,
                                        .object = made->object,
                                        .n_objects = 2,
                                        .whole = true};
}

UNIT_TEST(source)
{
    struct made made;
    struct plan_source plain;
    make(&made);
    made.fork[1].options.at = 0;
    made.fork[2].kernel = PLAN_SETS;
    ck_assert(plan_record_source(&made.record, NULL, &plain));
    ck_assert(plain.n_forks == 4 && plain.n_objects == 2 && plain.n_accesses == 6);
    ck_assert_ptr_eq(plain.access, made.access);
    ck_assert_uint_eq(plain.flag, PLAN_NONE);
    ck_assert_uint_eq(plain.bytes[0], 3 * sizeof(double));
    ck_assert_uint_eq(plain.bytes[1], 5 * sizeof(float));
    ck_assert(plain.fork[0].rank == PLAN_BY_OWNER && plain.fork[1].rank == 0);
    ck_assert(!plain.fork[1].sets && plain.fork[2].sets && !plain.fork[2].replicated);
    ck_assert(plain.fork[3].replicated && plain.fork[3].owner == 1 && plain.fork[3].first == 5);
    ck_assert_double_eq(plain.fork[0].cost, 0.5);
    plan_source_free(&plain);
}

/* Nodes: 0 fill, 1 and 2 give, 3 the sum, 4 read. Its successors in a node's row begin with those
 * of the next round. */
static void next_is(const struct plan *plan, size_t node, uint32_t cyclic, const char *expected)
{
    const struct plan_node *from = plan_task(plan, node)->node;
    char row[16] = "";
    for (uint32_t i = 0; i < from->n_next; i++)
        for (size_t k = 0; k < plan->n_nodes; k++)
            if (from->next[i] == plan_task(plan, k))
                row[strlen(row)] = (char)('0' + k);
    ck_assert_str_eq(row, expected);
    ck_assert_uint_eq(from->n_cyclic, cyclic);
    ck_assert_int_eq(from->sink, from->n_next == cyclic);
}

UNIT_TEST(nodes)
{
    static const enum task_type type[] = {TASK_NODE, TASK_NODE, TASK_NODE, TASK_NODE_SUM,
                                          TASK_NODE};
    static const uint32_t first[] = {0, 1, 1, 2, 1}, steady[] = {2, 2, 2, 3, 1},
                          owner[] = {0, 0, 0, 1, 1};
    struct made made;
    make(&made);
    struct plan *plan;
    ck_assert_int_eq(plan_new(&plan, &made.record, NULL), DUITE_OK);
    ck_assert_ptr_nonnull(plan);
    ck_assert(plan->n_nodes == 5 && plan->n_roots == 1 && plan->n_sinks == 1);
    ck_assert_ptr_eq(plan->root[0], plan_task(plan, 0));
    for (size_t i = 0; i < 5; i++) {
        const struct task *task = plan_task(plan, i);
        ck_assert_int_eq(task->type, type[i]);
        ck_assert_uint_eq(plan->first[i], first[i]);
        ck_assert_uint_eq(task->node->steady, steady[i]);
        ck_assert_uint_eq(plan->owner[i], owner[i]);
        ck_assert_uint_eq(task->node->n_leaves, i == 1 || i == 2);
    }
    next_is(plan, 0, 0, "12");
    next_is(plan, 1, 1, "03");
    next_is(plan, 2, 1, "03");
    next_is(plan, 3, 2, "124");
    next_is(plan, 4, 1, "3");
    plan_drop(plan, NULL);
}

UNIT_TEST(calls)
{
    struct made made;
    make(&made);
    struct plan *plan;
    ck_assert_int_eq(plan_new(&plan, &made.record, NULL), DUITE_OK);
    ck_assert_ptr_nonnull(plan);
    const struct task *fill = plan_task(plan, 0), *read = plan_task(plan, 4);
    ck_assert(fill->priority == 3 && fill->kernel == 0 && fill->placed && !read->placed);
    ck_assert_double_eq(*(const double *)fill->node->args, 7);
    ck_assert_ptr_ne(fill->node->args, made.args);
    ck_assert(!read->node->args && read->kernel == 2);
    ck_assert(plan->place[0].mode == DUITE_W && plan->place[1].mode == DUITE_RW);
    plan_drop(plan, NULL);
}

/* Contributions have buffers of their own, as large as their object; the tree names the law. */
UNIT_TEST(places)
{
    struct made made;
    make(&made);
    struct plan *plan;
    ck_assert_int_eq(plan_new(&plan, &made.record, NULL), DUITE_OK);
    ck_assert_ptr_nonnull(plan);
    ck_assert(plan->n_places == 4 && plan->n_objects == 2 && plan->n_trees == 1);
    for (size_t i = 2; i < 4; i++) {
        ck_assert_ptr_eq(plan->place[i].law, &SUM);
        ck_assert_uint_eq(plan->place[i].bytes, 5 * sizeof(float));
        ck_assert_ptr_nonnull(plan->place[i].data);
        ck_assert_uint_eq(plan->place[i].n_params, 2);
    }
    ck_assert_ptr_ne(plan->place[2].data, plan->place[3].data);
    const struct plan_tree *tree = plan_task(plan, 3)->node->tree;
    ck_assert(tree->law == &SUM && tree->n == 1);
    ck_assert(tree->merge[0].left == 1 && tree->merge[0].right == 2);
    plan_drop(plan, NULL);
}
