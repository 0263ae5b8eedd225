/* Which blocks the balancer `migrate` moves, on graphs with known loads; and what workers spent for
 * blocks. */
#include "runtime/balance/balance.h"
#include "runtime/balance/refine.h"
#include "runtime/workers/cost.h"
#include "tests/support/unit.h"

#include <duite.h>

#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, BLOCKS = SIDE * SIDE, RANKS = 4, MAX_RANKS = 8 };

/* A grid of blocks that exchange 1000 bytes with each neighbour, in quadrants or stripes. */
static struct {
    duite_blocks blocks;
    double weight[BLOCKS], edge[4 * BLOCKS], other[MAX_RANKS];
    size_t start[BLOCKS + 1], bytes[BLOCKS];
    uint32_t neighbour[4 * BLOCKS];
    unsigned char fixed[BLOCKS];
    unsigned workers[MAX_RANKS];
    int home[BLOCKS];
    uint64_t state[64];
} grid;

static void connect(void)
{
    static const int STEP[4][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}};
    size_t n = 0;
    for (int i = 0; i < BLOCKS; i++) {
        grid.start[i] = n;
        for (int k = 0; k < 4; k++) {
            const int x = i % SIDE + STEP[k][0], y = i / SIDE + STEP[k][1];
            if (x < 0 || y < 0 || x >= SIDE || y >= SIDE)
                continue;
            grid.neighbour[n] = (uint32_t)(y * SIDE + x);
            grid.edge[n++] = 1000;
        }
    }
    grid.start[BLOCKS] = n;
}

/* n_ranks 4: quadrants; else stripes. All blocks take 1 ms. */
static void make(int n_ranks)
{
    memset(&grid, 0, sizeof grid);
    connect();
    grid.blocks = (duite_blocks){.graph = {.n = BLOCKS,
                                           .weight = grid.weight,
                                           .start = grid.start,
                                           .neighbour = grid.neighbour,
                                           .edge_weight = grid.edge},
                                 .bytes = grid.bytes,
                                 .fixed = grid.fixed,
                                 .n_ranks = n_ranks,
                                 .other = grid.other,
                                 .workers = grid.workers,
                                 .byte_seconds = 1e-9,
                                 .seconds = 0.1,
                                 .migrate_seconds = 1e-5,
                                 .replays = 10,
                                 .since = 1,
                                 .mapping = duite_mapping_find("metis"),
                                 .seed = 1};
    for (int i = 0; i < BLOCKS; i++) {
        const int x = i % SIDE, y = i / SIDE;
        grid.weight[i] = 1e-3;
        grid.bytes[i] = 10000;
        grid.home[i] = n_ranks == 4 ? y / (SIDE / 2) * 2 + x / (SIDE / 2) : x * n_ranks / SIDE;
    }
    for (int r = 0; r < n_ranks; r++)
        grid.workers[r] = 1;
    memset(grid.state, 0, sizeof grid.state);
}

static struct balance_bill bill(const int *present)
{
    struct balance_bill bill;
    ck_assert(balance_bill(&grid.blocks, present, grid.home, &bill));
    return bill;
}

/* Asks once; returns how many blocks moved. */
static int ask(uint64_t *next)
{
    int before[BLOCKS], moved = 0;
    memcpy(before, grid.home, sizeof before);
    const uint64_t answer = balance_migrate.migrate(grid.state, &grid.blocks, grid.home);
    for (int i = 0; i < BLOCKS; i++) {
        moved += grid.home[i] != before[i];
        ck_assert(grid.home[i] >= 0 && grid.home[i] < grid.blocks.n_ranks);
        ck_assert(!grid.fixed[i] || grid.home[i] == before[i]);
    }
    if (next)
        *next = answer;
    return moved;
}

static double excess(void)
{
    const struct balance_bill now = bill(grid.home);
    return now.max / now.even - 1;
}

/* One rank's blocks three times as dear. */
static void make_uneven(int n_ranks)
{
    make(n_ranks);
    for (int i = 0; i < BLOCKS; i++)
        grid.weight[i] = grid.home[i] == 0 ? 3e-3 : 1e-3;
}

UNIT_TEST(even)
{
    uint64_t next, before = 0;
    make(RANKS);
    for (int i = 0; i < 8; i++) {
        ck_assert_int_eq(ask(&next), 0);
        ck_assert(next >= before && next <= 32); /* ever less often */
        before = next;
    }
    ck_assert_uint_eq(before, 32);
}

UNIT_TEST(noise)
{
    uint64_t random = 7;
    make(RANKS);
    for (int look = 0; look < 50; look++) {
        for (int i = 0; i < BLOCKS; i++)
            grid.weight[i] = 1e-3 * (0.8 + 4e-4 * (double)(duite_random(&random) % 1000));
        ck_assert_int_eq(ask(NULL), 0);
    }
}

/* 64 blocks of 3 ms, 192 of 1: each rank is to have 96 ms, so at least 32 of the dear ones go, no
 * more than these by much, and the border grows little. */
UNIT_TEST(one_is_dear)
{
    uint64_t next;
    make_uneven(RANKS);
    const double cut = bill(grid.home).cut;
    const int moved = ask(&next);
    ck_assert(excess() < 0.03);
    ck_assert(moved >= 32 && moved <= 48);
    ck_assert(bill(grid.home).cut < 1.5 * cut);
    ck_assert_uint_eq(next, 1); /* it wants to see what came of it */
    ck_assert_int_eq(ask(&next), 0);
    ck_assert_uint_eq(next, 2);
}

UNIT_TEST(same_again)
{
    int first[BLOCKS];
    make_uneven(RANKS);
    ask(NULL);
    memcpy(first, grid.home, sizeof first);
    make_uneven(RANKS);
    ask(NULL);
    ck_assert_mem_eq(first, grid.home, sizeof first);
}

/* The dear rank is the first of a line: what it gives goes on to those behind. */
UNIT_TEST(line)
{
    make_uneven(MAX_RANKS);
    ask(NULL);
    ck_assert(excess() < 0.05);
}

UNIT_TEST(some_stay)
{
    make_uneven(RANKS);
    for (int i = 0; i < BLOCKS; i++)
        grid.fixed[i] = grid.home[i] == 0 && i % 2;
    ck_assert(ask(NULL) > 0); /* which checks that these did */
    ck_assert(excess() < 0.05);
    make_uneven(RANKS);
    memset(grid.fixed, 1, sizeof grid.fixed);
    ck_assert_int_eq(ask(NULL), 0);
}

/* Work that cannot move is work all the same, and more workers do more. */
UNIT_TEST(fixed_work)
{
    make(RANKS);
    grid.other[1] = 0.032;
    ask(NULL);
    ck_assert(excess() < 0.05);
    ck_assert(bill(grid.home).even > 0.0719); /* 64 of blocks, 8 of it */
    make(RANKS);
    grid.workers[2] = 5;
    ask(NULL);
    ck_assert(excess() < 0.05);
}

UNIT_TEST(too_dear_to_move)
{
    make_uneven(RANKS);
    grid.blocks.byte_seconds = 1; /* hours, for what saves a second in ten replays */
    ck_assert_int_eq(ask(NULL), 0);
    grid.blocks.byte_seconds = 1e-9;
    ck_assert_int_gt(ask(NULL), 0);
}

UNIT_TEST(too_little_measured)
{
    make_uneven(RANKS);
    for (int i = 0; i < BLOCKS; i++)
        grid.weight[i] *= 1e-3;
    ck_assert_int_eq(ask(NULL), 0);
    make_uneven(RANKS);
    grid.blocks.replays = 1; /* of the very first replay */
    ck_assert_int_eq(ask(NULL), 0);
}

/* Whatever moves, the same rank is slow again: that is none of the blocks' doing. */
UNIT_TEST(in_vain)
{
    int moves = 0;
    make(RANKS);
    for (int look = 0; look < 20; look++) {
        for (int i = 0; i < BLOCKS; i++)
            grid.weight[i] = grid.home[i] == 0 ? 1.2e-3 * 64 : 1e-3 * 64;
        for (int r = 0; r < RANKS; r++) { /* a rank's time does not depend on its blocks */
            int n = 0;
            for (int i = 0; i < BLOCKS; i++)
                n += grid.home[i] == r;
            for (int i = 0; i < BLOCKS; i++)
                grid.weight[i] /= grid.home[i] == r ? n : 1;
        }
        moves += ask(NULL) > 0;
    }
    ck_assert_int_le(moves, 3);
}

/* Looks that take long are rare. */
UNIT_TEST(dear_looks)
{
    uint64_t next;
    make(RANKS);
    grid.blocks.migrate_seconds = 0.1;
    ask(&next);
    ck_assert_uint_ge(next, 100);
}

/* Scattered blocks are mapped again, since no small change makes them even with few bytes. */
UNIT_TEST(ragged)
{
    make(RANKS);
    for (int i = 0; i < BLOCKS; i++)
        grid.home[i] = i % 7 % RANKS; /* 37, 37, 37 and 18 of 128 */
    grid.blocks.byte_seconds = 1e-6;
    grid.blocks.replays = 1000;
    const double cut = bill(grid.home).cut;
    ck_assert(ask(NULL) > 0);
    ck_assert(excess() < 0.05);
    ck_assert(bill(grid.home).cut < 0.3 * cut);
}

/* The parts of a new map get the names that leave most blocks where they are. */
static int quadrants(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    for (size_t i = 0; i < graph->n; i++)
        home[i] = n_ranks - 1 - (int)(i / SIDE / (SIDE / 2) * 2 + i % SIDE / (SIDE / 2));
    return 0;
}

static int fails(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)graph;
    (void)n_ranks;
    (void)seed;
    (void)home;
    return DUITE_E_MEMORY;
}

UNIT_TEST(names_of_parts)
{
    const duite_mapping turned = {
        .size = sizeof(duite_mapping), .name = "turned", .summary = "", .map = quadrants};
    const duite_mapping broken = {
        .size = sizeof(duite_mapping), .name = "broken", .summary = "", .map = fails};
    int before[BLOCKS];
    make(RANKS);
    memcpy(before, grid.home, sizeof before);
    grid.blocks.mapping = &turned;
    ck_assert(balance_anew(&grid.blocks, 10, grid.home));
    ck_assert_mem_eq(before, grid.home, sizeof before);
    grid.blocks.mapping = &broken;
    ck_assert(!balance_anew(&grid.blocks, 10, grid.home));
    ck_assert_mem_eq(before, grid.home, sizeof before);
}

UNIT_TEST(spent)
{
    static struct work_spent sums;
    static const uint32_t BLOCK[] = {0, 1, 2, 3, 6, 7, 1000, 100000};
    enum { N = sizeof BLOCK / sizeof *BLOCK };
    for (unsigned k = 0; k < 3 * N; k++)
        work_spend(&sums, BLOCK[k % N], 1 + k % N);
    work_spend(&sums, DUITE_NO_BLOCK, 100);
    for (unsigned k = 0; k < N; k++) {
        ck_assert_uint_eq(work_spent_take(&sums, BLOCK[k]), 3 * (1 + k));
        ck_assert_uint_eq(work_spent_take(&sums, BLOCK[k]), 0);
    }
    ck_assert_uint_eq(work_spent_take(&sums, 5), 0);
    ck_assert_uint_eq(work_spent_take(&sums, UINT32_MAX - 1), 0);
    ck_assert_uint_eq(work_spent_take(&sums, DUITE_NO_BLOCK), 100);
    work_spend(&sums, 7, 5);
    ck_assert_uint_eq(work_spent_take(&sums, 7), 5);
    ck_assert_uint_eq(work_spent_take(&sums, DUITE_NO_BLOCK), 0);
    work_spent_free(&sums);
}
