/* Mappings that fail, or give no rank, on one rank or on all, and mappings that are not the same on
 * all ranks: every rank's next or present blocking call says so, and the program ends. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <duite_policy.h>
#include <stdio.h>
#include <string.h>

enum { OBJECTS = 8, ALL = -1 };

static int where;                              /* the rank that is wrong, or ALL */
static enum { FAILS, NO_RANK, DIFFERS } wrong; /* what is wrong there */

static int map(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home)
{
    const int here = where == ALL || where == rank;

    (void)seed;
    /* Where they differ, every other object is nobody's. */
    for (size_t i = 0; i < graph->n; i++)
        home[i] = (int)((graph->before + i + (here && wrong == DIFFERS)) % (size_t)n_ranks);
    if (here && wrong == NO_RANK)
        home[0] = n_ranks;
    return here && wrong == FAILS ? DUITE_E_SYSTEM : DUITE_OK;
}

static const duite_mapping MAPPING = {
    .size = sizeof(duite_mapping), .name = "wrong", .summary = "for tests", .map = map};

static int build(duite *rt, void *context)
{
    const duite_object *object = context;

    for (int i = 1; i < OBJECTS; i++)
        duite_fork(rt, &COPY, NULL, 2, object + i - 1);
    return 0;
}

static int by_get(duite *rt, duite_object *object)
{
    int32_t value;

    build(rt, object);
    return duite_get(rt, object[OBJECTS - 1], &value);
}

static int by_wait(duite *rt, duite_object *object)
{
    build(rt, object);
    return duite_wait(rt);
}

static int by_replay(duite *rt, duite_object *object)
{
    duite_graph graph;
    int code = duite_graph_new(rt, build, object, &graph);

    code = code ? code : duite_replay(rt, graph, 2);
    return code ? code : duite_wait(rt);
}

static void check(int (*work)(duite *, duite_object *), int code, const char *sentence,
                  const char *name)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_object object[OBJECTS];
    duite *rt = NULL;
    int32_t zero = 0;

    options.mapping = &MAPPING;
    int right = !duite_start(&rt, &options);
    for (int i = 0; i < OBJECTS; i++)
        object[i] = misuse_new(rt, 1);
    duite_set(rt, object[0], &zero);
    right = right && work(rt, object) == code && strstr(duite_message(), sentence);
    if (!right)
        fprintf(stderr, "# rank %d: '%s'\n", rank, duite_message());
    duite_stop(&rt);
    tap_case(right && !rt, name);
}

RANKS_CASE(mappings)
{
    static const char *const other = "the mapping gave objects other homes on rank ";

    misuse_mpi();
    wrong = FAILS;
    where = ALL;
    check(by_get, DUITE_E_SYSTEM, "mapping wrong failed with code ", "map fails on all ranks");
    check(by_replay, DUITE_E_SYSTEM, "mapping wrong failed with code ", "so before a replay");
    for (where = 0; where < 2; where++)
        check(by_get, DUITE_E_SYSTEM, "mapping wrong failed with code -10 (the operating system",
              where ? "map fails on rank 1" : "map fails on rank 0");
    where = 1;
    check(by_wait, DUITE_E_SYSTEM, "mapping wrong failed with code ", "so before a wait");
    wrong = NO_RANK;
    check(by_get, DUITE_E_ARGUMENT, "mapping wrong sends an object to rank 2 of 2",
          "a home that is no rank, on rank 1");
    wrong = DIFFERS;
    check(by_get, DUITE_E_DIFFERENT, other, "other homes on rank 1, before a get");
    check(by_wait, DUITE_E_DIFFERENT, other, "other homes on rank 1, before a wait");
    check(by_replay, DUITE_E_DIFFERENT, other, "other homes on rank 1, before a replay");
    return tap_done();
}
