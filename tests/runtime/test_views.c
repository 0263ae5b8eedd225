/* Views: what a task finds in one, in order with all that happens to its object, forked and
 * replayed, in checking mode and without. */
#include "tests/support/unit.h"

#include <duite.h>

#include <stdint.h>
#include <string.h>

enum { COUNT = 10, N = 4 };
static const size_t INDEX[N] = {9, 0, 3, 3};

/* x[i] = argument + i */
static int put(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int64_t)[i] = *(const int64_t *)call->args + (int64_t)i;
    return 0;
}

static int increase(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int64_t)[i] += 10;
    return 0;
}

static int give(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int64_t)[i] += *(const int64_t *)call->args;
    return 0;
}

/* y = 1001 y + x[0] + x[1] + x[2], modulo 2^64. */
static int digits(const duite_call *call)
{
    const int64_t *x = duite_in(call, 0, int64_t);
    uint64_t *y = duite_out(call, 1, uint64_t);

    if (duite_count(call, 0) != N || x[2] != x[3])
        return 1;
    y[0] = 1001 * y[0] + (uint64_t)(x[0] + x[1] + x[2]);
    return 0;
}

/* Overwrites an object with what a view of it had before. */
static int spread(const duite_call *call)
{
    const int64_t *x = duite_in(call, 1, int64_t);

    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int64_t)[i] = x[i % N];
    return 0;
}

static int failing(const duite_call *call)
{
    duite_out(call, 0, int64_t)[0] = 1;
    return duite_fail(call, 77, "failed");
}

static const duite_kernel PUT = {
    .name = "put", .body = put, .access = {DUITE_W}, .args_size = sizeof(int64_t)};
static const duite_kernel INCREASE = {.name = "increase", .body = increase, .access = {DUITE_RW}};
static const duite_kernel GIVE = {
    .name = "give", .body = give, .access = {DUITE_CW}, .args_size = sizeof(int64_t)};
static const duite_kernel DIGITS = {
    .name = "digits", .body = digits, .access = {DUITE_R, DUITE_RW}};
static const duite_kernel SPREAD = {.name = "spread", .body = spread, .access = {DUITE_W, DUITE_R}};
static const duite_kernel FAIL = {.name = "fail", .body = failing, .access = {DUITE_RW}};

/* Lends its view to a task that takes the digits. */
static int lend(const duite_call *call)
{
    const duite_object lent[] = {call->param[0].object, call->param[1].object};

    return duite_fork(call->rt, &DIGITS, NULL, 2, lent);
}

static const duite_kernel LEND = {.name = "lend", .body = lend, .access = {DUITE_RP, DUITE_RWP}};
static const duite_kernel LEND_READ = {
    .name = "lend what it reads", .body = lend, .access = {DUITE_R, DUITE_RWP}};
static const duite_kernel *const KERNELS[] = {&PUT,  &INCREASE, &GIVE,      &DIGITS, &SPREAD,
                                              &FAIL, &LEND,     &LEND_READ, NULL};

struct made {
    duite *rt;
    duite_object a, view, y;
};

static struct made begin(unsigned threads, int check)
{
    static struct made m;
    duite_options options = duite_options_default();

    options.kernels = KERNELS;
    options.threads = threads;
    options.bind = 0;
    options.check = check;
    ck_assert_msg(!duite_start(&m.rt, &options), "%s", duite_message());
    ck_assert_int_eq(duite_new(m.rt, DUITE_I64, COUNT, &m.a), 0);
    ck_assert_int_eq(duite_view(m.rt, m.a, N, INDEX, &m.view), 0);
    ck_assert_int_eq(duite_new(m.rt, DUITE_I64, 1, &m.y), 0);
    return m;
}

static void end(struct made *m)
{
    ck_assert_int_eq(duite_free(m->rt, m->view), 0);
    ck_assert_int_eq(duite_free(m->rt, m->a), 0);
    ck_assert_int_eq(duite_free(m->rt, m->y), 0);
    ck_assert_msg(!duite_stop(&m->rt), "%s", duite_message());
}

static void holds(const struct made *m, int64_t x0, int64_t x1, int64_t x2)
{
    int64_t x[N + 1] = {-1, -1, -1, -1, -1};
    size_t count = 0;

    ck_assert_msg(!duite_get(m->rt, m->view, x), "%s", duite_message());
    ck_assert_int_eq(x[0], x0);
    ck_assert_int_eq(x[1], x1);
    ck_assert_int_eq(x[2], x2);
    ck_assert_int_eq(x[3], x2);
    ck_assert_int_eq(x[4], -1);
    ck_assert_int_eq(duite_get_count(m->rt, m->view, &count), 0);
    ck_assert_uint_eq(count, N);
}

static int64_t number(const struct made *m)
{
    int64_t y = -1;

    ck_assert_msg(!duite_get(m->rt, m->y, &y), "%s", duite_message());
    return y;
}

START_TEST(in_order)
{
    for (int check = 0; check < 2; check++) {
        struct made m = begin(2, check);
        const int64_t five = 5, one = 1;
        int64_t values[COUNT] = {7};

        holds(&m, 0, 0, 0);
        DUITE_FORK(m.rt, &PUT, &five, m.a);
        DUITE_FORK(m.rt, &DIGITS, NULL, m.view, m.y); /* 14 + 5 + 8 */
        DUITE_FORK(m.rt, &INCREASE, NULL, m.a);
        DUITE_FORK(m.rt, &DIGITS, NULL, m.view, m.y); /* 24 + 15 + 18 */
        ck_assert_int_eq(number(&m), 27 * 1001 + 57);
        holds(&m, 24, 15, 18);
        for (int i = 0; i < 5; i++)
            DUITE_FORK(m.rt, &GIVE, &one, m.a);
        holds(&m, 29, 20, 23);                        /* sums are closed */
        DUITE_FORK(m.rt, &SPREAD, NULL, m.a, m.view); /* 29 20 23 23 29 20 23 23 29 20 */
        holds(&m, 20, 29, 23);
        ck_assert_int_eq(duite_set(m.rt, m.a, values), 0);
        holds(&m, 0, 7, 0);
        end(&m);
    }
}
END_TEST

START_TEST(types)
{
    static const duite_type TYPES[] = {DUITE_BYTE, DUITE_I32, DUITE_F32, DUITE_F64};
    static const size_t SIZES[] = {1, 4, 4, 8};
    struct made m = begin(1, 0);
    unsigned char from[8 * COUNT], to[8 * N];
    duite_object a, view;

    for (unsigned i = 0; i < sizeof from; i++)
        from[i] = (unsigned char)i;
    for (int t = 0; t < 4; t++) {
        ck_assert_int_eq(duite_new(m.rt, TYPES[t], COUNT, &a), 0);
        ck_assert_int_eq(duite_view(m.rt, a, N, INDEX, &view), 0);
        ck_assert_int_eq(duite_set(m.rt, a, from), 0);
        ck_assert_int_eq(duite_get(m.rt, view, to), 0);
        for (int i = 0; i < N; i++)
            ck_assert(!memcmp(to + (size_t)i * SIZES[t], from + INDEX[i] * SIZES[t], SIZES[t]));
        ck_assert_int_eq(duite_free(m.rt, view), 0);
        ck_assert_int_eq(duite_free(m.rt, a), 0);
    }
    end(&m);
}
END_TEST

/* Poison goes from the object to the view, and leaves both with the next w. */
START_TEST(poison)
{
    struct made m = begin(2, 0);
    int64_t x[N];
    const int64_t five = 5;

    DUITE_FORK(m.rt, &FAIL, NULL, m.a);
    DUITE_FORK(m.rt, &DIGITS, NULL, m.view, m.y);
    ck_assert_int_eq(duite_get(m.rt, m.view, x), 77);
    ck_assert_int_eq(duite_get(m.rt, m.y, x), 77);
    DUITE_FORK(m.rt, &PUT, &five, m.a);
    holds(&m, 14, 5, 8);
    ck_assert_int_eq(duite_get(m.rt, m.y, x), 77);
    ck_assert_int_eq(duite_set(m.rt, m.y, NULL), 0);
    ck_assert_int_eq(duite_wait(m.rt), 77);
    end(&m);
}
END_TEST

/* ---- Replays: forking the rounds by hand must leave the same ---- */

static const int64_t five = 5, one = 1;

static int only_reads(duite *rt, void *context)
{
    const struct made *m = context;

    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    return 0;
}

static int reads_then_writes(duite *rt, void *context)
{
    const struct made *m = context;

    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    DUITE_FORK(rt, &PUT, &five, m->a);
    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    DUITE_FORK(rt, &INCREASE, NULL, m->a);
    return 0;
}

static int sums(duite *rt, void *context)
{
    const struct made *m = context;

    DUITE_FORK(rt, &GIVE, &one, m->a);
    DUITE_FORK(rt, &GIVE, &five, m->a);
    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    return 0;
}

static int sets(duite *rt, void *context)
{
    const struct made *m = context;
    const int64_t values[COUNT] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    duite_set(rt, m->a, values);
    DUITE_FORK(rt, &SPREAD, NULL, m->a, m->view);
    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    DUITE_FORK(rt, &INCREASE, NULL, m->a);
    return 0;
}

static int fails(duite *rt, void *context)
{
    const struct made *m = context;

    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    DUITE_FORK(rt, &FAIL, NULL, m->a);
    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    DUITE_FORK(rt, &PUT, &one, m->y);
    DUITE_FORK(rt, &PUT, &five, m->a);
    DUITE_FORK(rt, &DIGITS, NULL, m->view, m->y);
    return 0;
}

static int lends(duite *rt, void *context)
{
    const struct made *m = context;

    DUITE_FORK(rt, &LEND, NULL, m->view, m->y);
    DUITE_FORK(rt, &INCREASE, NULL, m->a);
    DUITE_FORK(rt, &LEND_READ, NULL, m->view, m->y);
    DUITE_FORK(rt, &INCREASE, NULL, m->a);
    return 0;
}

static duite_build *const BUILDS[] = {only_reads, reads_then_writes, sums, sets, fails, lends};

/* What is left in the end: y, the view, the object, and what wait says. */
struct left {
    int64_t y, view[N], a[COUNT];
    int code[4];
};

static struct left run(duite_build *build, int replayed, unsigned threads, int check)
{
    struct made m = begin(threads, check);
    struct left left;
    duite_graph graph;

    memset(&left, 0, sizeof left);
    ck_assert_int_eq(duite_graph_new(m.rt, build, &m, &graph), 0);
    for (int64_t part = 1; part < 4; part++) {
        DUITE_FORK(m.rt, &PUT, &part, m.a);
        for (int64_t i = 0; i < part && !replayed; i++)
            ck_assert_int_eq(build(m.rt, &m), 0);
        if (replayed)
            ck_assert_int_eq(duite_replay(m.rt, graph, (uint64_t)part), 0);
        DUITE_FORK(m.rt, &DIGITS, NULL, m.view, m.y);
    }
    left.code[0] = duite_get(m.rt, m.y, &left.y);
    left.code[1] = duite_get(m.rt, m.view, left.view);
    left.code[2] = duite_get(m.rt, m.a, left.a);
    left.code[3] = duite_wait(m.rt);
    ck_assert_int_eq(duite_graph_free(m.rt, graph), 0);
    end(&m);
    return left;
}

START_TEST(replayed)
{
    const struct left forked = run(BUILDS[_i], 0, 1, 0);

    ck_assert_int_eq(forked.code[3], BUILDS[_i] == fails ? 77 : 0);
    for (unsigned threads = 1; threads < 4; threads++) {
        const struct left left = run(BUILDS[_i], 1, threads, threads == 2);

        ck_assert_mem_eq(&left, &forked, sizeof left);
    }
}
END_TEST

/* A view is read first, also by a task that names it last. */
static int spreads(duite *rt, void *context)
{
    const struct made *m = context;

    return DUITE_FORK(rt, &SPREAD, NULL, m->a, m->view);
}

/* A round begins with what the object was, poison as well, though it then overwrites it. */
START_TEST(old_poison)
{
    struct made m = begin(2, 0);
    int64_t left[COUNT];
    duite_graph graph;

    ck_assert_int_eq(duite_graph_new(m.rt, _i ? spreads : reads_then_writes, &m, &graph), 0);
    DUITE_FORK(m.rt, &FAIL, NULL, m.a);
    ck_assert_int_eq(duite_replay(m.rt, graph, 2), 0);
    ck_assert_int_eq(duite_get(m.rt, _i ? m.a : m.y, left), 77);
    if (!_i)
        holds(&m, 24, 15, 18);
    ck_assert_int_eq(duite_wait(m.rt), 77);
    ck_assert_int_eq(duite_graph_free(m.rt, graph), 0);
    end(&m);
}
END_TEST

/* The flag may be a view. */
static int counts_down(duite *rt, void *context)
{
    const struct made *m = context;
    const int64_t less = -1;

    DUITE_FORK(rt, &GIVE, &less, m->a);
    return 0;
}

START_TEST(flag)
{
    struct made m = begin(2, 0);
    duite_graph graph;
    uint64_t rounds;

    ck_assert_int_eq(duite_graph_new(m.rt, counts_down, &m, &graph), 0);
    DUITE_FORK(m.rt, &PUT, &one, m.a); /* the view begins with 1 + 9 */
    ck_assert_int_eq(duite_replay_while(m.rt, graph, m.view, 50), 0);
    ck_assert_int_eq(duite_graph_rounds(m.rt, graph, &rounds), 0);
    ck_assert_uint_eq(rounds, 10);
    holds(&m, 0, -9, -6);
    ck_assert_int_eq(duite_graph_free(m.rt, graph), 0);
    end(&m);
}
END_TEST

/* A view bound in place of another, of another object, and a plain object in place of a view. */
START_TEST(bound)
{
    struct made m = begin(2, 0);
    duite_object other, view, plain;
    duite_graph graph;

    ck_assert_int_eq(duite_new(m.rt, DUITE_I64, COUNT, &other), 0);
    ck_assert_int_eq(duite_view(m.rt, other, N, (size_t[]){0, 1, 2, 2}, &view), 0);
    ck_assert_int_eq(duite_new(m.rt, DUITE_I64, N, &plain), 0);
    ck_assert_int_eq(duite_graph_new(m.rt, reads_then_writes, &m, &graph), 0);
    DUITE_FORK(m.rt, &PUT, &one, other);
    ck_assert_int_eq(duite_graph_bind(m.rt, graph, m.view, view), 0);
    ck_assert_int_eq(duite_replay(m.rt, graph, 1), 0);
    ck_assert_int_eq(number(&m), 6 * 1001 * 1001 + 6 * 1001 + 6); /* 1 + 2 + 3 */
    /* Now the graph writes the object of the view that it reads. */
    ck_assert_int_eq(duite_graph_bind(m.rt, graph, m.a, other), 0);
    ck_assert_int_eq(duite_set(m.rt, m.y, NULL), 0);
    ck_assert_int_eq(duite_replay(m.rt, graph, 2), 0);
    ck_assert_int_eq(number(&m) % 1001, 18); /* 5 + 6 + 7 */
    ck_assert_int_eq(duite_set(m.rt, m.y, NULL), 0);
    ck_assert_int_eq(duite_graph_bind(m.rt, graph, m.view, plain), 0);
    ck_assert_int_eq(duite_replay(m.rt, graph, 1), 0);
    ck_assert_int_eq(number(&m), 0);
    ck_assert_int_eq(duite_graph_free(m.rt, graph), 0);
    ck_assert_int_eq(duite_free(m.rt, view), 0);
    ck_assert_int_eq(duite_free(m.rt, other), 0);
    ck_assert_int_eq(duite_free(m.rt, plain), 0);
    end(&m);
}
END_TEST

/* A plan and a task on its way keep the list of a view that was freed. */
START_TEST(freed)
{
    struct made m = begin(2, 0);
    duite_graph graph;

    DUITE_FORK(m.rt, &PUT, &one, m.a);
    ck_assert_int_eq(duite_graph_new(m.rt, reads_then_writes, &m, &graph), 0);
    ck_assert_int_eq(duite_replay(m.rt, graph, 100), 0);
    ck_assert_int_eq(duite_free(m.rt, m.view), 0);
    ck_assert_int_eq(duite_view(m.rt, m.a, N, INDEX, &m.view), 0);
    ck_assert_int_eq(duite_replay(m.rt, graph, 1), 0); /* recorded again */
    holds(&m, 24, 15, 18);
    ck_assert_int_eq(duite_graph_free(m.rt, graph), 0);
    end(&m);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("views");
    TCase *test = tcase_create("views");

    tcase_add_test(test, in_order);
    tcase_add_test(test, types);
    tcase_add_test(test, poison);
    tcase_add_loop_test(test, replayed, 0, (int)(sizeof BUILDS / sizeof *BUILDS));
    tcase_add_loop_test(test, old_poison, 0, 2);
    tcase_add_test(test, flag);
    tcase_add_test(test, bound);
    tcase_add_test(test, freed);
    suite_add_tcase(suite, test);
    return unit_run(suite);
}
