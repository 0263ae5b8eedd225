/* The home of an object is settled once; later calls do not change it. Objects go
 * to the ranks one after the other; one that could still follow another would go elsewhere. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>

enum { MOST = 16 };

static duite *rt;
static duite_graph graph;
static duite_object a[MOST], freed;
static int made;

static int build_nothing(duite *runtime, void *context)
{
    (void)runtime;
    (void)context;
    return 0;
}

static void by_nothing(void)
{
}

static void by_fork(void)
{
    duite_fork(rt, &EMPTY, NULL, 0, NULL);
}

static void by_set(void)
{
    duite_set(rt, a[0], NULL);
}

static void by_get(void)
{
    duite_get(rt, a[0], &(int32_t){0});
}

static void by_get_at(void)
{
    duite_get_at(rt, a[0], 0, &(int32_t){0});
}

static void by_get_count(void)
{
    duite_get_count(rt, a[0], &(size_t){0});
}

static void by_free(void)
{
    duite_free(rt, freed);
}

static void by_home(void)
{
    duite_home(rt, a[0]);
}

static void by_graph_new(void)
{
    duite_graph another;

    duite_graph_new(rt, build_nothing, NULL, &another);
    duite_graph_free(rt, another);
}

static void by_replay(void)
{
    duite_replay(rt, graph, 0);
}

static void by_replay_while(void)
{
    duite_replay_while(rt, graph, a[0], 1);
}

/* Makes an object, does something, and says that the object follows one on the next rank. */
static int home_after(void (*settles)(void))
{
    a[made] = misuse_new(rt, 1);
    settles();
    duite_colocate(rt, a[made], a[(made + 1) % ranks]);
    return duite_home(rt, a[made++]);
}

static void case_of(void (*settles)(void), const char *name)
{
    const int expected = made % ranks;

    tap_case(home_after(settles) == expected, name);
}

RANKS_CASE(homes)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    misuse_mpi();
    options.mapping = duite_mapping_find("cyclic");
    tap_case(duite_start(&rt, &options) == DUITE_OK, "starts");
    while (made < ranks)
        a[made++] = misuse_new(rt, 1);
    duite_graph_new(rt, build_nothing, NULL, &graph);
    case_of(by_fork, "settled by a fork");
    case_of(by_set, "by a set");
    case_of(by_get, "by a get");
    case_of(by_get_at, "by a get on one rank");
    case_of(by_get_count, "by a get of the count");
    case_of(by_home, "by being asked");
    case_of(by_graph_new, "by a graph");
    case_of(by_replay, "by a replay");
    case_of(by_replay_while, "by a replay while");
    freed = a[made - 1];
    case_of(by_free, "by a free");
    const int elsewhere = made % ranks;

    tap_case(home_after(by_nothing) == (elsewhere + 1) % ranks, "without all that it may follow");
    for (int i = 0; i < made; i++)
        if (a[i].slot != freed.slot || a[i].generation != freed.generation)
            duite_free(rt, a[i]);
    duite_graph_free(rt, graph);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
    return tap_done();
}
