/* Bodies that fail on one rank: every rank gets the same code and the same sentence, and poison
 * travels. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { OBJECTS = 8 };

static duite_object a[OBJECTS];

static int says(const char *sentence)
{
    return strstr(duite_message(), sentence) != NULL;
}

static int get(duite *rt, duite_object object)
{
    int32_t value = -99;
    const int code = duite_get(rt, object, &value);

    return code || value != -99 ? code : -99;
}

/* One failing body, on each rank in turn. */
static void one_failure(duite *rt)
{
    for (int where = 0; where < ranks; where++) {
        const int32_t code = 100 + where;
        char sentence[40], name[80];

        snprintf(sentence, sizeof sentence, "sentence %d of a body", code);
        duite_fork_at(rt, where, &FAIL, &code, 1, &a[0]);
        snprintf(name, sizeof name, "wait returns the failure of rank %d everywhere", where);
        tap_case(duite_wait(rt) == code && says(sentence), name);
        tap_case(duite_wait(rt) == DUITE_OK, "and the next wait does not");
        snprintf(name, sizeof name, "get returns the failure of rank %d everywhere", where);
        tap_case(get(rt, a[0]) == code && says(sentence), name);
        tap_case(get(rt, a[0]) == code && says(sentence), "and once more");
        duite_set(rt, a[0], NULL);
        tap_case(get(rt, a[0]) == DUITE_OK, "set cures");
    }
}

/* Poison is handed from rank to rank along a chain of copies. */
static void chain(duite *rt)
{
    const int32_t code = 55;

    duite_fork_at(rt, ranks - 1, &FAIL, &code, 1, &a[0]);
    for (int i = 1; i < OBJECTS; i++)
        duite_fork_at(rt, i % ranks, &COPY, NULL, 2, (duite_object[]){a[i - 1], a[i]});
    tap_case(get(rt, a[OBJECTS - 1]) == 55 && says("sentence 55"),
             "poison travels through all ranks");
    tap_case(get(rt, a[OBJECTS / 2]) == 55 && says("sentence 55"), "and stays where it passed");
    int32_t value = -99;
    const int here = duite_get_at(rt, a[3], ranks - 1, &value);

    tap_case(here == (rank == ranks - 1 ? 55 : DUITE_OK) && value == -99,
             "get_at tells its rank only");
    tap_case(duite_wait(rt) == 55 && says("sentence 55"),
             "wait returns the failure at the chain's start");
    for (int i = 0; i < OBJECTS; i++)
        duite_set(rt, a[i], NULL);
}

/* Failures everywhere: the first in fork order wins, wherever it is found first. */
static void many_failures(duite *rt)
{
    int right = 1;

    for (int round = 0; round < 10; round++) {
        for (int i = 0; i < OBJECTS; i++)
            duite_fork_at(rt, (i + round) % ranks, &FAIL, &(int32_t){200 + i}, 1, &a[i]);
        right &= duite_wait(rt) == 200 && says("sentence 200");
        for (int i = 0; i < OBJECTS; i++)
            duite_set(rt, a[i], NULL);
    }
    tap_case(right, "the first of many failures");
}

/* A contribution that fails on another rank poisons the sum. */
static void failing_contribution(duite *rt)
{
    int32_t value = 0;

    for (int i = 0; i < 5; i++)
        duite_fork_at(rt, i % ranks, &ADD, NULL, 1, &a[0]);
    tap_case(duite_get(rt, a[0], &value) == DUITE_OK && value == 5, "contributions from all ranks");
    duite_fork_at(rt, ranks - 1, &FAIL, &(int32_t){77}, 1, &a[1]);
    for (int i = 0; i < 5; i++)
        duite_fork_at(rt, i % ranks, &ADD, NULL, 1, &a[1]);
    tap_case(get(rt, a[1]) == 77, "adding to what is poisoned does not heal it");
    tap_case(duite_wait(rt) == 77, "and the wait tells");
    duite_set(rt, a[1], NULL);
}

RANKS_CASE(failures)
{
    misuse_mpi();
    duite *rt = misuse_start(MPI_COMM_WORLD, 2);

    tap_case(rt != NULL, "start");
    if (!rt)
        return tap_done();
    for (int i = 0; i < OBJECTS; i++)
        a[i] = misuse_new(rt, 1);
    one_failure(rt);
    chain(rt);
    many_failures(rt);
    failing_contribution(rt);
    duite_fork_at(rt, ranks - 1, &FAIL, &(int32_t){9}, 1, &a[2]);
    for (int i = 0; i < OBJECTS; i++)
        duite_free(rt, a[i]);
    tap_case(duite_stop(&rt) == 9 && says("sentence 9 of a body") && !rt,
             "stop returns the failure everywhere");
    return tap_done();
}
