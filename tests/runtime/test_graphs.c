/* Recorded graphs: what a replay leaves, how many rounds it has, and what may be changed between
 * two of them. The right values are computed here by plain loops. */
#include "tests/runtime/graphs_fixture.h"
#include "tests/support/kernel.h"

#include <duite.h>
#include <duite_policy.h>

#include <stdint.h>
#include <string.h>

enum { POINTS = 24 };

/* out = 3 left + 5 middle + 7 right + argument, modulo 2^64. */
static uint64_t mixed(uint64_t left, uint64_t middle, uint64_t right, uint64_t more)
{
    return 3 * left + 5 * middle + 7 * right + more;
}

KERNEL(STEP, "step", .access = {DUITE_R, DUITE_R, DUITE_R, DUITE_W}, .args_size = sizeof(uint64_t))
{
    duite_out(call, 3, uint64_t)[0] =
        mixed(duite_in(call, 0, uint64_t)[0], duite_in(call, 1, uint64_t)[0],
              duite_in(call, 2, uint64_t)[0], *(const uint64_t *)call->args);
    return 0;
}

KERNEL(TWICE, "twice", .access = {DUITE_RW})
{
    uint64_t *x = duite_out(call, 0, uint64_t);

    x[0] = 2 * x[0] + 1;
    return 0;
}

KERNEL(GIVE, "give", .access = {DUITE_R, DUITE_CW})
{
    duite_out(call, 1, double)[0] = 1.0 / (double)(1 + duite_in(call, 0, uint64_t)[0] % 97);
    return 0;
}

KERNEL(COUNT_DOWN, "count down", .access = {DUITE_RW})
{
    duite_out(call, 0, int32_t)[0]--;
    return 0;
}

static const duite_kernel *const KERNELS[] = {&STEP, &TWICE, &GIVE, &COUNT_DOWN, NULL};

static void stop(duite *rt)
{
    ck_assert_msg(!duite_stop(&rt), "%s", duite_message());
}

/* ---- A stencil: two steps a round, from one copy of the points to the other and back ---- */

struct ring {
    duite_object x[2][POINTS];
    uint64_t value[2][POINTS]; /* what they must be */
    uint64_t more[2];          /* added by the two steps */
};

static void ring_make(duite *rt, struct ring *ring)
{
    ring->more[0] = 11;
    ring->more[1] = 13;
    for (int i = 0; i < 2 * POINTS; i++) {
        ring->value[i % 2][i / 2] = (uint64_t)i * 7919;
        ring->x[i % 2][i / 2] = graphs_number(rt, (int64_t)i * 7919);
    }
}

static int ring_build(duite *rt, void *context)
{
    const struct ring *ring = context;

    for (int s = 0; s < 2; s++)
        for (int i = 0; i < POINTS; i++)
            DUITE_FORK(rt, &STEP, &ring->more[s], ring->x[s][(i + POINTS - 1) % POINTS],
                       ring->x[s][i], ring->x[s][(i + 1) % POINTS], ring->x[1 - s][i]);
    return 0;
}

static void ring_round(struct ring *ring)
{
    for (int s = 0; s < 2; s++)
        for (int i = 0; i < POINTS; i++)
            ring->value[1 - s][i] =
                mixed(ring->value[s][(i + POINTS - 1) % POINTS], ring->value[s][i],
                      ring->value[s][(i + 1) % POINTS], ring->more[s]);
}

static void ring_check(duite *rt, const struct ring *ring)
{
    for (int i = 0; i < 2 * POINTS; i++)
        ck_assert_uint_eq((uint64_t)graphs_value_of(rt, ring->x[i % 2][i / 2]),
                          ring->value[i % 2][i / 2]);
}

static void ring_free(duite *rt, const struct ring *ring)
{
    for (int i = 0; i < 2 * POINTS; i++)
        ck_assert_int_eq(duite_free(rt, ring->x[i % 2][i / 2]), 0);
}

UNIT_TEST(stencil_as_by_hand)
{
    static const unsigned ROUNDS[] = {0, 1, 2, 3, 50, 1};

    for (const char *const *name = duite_scheduler_names(); *name; name++)
        for (unsigned threads = 1; threads <= 4; threads++) {
            duite *rt = graphs_start(KERNELS, threads, *name);
            struct ring ring;

            ring_make(rt, &ring);
            const duite_graph graph = graphs_record(rt, ring_build, &ring);

            ck_assert_uint_eq(graphs_rounds_of(rt, graph), 0);
            for (size_t i = 0; i < sizeof ROUNDS / sizeof *ROUNDS; i++) {
                ck_assert_int_eq(duite_replay(rt, graph, ROUNDS[i]), 0);
                for (unsigned r = 0; r < ROUNDS[i]; r++)
                    ring_round(&ring);
                if (i % 2 == 0)
                    ring_check(rt, &ring);
                ck_assert_uint_eq(graphs_rounds_of(rt, graph), ROUNDS[i]);
            }
            ring_check(rt, &ring);
            ck_assert_int_eq(duite_graph_free(rt, graph), 0);
            ring_free(rt, &ring);
            stop(rt);
        }
}

UNIT_TEST(counters_of_replays)
{
    duite *rt = graphs_start(KERNELS, 2, "steal");
    struct ring ring;
    duite_counters before, after;
    const uint64_t tasks = 2 * POINTS * 100;

    ring_make(rt, &ring);
    const duite_graph graph = graphs_record(rt, ring_build, &ring);

    ck_assert_int_eq(duite_wait(rt), 0);
    ck_assert_int_eq(duite_count_all(rt, &before), 0);
    ck_assert_int_eq(duite_replay(rt, graph, 100), 0);
    ck_assert_int_eq(duite_wait(rt), 0);
    ck_assert_int_eq(duite_count_all(rt, &after), 0);
    ck_assert_uint_eq(after.tasks - before.tasks, tasks);
    /* Every task is placed or chained, and so is the replay itself. */
    ck_assert_uint_eq(after.placed - before.placed + after.chained - before.chained, tasks + 1);
    ck_assert(after.stolen - before.stolen <= after.placed - before.placed);
    ck_assert_uint_eq(after.graphs_recorded, 1);
    ck_assert_int_eq(duite_graph_free(rt, graph), 0);
    ring_free(rt, &ring);
    stop(rt);
}

/* ---- Contributions ---- */

enum { LEAVES = 11 };

struct sums {
    duite_object x, sum;
};

/* x = 2 x + 1 and a contribution, LEAVES times: those of one round and of the next are one sum. */
static int open_sums_build(duite *rt, void *context)
{
    const struct sums *sums = context;

    for (int i = 0; i < LEAVES; i++) {
        DUITE_FORK(rt, &TWICE, NULL, sums->x);
        DUITE_FORK(rt, &GIVE, NULL, sums->x, sums->sum);
    }
    return 0;
}

/* sum = 0 before. */
static int sums_build(duite *rt, void *context)
{
    duite_set(rt, ((const struct sums *)context)->sum, NULL);
    return open_sums_build(rt, context);
}

/* Replays, and forks the same by hand; both leave the same bits. */
static void check_sums(duite_build *build, unsigned rounds, int begun)
{
    duite *rt = graphs_start(KERNELS, 3, "shuffle");
    struct sums sums[2];
    double value[2];

    for (int way = 0; way < 2; way++) {
        sums[way].x = graphs_number(rt, 5);
        ck_assert_int_eq(duite_new(rt, DUITE_F64, 1, &sums[way].sum), 0);
        for (int i = 0; i < begun; i++)
            DUITE_FORK(rt, &GIVE, NULL, sums[way].x, sums[way].sum);
    }
    const duite_graph graph = graphs_record(rt, build, &sums[0]);

    ck_assert_int_eq(duite_replay(rt, graph, rounds), 0);
    for (unsigned r = 0; r < rounds; r++)
        build(rt, &sums[1]);
    ck_assert_uint_eq(graphs_rounds_of(rt, graph), rounds);
    for (int way = 0; way < 2; way++) {
        DUITE_FORK(rt, &GIVE, NULL, sums[way].x, sums[way].sum);
        ck_assert_int_eq(duite_get(rt, sums[way].sum, &value[way]), 0);
        ck_assert_int_eq(duite_free(rt, sums[way].sum), 0);
        ck_assert_int_eq(duite_free(rt, sums[way].x), 0);
    }
    ck_assert_int_eq(memcmp(&value[0], &value[1], sizeof value[0]), 0);
    ck_assert_int_eq(duite_graph_free(rt, graph), 0);
    stop(rt);
}

UNIT_TEST(sums_have_the_same_bits)
{
    for (unsigned rounds = 0; rounds < 6; rounds++)
        for (int begun = 0; begun < 4; begun++) {
            check_sums(sums_build, rounds, begun);
            check_sums(open_sums_build, rounds, begun);
        }
}

/* ---- While a flag holds ---- */

struct loop {
    duite_object flag, x, y;
};

static int loop_build(duite *rt, void *context)
{
    const struct loop *loop = context;

    DUITE_FORK(rt, &TWICE, NULL, loop->x);
    DUITE_FORK(rt, &COUNT_DOWN, NULL, loop->flag);
    for (int i = 0; i < 3; i++)
        DUITE_FORK(rt, &TWICE, NULL, loop->y);
    return 0;
}

static void loop_end(duite *rt, duite_graph graph, const struct loop *loop)
{
    ck_assert_int_eq(duite_graph_free(rt, graph), 0);
    ck_assert_int_eq(duite_free(rt, loop->flag), 0);
    ck_assert_int_eq(duite_free(rt, loop->x), 0);
    ck_assert_int_eq(duite_free(rt, loop->y), 0);
    stop(rt);
}

static uint64_t doubled(unsigned times)
{
    uint64_t x = 0;

    while (times--)
        x = 2 * x + 1;
    return x;
}

/* The flag counts down from `from`; x and y are 0 before. */
static void check_loop(unsigned threads, int32_t from, uint64_t max, uint64_t expected)
{
    duite *rt = graphs_start(KERNELS, threads, "steal");
    struct loop loop = {.x = graphs_number(rt, 0), .y = graphs_number(rt, 0)};

    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &loop.flag), 0);
    const duite_graph graph = graphs_record(rt, loop_build, &loop);

    for (unsigned again = 1; again < 4; again++) {
        ck_assert_int_eq(duite_set(rt, loop.flag, &from), 0);
        ck_assert_int_eq(duite_replay_while(rt, graph, loop.flag, max), 0);
        if (again < 3)
            ck_assert_uint_eq(graphs_rounds_of(rt, graph), expected);
        ck_assert_uint_eq((uint64_t)graphs_value_of(rt, loop.x),
                          doubled(again * (unsigned)expected));
        ck_assert_uint_eq((uint64_t)graphs_value_of(rt, loop.y),
                          doubled(3 * again * (unsigned)expected));
    }
    loop_end(rt, graph, &loop);
}

UNIT_TEST(while_a_flag_holds)
{
    for (unsigned threads = 1; threads <= 3; threads++) {
        check_loop(threads, 1, 100, 1);
        check_loop(threads, 5, 100, 5);
        check_loop(threads, 5, 5, 5);
        check_loop(threads, 5, 4, 4);
        check_loop(threads, 0, 6, 6); /* at least one round: -1 is not zero */
        check_loop(threads, 3, 1, 1);
    }
}

/* An object that no task of the graph writes, of every type: 0 ends after one round. */
UNIT_TEST(flags_of_every_type)
{
    static const duite_type TYPES[] = {DUITE_BYTE, DUITE_I32, DUITE_I64, DUITE_F32,
                                       DUITE_F64,  DUITE_U16, DUITE_CF32};
    duite *rt = graphs_start(KERNELS, 2, "fifo");
    struct loop loop = {.x = graphs_number(rt, 0), .y = graphs_number(rt, 0)};

    ck_assert_int_eq(duite_new(rt, DUITE_I32, 1, &loop.flag), 0);
    const duite_graph graph = graphs_record(rt, loop_build, &loop);

    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++) {
        const unsigned char byte[3] = {1, 0, 0};
        const int32_t i32[3] = {256, 0, 0};
        const int64_t i64[3] = {INT64_C(1) << 40, 0, 0};
        const float f32[3] = {1e-30f, 0, 0}, minus = -0.0f;
        const double f64[3] = {1e-300, 0, 0};
        const uint16_t u16[3] = {256, 0, 0};
        const float cf32[6] = {minus, 1e-30f, 0};
        const void *const values[] = {byte, i32, i64, f32, f64, u16, cf32};
        duite_object flag;

        ck_assert_int_eq(duite_new(rt, TYPES[i], 3, &flag), 0);
        ck_assert_int_eq(duite_replay_while(rt, graph, flag, 4), 0);
        ck_assert_uint_eq(graphs_rounds_of(rt, graph), 1);
        ck_assert_int_eq(duite_set(rt, flag, values[i]), 0);
        ck_assert_int_eq(duite_replay_while(rt, graph, flag, 4), 0);
        ck_assert_uint_eq(graphs_rounds_of(rt, graph), 4);
        if (TYPES[i] == DUITE_F32) {
            ck_assert_int_eq(duite_set(rt, flag, (float[3]){minus, 1, 1}), 0);
            ck_assert_int_eq(duite_replay_while(rt, graph, flag, 4), 0);
            ck_assert_uint_eq(graphs_rounds_of(rt, graph), 1);
        }
        ck_assert_int_eq(duite_free(rt, flag), 0);
    }
    loop_end(rt, graph, &loop);
}
