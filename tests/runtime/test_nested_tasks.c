/* Tasks that fork: values and sizes that go down and come back, failures and where they are said to
 * be, replays, depth, and the memory of a body that forks for ever. */

#include "tests/support/unit.h"

#include <duite.h>

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 100 };

struct args {
    int32_t n, code;
};

static duite *rt;
static duite_object object;
static int waited;     /* what a body's wait or get returned */
static char said[300]; /* and said */
static size_t grown;   /* bytes that a body's forks left */

/* ---- Kernels ---- */

static duite_body put, append, copy, fails, deeper, deeper_waiting, append_all, fail_all, for_ever,
    through_reader, twice, own_least, own_twice;

#define ARGS .args_size = sizeof(struct args)
static const duite_kernel
    PUT = {.name = "put", .body = put, .access = {DUITE_W}, ARGS},
    APPEND = {.name = "append", .body = append, .access = {DUITE_RW}, ARGS},
    COPY = {.name = "copy", .body = copy, .access = {DUITE_R, DUITE_W}},
    FAILS = {.name = "fails", .body = fails, .access = {DUITE_RW}, ARGS},
    DEEPER = {.name = "deeper", .body = deeper, .access = {DUITE_WP}, ARGS},
    DEEPER_WAITING = {.name = "deeper, waiting",
                      .body = deeper_waiting,
                      .access = {DUITE_RWP},
                      ARGS},
    APPEND_ALL = {.name = "append all", .body = append_all, .access = {DUITE_RWP}, ARGS},
    FAIL_ALL = {.name = "fail all", .body = fail_all, .access = {DUITE_RWP, DUITE_RWP}, ARGS},
    FOR_EVER = {.name = "for ever", .body = for_ever, .access = {DUITE_RWP}, ARGS},
    THROUGH_READER = {.name = "through a reader",
                      .body = through_reader,
                      .access = {DUITE_R, DUITE_W}},
    TWICE = {.name = "twice", .body = twice, .access = {DUITE_RWP}, ARGS},
    OWN_LEAST = {.name = "own least",
                 .body = own_least,
                 .access = {DUITE_CWP},
                 .law = {&duite_min},
                 ARGS},
    OWN_TWICE = {.name = "own twice", .body = own_twice, .access = {DUITE_CWP}, ARGS};

static const struct args *args_of(const duite_call *call)
{
    return call->args;
}

static void remember_told(int code)
{
    waited = code;
    strncpy(said, code ? duite_message() : "", sizeof said - 1);
}

static int put(const duite_call *call)
{
    for (size_t i = 0; i < duite_count(call, 0); i++)
        duite_out(call, 0, int32_t)[i] = args_of(call)->n;
    return 0;
}

/* Of an object that changes its size: one more element. Of another: as a digit. */
static int append(const duite_call *call)
{
    const size_t n = duite_count(call, 0);
    int32_t *values = duite_out(call, 0, int32_t);

    if (n == call->param[0].max) {
        values[0] = values[0] % 100000000 * 10 + args_of(call)->n;
        return 0;
    }
    duite_resize(call, 0, n + 1);
    values[n] = args_of(call)->n;
    return 0;
}

static int copy(const duite_call *call)
{
    duite_out(call, 1, int32_t)[0] = duite_in(call, 0, int32_t)[0];
    return 0;
}

static int fails(const duite_call *call)
{
    return duite_fail(call, args_of(call)->code, "on purpose");
}

static int deeper(const duite_call *call)
{
    struct args less = *args_of(call);

    if (!less.n--)
        return DUITE_FORK(call->rt, &PUT, DUITE_ARGS(struct args, .n = 7), call->param[0].object);
    return DUITE_FORK(call->rt, &DEEPER, &less, call->param[0].object);
}

static int deeper_waiting(const duite_call *call)
{
    struct args less = *args_of(call);
    const duite_object own = call->param[0].object;

    if (!less.n--)
        return DUITE_FORK(call->rt, &PUT, DUITE_ARGS(struct args, .n = 0), own);
    DUITE_FORK(call->rt, &DEEPER_WAITING, &less, own);
    const int code = duite_wait(call->rt);

    DUITE_FORK(call->rt, &APPEND, DUITE_ARGS(struct args, .n = 1), own);
    return code;
}

/* Appends 0, 1, ... one by one, and knows meanwhile how many there are. */
static int append_all(const duite_call *call)
{
    size_t count = 0, before = 0;

    duite_get_count(call->rt, call->param[0].object, &before);
    for (struct args a = {0}; a.n < args_of(call)->n; a.n++)
        DUITE_FORK(call->rt, &APPEND, &a, call->param[0].object);
    duite_get_count(call->rt, call->param[0].object, &count);
    return count == before + (size_t)args_of(call)->n ? 0 : 50;
}

/* The second child writes the first object, so it may run long before the first one. */
static int fail_all(const duite_call *call)
{
    DUITE_FORK(call->rt, &FAILS, DUITE_ARGS(struct args, .code = 21), call->param[1].object);
    DUITE_FORK(call->rt, &FAILS, DUITE_ARGS(struct args, .code = 22), call->param[0].object);
    if (args_of(call)->n)
        remember_told(duite_wait(call->rt));
    return 0;
}

static int for_ever(const duite_call *call)
{
    const int32_t n = args_of(call)->n;
    size_t before = 0;
    duite_object made;
    int code = 0;

    for (int32_t i = 0; i < n && !code; i++) {
        duite_new(call->rt, DUITE_I32, 1, &made);
        DUITE_FORK(call->rt, &PUT, DUITE_ARGS(struct args, .n = i), made);
        DUITE_FORK(call->rt, &COPY, NULL, made, call->param[0].object);
        code = duite_free(call->rt, made);
        if (!code && i % 50 == 49)
            code = duite_wait(call->rt);
        if (i == n / 4)
            before = mallinfo2().uordblks;
    }
    grown = mallinfo2().uordblks - before;
    return code;
}

/* Its child reads what it reads itself. */
static int through_reader(const duite_call *call)
{
    duite_object made;
    int32_t value;

    duite_new(call->rt, DUITE_I32, 1, &made);
    DUITE_FORK(call->rt, &COPY, NULL, call->param[0].object, made);
    const int code = duite_get(call->rt, made, &value);

    duite_out(call, 1, int32_t)[0] = value + duite_in(call, 0, int32_t)[0];
    return code;
}

/* n, or what it finds. */
static int own_least(const duite_call *call)
{
    int32_t *least = duite_contribute(call, 0);

    if (args_of(call)->n)
        least[0] = args_of(call)->n;
    return 0;
}

/* 5 before and 10 after its two children, if it has any, of depth n. */
static int own_twice(const duite_call *call)
{
    const struct args child = {.n = args_of(call)->n - 1};
    int32_t *before = duite_contribute(call, 0), *after;

    for (int i = 0; i < 2 && child.n >= 0; i++)
        DUITE_FORK(call->rt, &OWN_TWICE, &child, call->param[0].object);
    after = duite_contribute(call, 0);
    before[0] = 5;
    after[0] = 10;
    return args_of(call)->code;
}

static int twice(const duite_call *call)
{
    DUITE_FORK(call->rt, &APPEND, args_of(call), call->param[0].object);
    return DUITE_FORK(call->rt, &APPEND, args_of(call), call->param[0].object);
}

static int nothing(const duite_call *call)
{
    (void)call;
    return 0;
}

static const duite_kernel NOTHING = {.name = "nothing", .body = nothing, .access = {DUITE_WP}};

/* ---- Cases ---- */

static void start(unsigned threads)
{
    static const duite_kernel *const KERNELS[] = {
        &PUT,        &APPEND,    &COPY,     &FAILS,          &DEEPER, &DEEPER_WAITING,
        &APPEND_ALL, &FAIL_ALL,  &FOR_EVER, &THROUGH_READER, &TWICE,  &NOTHING,
        &OWN_LEAST,  &OWN_TWICE, NULL};
    duite_options options = duite_options_default();

    options.kernels = KERNELS;
    options.threads = threads;
    options.bind = 0;
    ck_assert_msg(duite_start(&rt, &options) == DUITE_OK, "%s", duite_message());
    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &object), DUITE_OK);
}

static void begin(void)
{
    start(2);
}

static void end(void)
{
    duite_free(rt, object);
    ck_assert_msg(duite_stop(&rt) == DUITE_OK, "%s", duite_message());
}

static void holds(duite_object what, int32_t expected)
{
    int32_t value = -1;

    ck_assert_msg(duite_get(rt, what, &value) == DUITE_OK, "%s", duite_message());
    ck_assert_int_eq(value, expected);
}

UNIT_FIXTURE(begin, end)

UNIT_TEST(depth)
{
    DUITE_FORK(rt, &DEEPER, DUITE_ARGS(struct args, .n = 20000), object);
    holds(object, 7);
    DUITE_FORK(rt, &DEEPER_WAITING, DUITE_ARGS(struct args, .n = 9), object);
    holds(object, 111111111);
    DUITE_FORK(rt, &DEEPER_WAITING, DUITE_ARGS(struct args, .n = 300), object);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
}

/* As many tasks as one likes, and the memory of fifty. */
UNIT_LOOP(memory, 0, 3)
{
    const struct args args = {.n = unit_quick() ? 20000 : 500000};

    end();
    start(1 + (unsigned)_i);
    DUITE_FORK(rt, &FOR_EVER, &args, object);
    holds(object, args.n - 1);
    ck_assert_msg((int64_t)grown < 1 << 20, "%zu bytes", grown);
}

UNIT_TEST(sizes)
{
    int32_t values[MOST];
    size_t count = 0;
    duite_object list;

    ck_assert_int_eq(duite_new_sized(rt, DUITE_I32, 0, MOST, &list), DUITE_OK);
    DUITE_FORK(rt, &APPEND_ALL, DUITE_ARGS(struct args, .n = 30), list);
    DUITE_FORK(rt, &APPEND_ALL, DUITE_ARGS(struct args, .n = 5), list);
    ck_assert_int_eq(duite_get_count(rt, list, &count), DUITE_OK);
    ck_assert_uint_eq(count, 35);
    ck_assert_int_eq(duite_get(rt, list, values), DUITE_OK);
    for (int32_t i = 0; i < 35; i++)
        ck_assert_int_eq(values[i], i % 30);
    DUITE_FORK(rt, &DEEPER, DUITE_ARGS(struct args, .n = 2),
               list); /* a w: as many as there can be */
    ck_assert_int_eq(duite_get_count(rt, list, &count), DUITE_OK);
    ck_assert_uint_eq(count, MOST);
    duite_free(rt, list);
}

/* The first in the reference order is told, with its place in the tree, by all who wait. */
UNIT_TEST(failures)
{
    duite_object other;
    int32_t value;

    duite_new(rt, DUITE_I32, 1, &other);
    DUITE_FORK(rt, &FAIL_ALL, DUITE_ARGS(struct args, .n = 1), object, other);
    ck_assert_int_eq(duite_wait(rt), 21);
    unit_says(duite_message(), "task 1.1 (kernel fails) failed on rank 0 with code 21: on purpose");
    ck_assert_int_eq(waited, 21);
    unit_says(said, "task 1.1 (kernel fails)");
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(duite_get(rt, object, &value), 22);
    ck_assert_int_eq(duite_get(rt, other, &value), 21);
    DUITE_FORK(rt, &NOTHING, NULL, other); /* a w that nobody does leaves zeros */
    holds(other, 0);
    DUITE_FORK(rt, &FAILS, DUITE_ARGS(struct args, .code = 23), other);
    ck_assert_int_eq(duite_wait(rt), 23);
    duite_set(rt, object, NULL);
    holds(object, 0);
    DUITE_FORK(rt, &DEEPER, DUITE_ARGS(struct args, .n = 3), other); /* heals */
    holds(other, 7);
    duite_free(rt, other);
}

UNIT_TEST(reading)
{
    duite_object other;

    duite_new(rt, DUITE_I32, 1, &other);
    DUITE_FORK(rt, &PUT, DUITE_ARGS(struct args, .n = 6), object);
    DUITE_FORK(rt, &THROUGH_READER, NULL, object, other);
    DUITE_FORK(rt, &PUT, DUITE_ARGS(struct args, .n = 8), object);
    holds(other, 12);
    duite_free(rt, other);
}

static duite_object pair[2];

/* Reads the first, which the next task changes, by a child; and appends two digits by children. */
static int build(duite *runtime, void *context)
{
    (void)context;
    DUITE_FORK(runtime, &THROUGH_READER, NULL, pair[0], pair[1]);
    return DUITE_FORK(runtime, &APPEND, DUITE_ARGS(struct args, .n = 1), pair[0]);
}

static int build_postponed(duite *runtime, void *context)
{
    (void)context;
    return DUITE_FORK(runtime, &TWICE, DUITE_ARGS(struct args, .n = 1), pair[0]);
}

/* The task itself contributes, with children and without any, or fails. */
UNIT_TEST(contributing)
{
    int32_t value = -1;

    duite_set(rt, object, &(int32_t){9});
    DUITE_FORK(rt, &OWN_LEAST, DUITE_ARGS(struct args, .n = 0), object);
    holds(object, 9);
    DUITE_FORK(rt, &OWN_LEAST, DUITE_ARGS(struct args, .n = 5), object);
    holds(object, 5);
    DUITE_FORK(rt, &OWN_TWICE, DUITE_ARGS(struct args, .n = 3), object);
    holds(object, 5 + 15 * 15);
    DUITE_FORK(rt, &OWN_TWICE, DUITE_ARGS(struct args, .n = 0, .code = 24), object);
    ck_assert_int_eq(duite_get(rt, object, &value), 24);
    ck_assert_int_eq(duite_wait(rt), 24);
    duite_set(rt, object, NULL);
}

UNIT_TEST(replays)
{
    duite_graph graph;
    uint64_t rounds;

    for (int i = 0; i < 2; i++)
        duite_new(rt, DUITE_I32, 1, &pair[i]);
    ck_assert_int_eq(duite_graph_new(rt, build, NULL, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 5), DUITE_OK);
    holds(pair[1], 2 * 1111);
    holds(pair[0], 11111);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    duite_graph_free(rt, graph);
    duite_set(rt, pair[0], NULL);
    ck_assert_int_eq(duite_graph_new(rt, build_postponed, NULL, &graph), DUITE_OK);
    ck_assert_int_eq(duite_replay(rt, graph, 3), DUITE_OK);
    holds(pair[0], 111111);
    ck_assert_int_eq(duite_graph_rounds(rt, graph, &rounds), DUITE_OK);
    ck_assert_uint_eq(rounds, 3);
    duite_graph_free(rt, graph);
    for (int i = 0; i < 2; i++)
        duite_free(rt, pair[i]);
}
