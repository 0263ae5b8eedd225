/* Runtimes on communicators of every kind, by different ranks at the same time. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>

/* A chain through all ranks of the group, and contributions of all; returns whether the answers are
 * right. */
static int live(MPI_Comm comm, unsigned threads)
{
    duite *rt = misuse_start(comm, threads);
    int32_t last = -1, total = -1, size, me;
    duite_object a[5], sum;
    int right = rt != NULL;

    if (!rt)
        return 0;
    MPI_Comm_size(comm, &size);
    MPI_Comm_rank(comm, &me);
    right &= duite_ranks(rt) == size && duite_rank(rt) == me;
    right &= threads ? duite_threads(rt) == threads : duite_threads(rt) >= 1;
    sum = misuse_new(rt, 1);
    for (int i = 0; i < 5; i++)
        a[i] = misuse_new(rt, 1);
    for (int round = 0; round < 10; round++) {
        duite_set(rt, a[0], &(int32_t){round});
        for (int i = 1; i < 5; i++)
            duite_fork_at(rt, (i + round) % size, &COPY, NULL, 2, (duite_object[]){a[i - 1], a[i]});
        for (int i = 0; i < 7; i++)
            duite_fork_at(rt, (i + round) % size, &ADD, NULL, 1, &sum);
    }
    right &= duite_get(rt, a[4], &last) == DUITE_OK && last == 9 + 4;
    right &=
        duite_get_at(rt, sum, size - 1, &total) == DUITE_OK && total == (me == size - 1 ? 70 : -1);
    for (int i = 0; i < 5; i++)
        duite_free(rt, a[i]);
    duite_free(rt, sum);
    return duite_stop(&rt) == DUITE_OK && right;
}

/* Large objects for several ranks are refused before any byte moves. */
static void too_large(void)
{
    duite *rt = misuse_start(MPI_COMM_WORLD, 1);
    duite_object object = {7, 7};
    const int code = duite_new(rt, DUITE_BYTE, (size_t)1 << 62, &object);

    tap_case(code == DUITE_E_ARGUMENT || code == DUITE_E_MEMORY,
             "an object larger than any machine");
    tap_case(object.slot == 0 && object.generation == 0, "is no object");
    tap_case(duite_wait(rt) == code, "and the wait says so once more");
    tap_case(duite_stop(&rt) == DUITE_OK, "and nothing is left");
}

/* A communicator of two groups is none of duite's. */
static void two_groups(MPI_Comm half)
{
    MPI_Comm between;
    duite *rt = (duite *)&between;

    MPI_Intercomm_create(half, 0, MPI_COMM_WORLD, 1 - rank % 2, 0, &between);
    duite_options options = misuse_options(between);
    tap_case(duite_start(&rt, &options) == DUITE_E_ARGUMENT && !rt, "an intercommunicator");
    misuse_keep_message();
    tap_case(misuse_all_told("MPI_Intercomm_merge"), "is refused with a way out");
    MPI_Comm_free(&between);
}

RANKS_CASE(groups)
{
    MPI_Comm half, reversed;
    int right = 1;

    misuse_mpi();
    tap_case(live(MPI_COMM_WORLD, 2), "the world");
    tap_case(live(MPI_COMM_WORLD, 0), "threads by default");
    MPI_Comm_split(MPI_COMM_WORLD, 0, -rank, &reversed);
    tap_case(live(reversed, 1 + (unsigned)rank % 3),
             "the world backwards, with different numbers of threads");
    for (int i = 0; i < 5 + 3 * rank; i++)
        right &= live(MPI_COMM_SELF, 1 + (unsigned)(i + rank) % 3);
    tap_case(right, "each rank on its own, at the same time, more often on some");
    MPI_Comm_split(MPI_COMM_WORLD, rank % 2, 0, &half);
    right = 1;
    for (int i = 0; i < 5 + 3 * (rank % 2); i++)
        right &= live(half, 2);
    tap_case(right, "halves at the same time");
    right = 1;
    for (int i = 0; i < 50; i++)
        right &= live(MPI_COMM_WORLD, 1 + (unsigned)i % 2);
    tap_case(right, "fifty lives");
    too_large();
    if (ranks > 1)
        two_groups(half);
    MPI_Comm_free(&half);
    MPI_Comm_free(&reversed);
    return tap_done();
}
