/* Lines of a few points, of which each needs its neighbours at each step: workers await nodes of
 * each other (runtime/workers/await.c). All values, against a loop; of recorded graphs and of forks
 * that are recognised, with bodies that take unequal times. And two values that change side by
 * side, of which one decides on further rounds: the other one's next node may never come. */
#include "tests/runtime/graphs_fixture.h"
#include "tests/support/kernel.h"

#include <duite.h>
#include <stdbool.h>
#include <string.h>

enum { MOST = 4, ROUNDS = 3000, REPLAYS = 20000 };

struct line {
    duite_object object[2][MOST];
    unsigned points;
};

/* A value that depends on the old ones, in the order of the line. */
static uint64_t value_after(const uint64_t *old, size_t n)
{
    uint64_t value = 1;
    for (size_t i = 0; i < n; i++)
        value = 3 * value + old[i];
    return value;
}

static void turn(unsigned times)
{
    for (volatile unsigned i = 0; i < times; i++)
        ;
}

/* Now and then one takes longer, some of them too long to be awaited. */
static void linger(uint64_t value)
{
    turn(value % 31 ? (unsigned)(value % 7) : 4000 * (unsigned)(value % 2));
}

KERNEL(END, "end", .access = {DUITE_W, DUITE_R, DUITE_R})
{
    const size_t n = call->n_params - 1;
    uint64_t old[3];
    for (size_t i = 0; i < n; i++)
        old[i] = duite_in(call, 1 + i, uint64_t)[0];
    const uint64_t value = value_after(old, n);
    duite_out(call, 0, uint64_t)[0] = value;
    linger(value);
    return 0;
}

static const duite_kernel INNER = {
    .name = "inner", .body = END_body, .access = {DUITE_W, DUITE_R, DUITE_R, DUITE_R}};
static const duite_kernel *const KERNELS[] = {&END, &INNER, NULL};

/* The points whose values point i needs: from *first on. */
static size_t line_needs(unsigned points, unsigned i, unsigned *first)
{
    *first = i ? i - 1 : 0;
    return (i + 1 < points ? i + 1 : i) - *first + 1;
}

/* Two steps: there and back. */
static int line_round(duite *rt, void *context)
{
    const struct line *line = context;
    int code = 0;
    for (unsigned s = 0; s < 2; s++)
        for (unsigned i = 0; i < line->points; i++) {
            unsigned first;
            const size_t n = line_needs(line->points, i, &first);
            duite_object objects[4] = {line->object[1 - s][i]};
            for (size_t k = 0; k < n; k++)
                objects[1 + k] = line->object[s][first + k];
            code |= duite_fork(rt, n > 2 ? &INNER : &END, NULL, 1 + n, objects);
        }
    return code;
}

static void line_expect(uint64_t *value, unsigned points, unsigned steps)
{
    uint64_t old[MOST];
    for (unsigned s = 0; s < steps; s++) {
        memcpy(old, value, sizeof old);
        for (unsigned i = 0; i < points; i++) {
            unsigned first;
            const size_t n = line_needs(points, i, &first);
            value[i] = value_after(old + first, n);
        }
    }
}

static void line_run(duite *rt, struct line *line, unsigned rounds, bool recorded)
{
    if (!recorded) {
        for (unsigned i = 0; i < rounds; i++)
            ck_assert_int_eq(line_round(rt, line), 0);
        return;
    }
    const duite_graph graph = graphs_record(rt, line_round, line);
    ck_assert_int_eq(duite_replay(rt, graph, rounds), 0);
    ck_assert_int_eq(duite_graph_free(rt, graph), 0);
}

static void line_check(unsigned points, unsigned threads, bool recorded)
{
    const unsigned rounds = unit_quick() ? ROUNDS / 10 : ROUNDS;
    struct line line = {.points = points};
    uint64_t value[MOST] = {0}, got;
    duite *rt = graphs_start(KERNELS, threads, NULL);
    for (unsigned i = 0; i < points; i++) {
        value[i] = i;
        for (int s = 0; s < 2; s++)
            ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &line.object[s][i]), 0);
        ck_assert_int_eq(duite_set(rt, line.object[0][i], &value[i]), 0);
    }
    line_run(rt, &line, rounds, recorded);
    line_expect(value, points, 2 * rounds);
    for (unsigned i = 0; i < points; i++) {
        ck_assert_int_eq(duite_get(rt, line.object[0][i], &got), 0);
        ck_assert_uint_eq(got, value[i]);
    }
    for (unsigned i = 0; i < 2 * points; i++)
        ck_assert_int_eq(duite_free(rt, line.object[i % 2][i / 2]), 0);
    ck_assert_int_eq(duite_stop(&rt), 0);
}

UNIT_TEST(neighbours_wait_for_each_other)
{
    for (unsigned points = 2; points <= MOST; points++)
        for (unsigned threads = 2; threads <= 3; threads++)
            for (int recorded = 0; recorded < 2; recorded++)
                line_check(points, threads, recorded);
}

/* ---- Rounds that one value decides on ---- */

/* Both bodies take so long that two workers run them, and either may be the last. */
KERNEL(CHANGE, "change", .access = {DUITE_RW})
{
    uint64_t *value = duite_out(call, 0, uint64_t);
    *value = value_after(value, 1);
    turn((unsigned)(*value % 1000));
    return 0;
}

KERNEL(PASS, "pass", .access = {DUITE_RW})
{
    int32_t *left = duite_out(call, 0, int32_t);
    --*left;
    turn(700 * (unsigned)(*left % 3));
    return 0;
}

struct pair {
    duite_object value, left;
};

static int pair_round(duite *rt, void *context)
{
    const struct pair *pair = context;
    return duite_fork(rt, &CHANGE, NULL, 1, &pair->value) |
           duite_fork(rt, &PASS, NULL, 1, &pair->left);
}

UNIT_TEST(rounds_that_do_not_come_are_not_awaited)
{
    const unsigned replays = unit_quick() ? REPLAYS / 10 : REPLAYS;
    struct pair pair;
    uint64_t value = 0, got;
    duite *rt = graphs_start((const duite_kernel *const[]){&CHANGE, &PASS, NULL}, 2, NULL);
    ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &pair.value), 0);
    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &pair.left), 0);
    const duite_graph graph = graphs_record(rt, pair_round, &pair);
    for (unsigned i = 0; i < replays; i++) {
        const int32_t rounds = 20 + (int32_t)(i % 3);
        ck_assert_int_eq(duite_set(rt, pair.left, &rounds), 0);
        ck_assert_int_eq(duite_replay_while(rt, graph, pair.left, 99), 0);
        for (int32_t k = 0; k < rounds; k++)
            value = value_after(&value, 1);
    }
    ck_assert_int_eq(duite_get(rt, pair.value, &got), 0);
    ck_assert_uint_eq(got, value);
    ck_assert_int_eq(duite_graph_free(rt, graph), 0);
    ck_assert_int_eq(duite_free(rt, pair.value), 0);
    ck_assert_int_eq(duite_free(rt, pair.left), 0);
    ck_assert_int_eq(duite_stop(&rt), 0);
}
