/* A program's own MPI between begin and end: it sees no message of the runtime's, workers and signs
 * of life call MPI at no other time, and tasks go on afterwards. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>

enum { OBJECTS = 4, TIMES = 200, COUNT = 100 };

/* Values go round: this rank's number to the next one, and the sum of all. */
static int own_mpi(int time)
{
    int there = -1, sum = 0, mine = rank + time;
    MPI_Sendrecv(&mine, 1, MPI_INT, (rank + 1) % ranks, 0, &there, 1, MPI_INT,
                 (rank + ranks - 1) % ranks, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Allreduce(&mine, &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    return there == (rank + ranks - 1) % ranks + time &&
           sum == ranks * (ranks - 1) / 2 + ranks * time;
}

/* Objects go from rank to rank, and each copy adds 1. */
static void fork_round(duite *rt, const duite_object *a, int time)
{
    const int32_t start = time;
    duite_fork_at(rt, time % ranks, &SET, &start, 1, &a[0]);
    for (int i = 1; i < OBJECTS; i++)
        duite_fork_at(rt, (time + i) % ranks, &COPY, NULL, 2, (duite_object[]){a[i - 1], a[i]});
}

/* Without a wait before it the program's own MPI stands between tasks and messages. A wait at the
 * end of the round is needed then: a rank that has its value and began the next round would send
 * nothing to one that still gets its own. */
static int run(double lost_seconds, int waits)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt;
    duite_object a[OBJECTS];
    int right = 1;
    options.threads = 2;
    options.lost_seconds = lost_seconds;
    if (duite_start(&rt, &options))
        return 0;
    for (int i = 0; i < OBJECTS; i++)
        a[i] = misuse_new(rt, COUNT);
    for (int time = 0; time < TIMES; time++) {
        int32_t values[COUNT] = {0};
        fork_round(rt, a, time);
        right &= (!waits || !duite_wait(rt)) && !duite_mpi_begin(rt);
        right &= own_mpi(time);
        right &= !duite_mpi_end(rt) && !duite_get(rt, a[OBJECTS - 1], values);
        right &= values[0] == time + OBJECTS - 1 && (waits || !duite_wait(rt));
    }
    for (int i = 0; i < OBJECTS; i++)
        duite_free(rt, a[i]);
    return !duite_stop(&rt) && right;
}

/* A fork between begin and end is refused on each rank, also where it touches nothing; and told
 * once more by the wait. */
static int fork_refused(void)
{
    duite *rt = misuse_start(MPI_COMM_WORLD, 1);
    if (!rt)
        return 0;
    const duite_object object = misuse_new(rt, COUNT);
    int right = duite_home(rt, object) >= 0 && !duite_mpi_begin(rt);
    right &= duite_fork(rt, &SET, &(int32_t){1}, 1, &object) == DUITE_E_STATE;
    right &= !duite_mpi_end(rt) && duite_wait(rt) == DUITE_E_STATE && !duite_wait(rt);
    duite_free(rt, object);
    return !duite_stop(&rt) && right;
}

RANKS_CASE(mpi)
{
    misuse_mpi_at(MPI_THREAD_SERIALIZED);
    tap_case(run(8, 1), "when no task is left");
    tap_case(run(8, 0), "while tasks and messages are on their way");
    tap_case(run(2, 1), "between many heartbeats");
    tap_case(fork_refused(), "a fork is refused on each rank");
    return tap_done();
}
