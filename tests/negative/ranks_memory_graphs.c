/* Out of memory at every allocation in turn while graphs are recorded, changed and replayed, with
 * objects that change size and a law of the program; with a balancer that moves objects, too. */

#include "tests/negative/misuse.h"
#include "tests/negative/starve.h"
#include "tests/support/ranks.h"

#include <stdint.h>

enum { COUNT = 20, ROUNDS = 4, SUM = 0 + 3 * ((1 + 3 * 1) + 3 * 1) };

static const char *balance = "none";

static void add_thrice(void *left, const void *right, size_t count, duite_type type)
{
    (void)type;
    for (size_t i = 0; i < count; i++)
        ((int32_t *)left)[i] += 3 * ((const int32_t *)right)[i];
}

static const duite_law LAW = {.name = "thrice", .type = DUITE_I32, .combine = add_thrice};

/* value[i] = 10 value[i] + the argument. */
KERNEL(DIGIT, "digit", .access = {DUITE_RW}, .args_size = sizeof(int32_t))
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] =
            10 * duite_out(call, 0, int32_t)[i] + *(const int32_t *)call->args;
    return 0;
}

KERNEL(ONE, "one", .access = {DUITE_CW, DUITE_R}, .law = DUITE_LAWS(&LAW))
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] = 1;
    return 0;
}

/* Leaves one element less, until there is none. */
KERNEL(SHRINK, "shrink", .access = {DUITE_RW})
{
    const size_t count = duite_count(call, 0);

    return duite_resize(call, 0, count ? count - 1 : 0);
}

KERNEL(DOWN, "down", .access = {DUITE_RW})
{
    duite_out(call, 0, int32_t)[0] -= 1;
    return 0;
}

KERNEL(LOOK, "look", .access = {DUITE_R, DUITE_W})
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 1, int32_t)[i] = duite_in(call, 0, int32_t)[i];
    return 0;
}

struct objects {
    duite_object a, b, sum, seen, list, flag;
};

static int build(duite *rt, void *context)
{
    const struct objects *o = context;
    const int32_t first = 1, second = 2;

    duite_set(rt, o->sum, NULL);
    duite_fork(rt, &DIGIT, &first, 1, &o->a);
    duite_fork_at(rt, ranks - 1, &DIGIT, &second, 1, &o->b);
    for (int i = 0; i < 3; i++)
        duite_fork_at(rt, i % ranks, &ONE, NULL, 2, (duite_object[]){o->sum, o->a});
    duite_fork(rt, &LOOK, NULL, 2, (duite_object[]){o->sum, o->seen});
    duite_fork(rt, &DOWN, NULL, 1, &o->flag);
    return 0;
}

static int build_shrink(duite *rt, void *context)
{
    return duite_fork_at(rt, ranks - 1, &SHRINK, NULL, 1, &((const struct objects *)context)->list);
}

static int make(duite *rt, struct objects *o)
{
    const int32_t value = ROUNDS;

    return duite_new(rt, DUITE_I32, COUNT, &o->a) || duite_new(rt, DUITE_I32, COUNT, &o->b) ||
           duite_new(rt, DUITE_I32, COUNT, &o->sum) || duite_new(rt, DUITE_I32, COUNT, &o->seen) ||
           duite_new_sized(rt, DUITE_I32, COUNT, COUNT, &o->list) ||
           duite_new(rt, DUITE_I32, 1, &o->flag) || duite_set(rt, o->flag, &value);
}

static int is(duite *rt, duite_object object, int32_t expected)
{
    int32_t values[COUNT];

    return duite_get(rt, object, values) || values[0] == expected;
}

/* Two graphs, interleaved; a and b change places, arguments change. Whatever is said to be good is
 * right. */
static int work(duite *rt, struct objects *o)
{
    duite_graph graph, shrinks;
    const int32_t seven = 7;
    size_t count;
    uint64_t rounds;
    int right = 1;

    if (duite_graph_new(rt, build, o, &graph) || duite_graph_new(rt, build_shrink, o, &shrinks))
        return 1;
    if (duite_replay(rt, graph, 2) || duite_replay(rt, shrinks, 2))
        return 1;
    right &= is(rt, o->a, 11) && is(rt, o->sum, SUM) && is(rt, o->seen, SUM);
    if (duite_graph_args(rt, graph, 0, &seven) || duite_graph_bind(rt, graph, o->a, o->b) ||
        duite_graph_bind(rt, graph, o->b, o->a) || duite_replay(rt, shrinks, 1) ||
        duite_replay_while(rt, graph, o->flag, 10) || duite_graph_rounds(rt, graph, &rounds))
        return right;
    right &= duite_wait(rt) || rounds == ROUNDS - 2;
    right &= is(rt, o->a, 1122) && is(rt, o->b, 2277);
    right &= duite_get_count(rt, o->list, &count) || count == COUNT - 3;
    duite_graph_free(rt, graph);
    duite_graph_free(rt, shrinks);
    return right;
}

static int run(void)
{
    static const duite_kernel *const KERNELS[] = {&DIGIT, &ONE, &SHRINK, &LOOK, &DOWN, NULL};
    static const duite_law *const LAWS[] = {&LAW, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    struct objects o;
    duite *rt;
    int right = 1;

    options.kernels = KERNELS;
    options.laws = LAWS;
    options.balance = duite_balancer_find(balance);
    if (duite_start(&rt, &options))
        return rt == NULL;
    if (!make(rt, &o)) {
        right = work(rt, &o);
        duite_free(rt, o.a);
        duite_free(rt, o.b);
        duite_free(rt, o.sum);
        duite_free(rt, o.seen);
        duite_free(rt, o.list);
        duite_free(rt, o.flag);
    }
    duite_stop(&rt);
    return right && !rt;
}

/* ranks_memory_graphs [BALANCER] */
RANKS_CASE(memory_graphs)
{
    if (argc > 1)
        balance = argv[1];
    misuse_mpi();
    starve("graphs", run);
    return tap_done();
}
