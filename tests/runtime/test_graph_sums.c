/* Running plans: contributions that a round makes and reads, against the same forks by hand. All
 * rounds are the plan's, since no contribution is open at a round's end. */
#include "tests/support/unit.h"

#include <duite.h>
#include <duite_policy.h>

#include <string.h>

enum { LEAVES = 11 };

static int advance(const duite_call *call)
{
    uint64_t *x = duite_out(call, 0, uint64_t);

    x[0] = 2 * x[0] + 1;
    return 0;
}

/* Adds to what it finds, which is the neutral element. */
static int give(const duite_call *call)
{
    duite_out(call, 1, double)[0] += 1.0 / (double)(1 + duite_in(call, 0, uint64_t)[0] % 97);
    return 0;
}

static int keep(const duite_call *call)
{
    double *y = duite_out(call, 1, double);

    y[0] = 0.75 * y[0] + duite_in(call, 0, double)[0];
    return 0;
}

static const duite_kernel ADVANCE = {.name = "advance", .body = advance, .access = {DUITE_RW}};
static const duite_kernel GIVE = {.name = "give", .body = give, .access = {DUITE_R, DUITE_CW}};
static const duite_kernel KEEP = {.name = "keep", .body = keep, .access = {DUITE_R, DUITE_RW}};
static const duite_kernel *const KERNELS[] = {&ADVANCE, &GIVE, &KEEP, NULL};

struct sums {
    duite_object x, sum, y;
};

static int sums_build(duite *rt, void *context)
{
    const struct sums *sums = context;

    for (int i = 0; i < LEAVES; i++) {
        DUITE_FORK(rt, &ADVANCE, NULL, sums->x);
        DUITE_FORK(rt, &GIVE, NULL, sums->x, sums->sum);
    }
    return DUITE_FORK(rt, &KEEP, NULL, sums->sum, sums->y);
}

static void check_sums(unsigned threads, unsigned rounds)
{
    duite_options options = duite_options_default();
    duite *rt = NULL;
    struct sums sums[2];
    double sum[2], y[2];
    duite_graph graph;

    options.kernels = KERNELS;
    options.threads = threads;
    options.bind = 0;
    ck_assert_msg(!duite_start(&rt, &options), "%s", duite_message());
    for (int way = 0; way < 2; way++) {
        ck_assert_int_eq(duite_new(rt, DUITE_I64, 1, &sums[way].x), 0);
        ck_assert_int_eq(duite_new(rt, DUITE_F64, 1, &sums[way].sum), 0);
        ck_assert_int_eq(duite_new(rt, DUITE_F64, 1, &sums[way].y), 0);
    }
    ck_assert_int_eq(duite_graph_new(rt, sums_build, &sums[0], &graph), 0);
    ck_assert_int_eq(duite_replay(rt, graph, rounds), 0);
    for (unsigned i = 0; i < rounds; i++)
        ck_assert_int_eq(sums_build(rt, &sums[1]), 0);
    for (int way = 0; way < 2; way++) {
        ck_assert_int_eq(duite_get(rt, sums[way].sum, &sum[way]), 0);
        ck_assert_int_eq(duite_get(rt, sums[way].y, &y[way]), 0);
        ck_assert_int_eq(duite_free(rt, sums[way].x), 0);
        ck_assert_int_eq(duite_free(rt, sums[way].sum), 0);
        ck_assert_int_eq(duite_free(rt, sums[way].y), 0);
    }
    ck_assert(sum[0] > 0 && y[0] > 0);
    ck_assert(!memcmp(&sum[0], &sum[1], sizeof sum[0]) && !memcmp(&y[0], &y[1], sizeof y[0]));
    ck_assert_int_eq(duite_graph_free(rt, graph), 0);
    ck_assert_int_eq(duite_stop(&rt), 0);
}

UNIT_TEST(sums_of_a_round)
{
    for (unsigned threads = 1; threads < 4; threads += 2)
        for (unsigned rounds = 1; rounds < 6; rounds++)
            check_sums(threads, rounds);
}
