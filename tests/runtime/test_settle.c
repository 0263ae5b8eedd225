/* From hints to homes: what a mapping is shown, and who lives where afterwards. */
#include "runtime/map/map.h"
#include "tests/support/unit.h"

#include <string.h>

enum { RANKS = 3, MOST = 40 };

static struct data_table table;
static duite_object object[MOST];

/* The graph that the mapping was shown last, as a matrix. */
static struct {
    int calls;
    size_t n;
    uint64_t before;
    double weight[MOST], edge[MOST][MOST];
} seen;

/* Node i goes to rank i % 3; counts how often it is asked. */
static int map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    memset(seen.edge, 0, sizeof seen.edge);
    seen.calls++;
    seen.n = graph->n;
    seen.before = graph->before;
    for (size_t i = 0; i < graph->n && i < MOST; i++) {
        seen.weight[i] = graph->weight[i];
        home[i] = (int)(i % (size_t)n_ranks);
        for (size_t e = graph->start[i]; e < graph->start[i + 1]; e++) {
            ck_assert(seen.edge[i][graph->neighbour[e]] == 0); /* each neighbour once */
            seen.edge[i][graph->neighbour[e]] = graph->edge_weight[e];
        }
    }
    return 0;
}

static const duite_mapping RECORDER = {
    .size = sizeof(duite_mapping), .name = "recorder", .summary = "", .map = map};

static void make(int first, int n)
{
    for (int i = first; i < first + n; i++)
        ck_assert_int_eq(data_object_new(&table, DUITE_F64, 1, 1, false, &object[i]), DUITE_OK);
}

static void settle(void)
{
    ck_assert_int_eq(map_settle(&table, &(struct map_policy){&RECORDER, NULL}, 1), DUITE_OK);
    ck_assert_uint_eq(table.n_unsettled, 0);
}

static const struct data_object *at(int i)
{
    return data_object_find(&table, object[i]);
}

static void begin(void)
{
    ck_assert_int_eq(data_table_start(&table, RANKS), DUITE_OK);
    memset(&seen, 0, sizeof seen);
}

static void end(void)
{
    data_table_stop(&table);
}

UNIT_FIXTURE(begin, end)

UNIT_TEST(edges_and_weights)
{
    make(0, 4);
    map_hint(&table, object[0], 2, 2, &object[1], (double[]){5, 7});
    map_hint(&table, object[1], 3, 1, &object[0], NULL);
    map_hint(&table, object[1], 4, 1, &object[3], NULL);
    map_hint(&table, object[2], 1, 1, &object[2], NULL); /* to itself: nothing */
    settle();
    ck_assert_int_eq(seen.calls, 1);
    ck_assert_uint_eq(seen.n, 4);
    ck_assert(seen.weight[0] == 2 && seen.weight[1] == 4 && seen.weight[2] == 1);
    ck_assert(seen.edge[0][1] == 6 && seen.edge[1][0] == 6);
    ck_assert(seen.edge[0][2] == 7 && seen.edge[2][0] == 7);
    ck_assert(seen.edge[1][3] == 1 && seen.edge[3][1] == 1);
    ck_assert(seen.edge[2][2] == 0 && seen.edge[2][3] == 0);
    for (int i = 0; i < 4; i++)
        ck_assert(at(i)->home == i % RANKS && at(i)->holder == i % RANKS);
}

/* 0 <- 1 <- 2 <- 3 made in both directions, and 4 alone: two nodes, their weights and edges added
 * up. */
UNIT_TEST(followers)
{
    for (int upwards = 0; upwards < 2; upwards++) {
        make(0, 5);
        for (int i = 1; i < 4; i++)
            map_colocate(&table, object[upwards ? i - 1 : i], object[upwards ? i : i - 1]);
        map_hint(&table, object[2], 5, 1, &object[4], (double[]){3});
        map_hint(&table, object[4], 1, 1, &object[3], (double[]){4});
        map_hint(&table, object[1], 1, 1, &object[2], (double[]){9});
        settle();
        ck_assert_uint_eq(seen.n, 2);
        ck_assert(seen.weight[0] == 8 && seen.weight[1] == 1);
        ck_assert(seen.edge[0][1] == 7 && seen.edge[1][0] == 7 && seen.edge[0][0] == 0);
        for (int i = 0; i < 4; i++) {
            ck_assert_int_eq(at(i)->home, 0);
            ck_assert_uint_eq(at(i)->block, at(0)->block);
        }
        ck_assert_int_eq(at(4)->home, 1);
    }
}

/* An object that follows one with a home goes there, in a chain too; edges to settled ones do not
 * count. */
UNIT_TEST(of_settled_ones)
{
    make(0, 5);
    settle();
    make(5, 4);
    map_colocate(&table, object[5], object[6]);
    map_colocate(&table, object[6], object[4]);
    map_hint(&table, object[7], 1, 3, &object[0], NULL);
    map_hint(&table, object[7], 1, 2, &object[5], NULL);
    map_hint(&table, object[3], 99, 1, &object[8], NULL); /* too late */
    settle();
    ck_assert_uint_eq(seen.before, 5);
    ck_assert_uint_eq(seen.n, 2);
    ck_assert(seen.weight[0] == 1 && seen.weight[1] == 1);
    ck_assert(seen.edge[0][1] == 0 && seen.edge[1][0] == 0);
    ck_assert(at(5)->home == at(4)->home && at(6)->home == at(4)->home);
    ck_assert(at(5)->block == at(4)->block && at(6)->block == at(4)->block);
    ck_assert(at(7)->home == 0 && at(8)->home == 1);
    settle();
    ck_assert_int_eq(seen.calls, 2);
}

/* Blocks count the leaders of each rank, over settlings and slots that are taken again. */
UNIT_TEST(blocks)
{
    make(0, 8);
    map_colocate(&table, object[3], object[0]);
    settle(); /* leaders 0 1 2 4 5 6 7 */
    ck_assert(at(0)->block == 0 && at(4)->block == 1 && at(7)->block == 2);
    ck_assert(at(1)->block == 0 && at(5)->block == 1);
    ck_assert(at(2)->block == 0 && at(6)->block == 1 && at(3)->block == 0);
    data_object_drop(&table, object[5]);
    make(5, 1);
    settle();
    ck_assert(at(5)->home == 0 && at(5)->block == 3);
}

/* A chain of very many, each link before its leader: it has to end some time. */
UNIT_TEST(long_chain)
{
    enum { LONG = 300000 };
    duite_object first, last, next;

    ck_assert_int_eq(data_object_new(&table, DUITE_F64, 1, 1, false, &first), DUITE_OK);
    last = first;
    for (int i = 0; i < LONG; i++) {
        ck_assert_int_eq(data_object_new(&table, DUITE_F64, 1, 1, false, &next), DUITE_OK);
        ck_assert_int_eq(map_colocate(&table, last, next), DUITE_OK);
        last = next;
    }
    settle();
    ck_assert_uint_eq(seen.n, 1);
    ck_assert(seen.weight[0] == LONG + 1);
    ck_assert_uint_eq(data_object_find(&table, first)->block, 0);
}

/* A failed mapping leaves everything to the next try. */
static int map_wrongly(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    (void)seed;
    home[graph->n - 1] = n_ranks;
    return 0;
}

/* The homes by the default mapping of the next n objects, as digits. */
static uint32_t homes_by_default(int first, int n)
{
    uint32_t digits = 0;

    ck_assert_int_eq(map_settle(&table, &(struct map_policy){&map_metis, NULL}, 1), DUITE_OK);
    for (int i = first; i < first + n; i++)
        digits = 10 * digits + 1 + (uint32_t)at(i)->home;
    return digits;
}

/* Objects of which nothing was hinted go round, also from one time to the next; with weights alone
 * they are cut into ranges. */
UNIT_TEST(without_hints)
{
    make(0, 7);
    ck_assert_uint_eq(homes_by_default(0, 7), 1231231);
    make(7, 4);
    ck_assert_uint_eq(homes_by_default(7, 4), 2312);
    make(11, 6);
    ck_assert_int_eq(map_hint(&table, object[11], 4, 0, NULL, NULL), DUITE_OK);
    ck_assert_uint_eq(homes_by_default(11, 6), 122333);
}

UNIT_TEST(wrong_mapping)
{
    const duite_mapping wrong = {
        .size = sizeof(duite_mapping), .name = "wrong", .summary = "", .map = map_wrongly};

    make(0, 4);
    map_hint(&table, object[2], 6, 1, &object[0], NULL);
    ck_assert_int_eq(map_settle(&table, &(struct map_policy){&wrong, NULL}, 1), DUITE_E_ARGUMENT);
    ck_assert_int_eq(at(3)->home, -1);
    settle();
    ck_assert(seen.weight[2] == 6 && seen.edge[0][2] == 1);
}
