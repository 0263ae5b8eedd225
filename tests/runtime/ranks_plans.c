/* Recorded graphs on several ranks: a round sends one message to each neighbour and phase, whatever
 * it carries, and nothing else is sent. Run under mpirun. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>

enum { BLOCKS = 16, LENGTH = 16, MOST = 40, DIRECT_RANKS = 4 };

KERNEL(START, "start", .access = {DUITE_W}, .args_size = sizeof(int))
{
    for (size_t i = 0; i < LENGTH; i++)
        duite_out(call, 0, double)[i] =
            1.0 / (double)(1 + *(const int *)call->args * LENGTH + (int)i);
    return 0;
}

/* to = mean of the neighbours; its square is added to a sum. The ends stay. */
KERNEL(MEAN, "mean", .access = {DUITE_W, DUITE_CW, DUITE_R, DUITE_R, DUITE_R})
{
    const double *here = duite_in(call, 2, double), *left = duite_in(call, 3, double);
    const double *right = duite_in(call, 4, double);
    double *to = duite_out(call, 0, double);

    for (size_t i = 0; i < LENGTH; i++) {
        const double l = i ? here[i - 1] : left[LENGTH - 1],
                     r = i + 1 < LENGTH ? here[i + 1] : right[0];

        to[i] = 0.5 * (l + r);
        duite_out(call, 1, double)[0] += to[i] * to[i];
    }
    return 0;
}

/* scale = scale / 2 + sum; the sum begins again, and the flag counts down. */
KERNEL(JUDGE, "judge", .access = {DUITE_R, DUITE_RW, DUITE_RW}, .replicated = 1)
{
    duite_out(call, 1, double)[0] =
        0.5 * duite_in(call, 1, double)[0] + duite_in(call, 0, double)[0];
    duite_out(call, 2, int64_t)[0] -= 1;
    return 0;
}

KERNEL(SCALE, "scale", .access = {DUITE_R, DUITE_RW})
{
    for (size_t i = 0; i < LENGTH; i++)
        duite_out(call, 1, double)[i] *= 1 + 1e-3 * duite_in(call, 0, double)[0];
    return 0;
}

KERNEL(GIVE, "give", .access = {DUITE_CW}, .args_size = sizeof(double))
{
    duite_out(call, 0, double)[0] += *(const double *)call->args;
    return 0;
}

KERNEL(KEEP, "keep", .access = {DUITE_R, DUITE_W})
{
    duite_out(call, 1, double)[0] = duite_in(call, 0, double)[0];
    return 0;
}

struct rod {
    duite_object x[2][BLOCKS], sum, scale, flag;
};

/* There and back; the sum over the second half decides. */
static int rounds(duite *rt, void *context)
{
    const struct rod *rod = context;

    for (int way = 0; way < 2; way++) {
        duite_set(rt, rod->sum, NULL);
        for (int b = 0; b < BLOCKS; b++)
            DUITE_FORK(rt, &MEAN, NULL, rod->x[!way][b], rod->sum, rod->x[way][b],
                       rod->x[way][(b + BLOCKS - 1) % BLOCKS], rod->x[way][(b + 1) % BLOCKS]);
    }
    DUITE_FORK(rt, &JUDGE, NULL, rod->sum, rod->scale, rod->flag);
    for (int b = 0; b < BLOCKS; b++)
        DUITE_FORK(rt, &SCALE, NULL, rod->scale, rod->x[0][b]);
    return 0;
}

static void make(duite *rt, struct rod *rod)
{
    for (int way = 0; way < 2; way++)
        for (int b = 0; b < BLOCKS; b++) {
            duite_new(rt, DUITE_F64, LENGTH, &rod->x[way][b]);
            if (way)
                duite_colocate(rt, rod->x[1][b], rod->x[0][b]);
            else if (b)
                duite_hint(rt, rod->x[0][b], 1, 1, &rod->x[0][b - 1], NULL);
        }
    duite_new(rt, DUITE_F64, 1, &rod->sum);
    duite_new(rt, DUITE_F64, 1, &rod->scale);
    duite_new(rt, DUITE_I64, 1, &rod->flag);
    for (int way = 0; way < 2; way++)
        for (int b = 0; b < BLOCKS; b++)
            DUITE_FORK(rt, &START, DUITE_ARGS(int, b), rod->x[way][b]);
}

static void unmake(duite *rt, struct rod *rod)
{
    for (int way = 0; way < 2; way++)
        for (int b = 0; b < BLOCKS; b++)
            duite_free(rt, rod->x[way][b]);
    duite_free(rt, rod->sum);
    duite_free(rt, rod->scale);
    duite_free(rt, rod->flag);
}

static uint64_t messages(duite *rt)
{
    duite_counters counters;

    duite_wait(rt);
    return duite_count_all(rt, &counters) ? 0 : counters.messages;
}

/* Pairs of ranks that hold neighbouring blocks, and whether they hold the same as many. */
static unsigned neighbours(duite *rt, const struct rod *rod)
{
    const int n = duite_ranks(rt);
    unsigned pairs = 0;

    for (int p = 0; p < n; p++)
        for (int q = 0; q < n; q++) {
            int touch = 0;

            for (int b = 0; b < BLOCKS; b++) {
                const int here = duite_home(rt, rod->x[0][b]);
                const int next = duite_home(rt, rod->x[0][(b + 1) % BLOCKS]);

                touch |= (here == p && next == q) || (here == q && next == p);
            }
            pairs += p != q && touch;
        }
    return pairs;
}

/* How many ranks hold blocks. */
static unsigned holders(duite *rt, const struct rod *rod)
{
    unsigned n = 0;

    for (int p = 0; p < duite_ranks(rt); p++) {
        int holds = 0;

        for (int b = 0; b < BLOCKS; b++)
            holds |= duite_home(rt, rod->x[0][b]) == p;
        n += (unsigned)holds;
    }
    return n;
}

/* A sum that all of n ranks read. Up to four ranks each sends to each other; else each sends in as
 * many rounds as the number of ranks has bits. */
static unsigned sent_for_sum(unsigned n)
{
    unsigned rounds = 0;

    while (1u << rounds < n)
        rounds++;
    return n <= DIRECT_RANKS ? n * (n - 1) : n * rounds;
}

/* The messages of one round: the halos twice, and the contributions once; the halos of the second
 * way are there when the contributions of the first are. */
static void count(duite *rt, struct rod *rod, duite_graph graph)
{
    const uint64_t halos = 2 * neighbours(rt, rod);
    const uint64_t more = halos + sent_for_sum(holders(rt, rod));
    const uint64_t most = halos + sent_for_sum((unsigned)duite_ranks(rt));
    const int64_t many = 1000;
    uint64_t before, once, thrice;

    duite_set(rt, rod->flag, &many);
    duite_replay(rt, graph, 2); /* what the graph begins with has its place now */
    before = messages(rt);
    duite_replay(rt, graph, 1);
    once = messages(rt);
    duite_replay(rt, graph, 3);
    thrice = messages(rt);
    tap_case(once - before == more, "a round sends one message to each neighbour and phase");
    tap_case(thrice - once == 3 * more, "and so do three");
    before = messages(rt);
    duite_replay_while(rt, graph, rod->flag, 5);
    once = messages(rt) - before; /* ranks without blocks read the flag, too */
    tap_case(once >= 5 * more && once <= 5 * most, "a flag that all ranks compute costs none");
}

/* The same by forks. */
static int agrees(duite *rt, struct rod *rod, duite_graph graph)
{
    double values[2][BLOCKS][LENGTH], sums[2][2];
    const int64_t many = MOST;
    int same = 1;

    for (int way = 0; way < 2; way++) {
        for (int b = 0; b < 2 * BLOCKS; b++)
            DUITE_FORK(rt, &START, DUITE_ARGS(int, b % BLOCKS), rod->x[b / BLOCKS][b % BLOCKS]);
        duite_set(rt, rod->scale, NULL);
        duite_set(rt, rod->flag, &many);
        if (way)
            duite_replay_while(rt, graph, rod->flag, 2 * MOST);
        for (int i = 0; i < MOST && !way; i++)
            rounds(rt, rod);
        for (int b = 0; b < BLOCKS; b++)
            same &= !duite_get(rt, rod->x[0][b], values[way][b]);
        same &=
            !duite_get(rt, rod->sum, &sums[way][0]) && !duite_get(rt, rod->scale, &sums[way][1]);
    }
    for (int b = 0; b < BLOCKS; b++)
        for (int i = 0; i < LENGTH; i++)
            same &= values[0][b][i] == values[1][b][i];
    uint64_t n = 0;

    same &= !duite_graph_rounds(rt, graph, &n) && n == MOST;
    return same && sums[0][0] == sums[1][0] && sums[0][1] == sums[1][1] && sums[0][1] > 0;
}

/* Seven leaves of the first rank, ((0 1) (2 3)) ((4 5) 6): it folds them alone, for the last rank.
 * From the left each of the two small ones would be lost beside 1. */
static int seven_leaves(duite *rt, void *context)
{
    static const double leaf[] = {1, 0, 0, 0, 0x1p-53, 0, 0x1p-53};
    struct rod *rod = context;

    duite_set(rt, rod->sum, NULL);
    for (int i = 0; i < 7; i++)
        duite_fork_at(rt, 0, &GIVE, &leaf[i], 1, &rod->sum);
    return duite_fork_at(rt, duite_ranks(rt) - 1, &KEEP, NULL, 2,
                         (duite_object[]){rod->sum, rod->scale});
}

static int folds(duite *rt, struct rod *rod)
{
    duite_graph graph;
    double sum = 0;
    int fine = !duite_graph_new(rt, seven_leaves, rod, &graph) && !duite_replay(rt, graph, 2) &&
               !duite_get(rt, rod->scale, &sum);

    return !duite_graph_free(rt, graph) && fine && sum == 1 + 0x1p-52;
}

RANKS_CASE(plans)
{
    const duite_kernel *const list[] = {&START, &MEAN, &JUDGE, &SCALE, &GIVE, &KEEP, NULL};
    struct rod rod;
    duite_graph graph;
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = list;
    duite *rt = misuse_start_with(&options);
    if (!rt)
        return 1;
    make(rt, &rod);
    tap_case(!duite_graph_new(rt, rounds, &rod, &graph), "record");
    count(rt, &rod, graph);
    tap_case(agrees(rt, &rod, graph), "replays leave what forks leave");
    tap_case(folds(rt, &rod), "leaves of one rank fold from the right for another one");
    duite_graph_free(rt, graph);
    unmake(rt, &rod);
    tap_case(duite_stop(&rt) == DUITE_OK, "stop");
    return tap_done();
}
