/* Shared by the tests of graphs. */
#include "tests/runtime/graphs_fixture.h"
#include "tests/support/kernel.h"

#include <duite_policy.h>

KERNEL_SHARED(DIGIT, "digit", .access = {DUITE_RW}, .args_size = sizeof(int32_t))
{
    uint64_t *x = duite_out(call, 0, uint64_t); /* wraps around */

    x[0] = 10 * x[0] + (uint64_t) * (const int32_t *)call->args;
    return 0;
}

/* Fails, with its argument, when the number it reads has come to 100 or more. */
KERNEL_SHARED(LIMIT, "limit", .access = {DUITE_R, DUITE_W}, .args_size = sizeof(int32_t))
{
    const int64_t x = duite_in(call, 0, int64_t)[0];

    duite_out(call, 1, int64_t)[0] = x;
    return x < 100 ? 0 : duite_fail(call, *(const int32_t *)call->args, "x is %d", (int)x);
}

KERNEL_SHARED(ROUND_DIGIT, "round digit", .access = {DUITE_RW})
{
    duite_out(call, 0, int64_t)[0] = 10 * duite_in(call, 0, int64_t)[0] + (int64_t)call->round;
    return 0;
}

KERNEL_SHARED(LEND, "lend", .access = {DUITE_RWP})
{
    return DUITE_FORK(call->rt, &ROUND_DIGIT, NULL, call->param[0].object);
}

KERNEL_SHARED(COPY, "copy", .access = {DUITE_R, DUITE_W})
{
    duite_out(call, 1, int64_t)[0] = duite_in(call, 0, int64_t)[0];
    return 0;
}

int graphs_build(duite *rt, void *context)
{
    struct graphs_fixture *f = context;

    f->built++;
    DUITE_FORK(rt, &DIGIT, &(int32_t){1}, f->a);
    DUITE_FORK(rt, &DIGIT, &(int32_t){2}, f->b);
    DUITE_FORK(rt, &DIGIT, &(int32_t){3}, f->a);
    return 0;
}

duite *graphs_start(const duite_kernel *const *kernels, unsigned threads, const char *scheduler)
{
    duite_options options = duite_options_default();
    duite *rt = NULL;

    options.kernels = kernels;
    options.threads = threads;
    options.bind = 0;
    options.scheduler = scheduler ? duite_scheduler_find(scheduler) : options.scheduler;
    ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
    return rt;
}

duite_graph graphs_record(duite *rt, duite_build *build, void *context)
{
    duite_graph graph;

    ck_assert_msg(!duite_graph_new(rt, build, context, &graph), "%s", duite_message());
    return graph;
}

uint64_t graphs_rounds_of(duite *rt, duite_graph graph)
{
    uint64_t rounds = 99999;

    ck_assert_msg(!duite_graph_rounds(rt, graph, &rounds), "%s", duite_message());
    return rounds;
}

duite_object graphs_number(duite *rt, int64_t value)
{
    duite_object object;

    ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &object), 0);
    ck_assert_int_eq(duite_set(rt, object, &value), 0);
    return object;
}

int64_t graphs_value_of(duite *rt, duite_object object)
{
    int64_t value = -1;

    ck_assert_msg(!duite_get(rt, object, &value), "%s", duite_message());
    return value;
}

struct graphs_fixture graphs_begin(duite_build *builds)
{
    static const duite_kernel *const KERNELS[] = {&DIGIT, &LIMIT, &COPY, &ROUND_DIGIT, &LEND, NULL};
    static struct graphs_fixture f; /* build sees the fields of its time */

    f = (struct graphs_fixture){.rt = graphs_start(KERNELS, 2, NULL)};
    f.a = graphs_number(f.rt, 0);
    f.b = graphs_number(f.rt, 0);
    f.c = graphs_number(f.rt, 0);
    f.graph = graphs_record(f.rt, builds, &f);
    return f;
}

void graphs_end(struct graphs_fixture *f, int code)
{
    ck_assert_int_eq(duite_graph_free(f->rt, f->graph), 0);
    ck_assert_int_eq(duite_free(f->rt, f->a), 0);
    ck_assert_int_eq(duite_free(f->rt, f->b), 0);
    ck_assert_int_eq(duite_free(f->rt, f->c), 0);
    ck_assert_int_eq(duite_stop(&f->rt), code);
}
