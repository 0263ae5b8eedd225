/* Requests of MPI that bodies hand over: values go round the ranks by the program's own messages,
 * beside those of the runtime, with no more of MPI than SERIALIZED; a request that fails fails its
 * task. Run under mpirun. */
#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TIMES = 60, MOST_RANKS = 16, WIDTH = 3000 };

static MPI_Comm own; /* the program's, whose failures are returned */

/* Sends parameter 0 to the next rank; parameter 1 comes from the one before. */
KERNEL(PASS, "pass", .access = {DUITE_R, DUITE_W}, .args_size = sizeof(int32_t), .events = 1)
{
    const int tag = *(const int32_t *)call->args;
    MPI_Request request[2];
    int code = duite_mpi_begin(call->rt);

    code |= MPI_Irecv(call->param[1].data, WIDTH, MPI_INT32_T, (rank + ranks - 1) % ranks, tag, own,
                      &request[0]);
    code |= MPI_Isend(call->param[0].data, WIDTH, MPI_INT32_T, (rank + 1) % ranks, tag, own,
                      &request[1]);
    code |= duite_mpi_end(call->rt) | duite_await_mpi(call, 2, request);
    return code || request[0] != MPI_REQUEST_NULL || request[1] != MPI_REQUEST_NULL;
}

KERNEL(STEP, "step", .access = {DUITE_R, DUITE_W})
{
    for (size_t i = 0; i < WIDTH; i++)
        duite_out(call, 1, int32_t)[i] = duite_in(call, 0, int32_t)[i] + (int32_t)(i % 7);
    return 0;
}

/* Receives less than was sent. */
KERNEL(CUT, "cut", .access = {DUITE_W}, .events = 1)
{
    static int32_t two[2] = {1, 2};
    MPI_Request request[2];
    int code = duite_mpi_begin(call->rt);

    code |= MPI_Isend(two, 2, MPI_INT32_T, rank, 1, own, &request[0]);
    code |= MPI_Irecv(call->param[0].data, 1, MPI_INT32_T, rank, 1, own, &request[1]);
    return code | duite_mpi_end(call->rt) | duite_await_mpi(call, 2, request);
}

static duite *start(unsigned threads, int check)
{
    static const duite_kernel *const KERNELS[] = {&SET, &COPY, &PASS, &STEP, &CUT, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);

    options.kernels = KERNELS;
    options.threads = threads;
    options.check = check;
    return misuse_start_with(&options);
}

/* Each rank's value goes round, and grows on its way; each second time by the runtime's messages,
 * too. */
static int go_round(unsigned threads, int check)
{
    duite *rt = start(threads, check);
    duite_object a[MOST_RANKS], b[MOST_RANKS];
    static int32_t values[WIDTH];
    int right = rt != NULL && ranks <= MOST_RANKS;

    for (int r = 0; r < ranks && right; r++) {
        a[r] = misuse_new(rt, WIDTH);
        b[r] = misuse_new(rt, WIDTH);
        right &= !duite_fork_at(rt, r, &SET, &(int32_t){100 * r}, 1, &a[r]);
    }
    for (int32_t time = 0; time < TIMES && right; time++)
        for (int r = 0; r < ranks; r++) {
            right &= !duite_fork_at(rt, r, &PASS, &time, 2, (duite_object[]){a[r], b[r]});
            right &= !duite_fork_at(rt, time % 2 ? r : (r + 1) % ranks, &STEP, NULL, 2,
                                    (duite_object[]){b[r], a[r]});
        }
    for (int r = 0; r < ranks && right; r++) {
        const int from = ((r - TIMES) % ranks + ranks) % ranks;

        right &= !duite_get(rt, a[r], values);
        for (int32_t i = 0; i < WIDTH; i++)
            right &= values[i] == 100 * from + TIMES * (i % 7);
    }
    for (int r = 0; r < ranks && rt; r++)
        duite_free(rt, a[r]), duite_free(rt, b[r]);
    return rt && !duite_stop(&rt) && right;
}

/* The last task of a rank ends by a request of MPI alone, while its main thread and its worker
 * sleep: in each round another rank begins late. */
static int comes_late(void)
{
    enum { ROUNDS = 150 };
    const struct timespec late = {.tv_nsec = 4000000}; /* longer than a main thread looks around */
    duite *rt = start(2, 0);
    duite_object a[MOST_RANKS], b[MOST_RANKS];
    int right = rt != NULL && ranks <= MOST_RANKS;

    for (int r = 0; r < ranks && right; r++) {
        a[r] = misuse_new(rt, WIDTH);
        b[r] = misuse_new(rt, WIDTH);
    }
    for (int32_t round = 0; round < ROUNDS && right; round++) {
        if (round % ranks == rank)
            nanosleep(&late, NULL);
        for (int r = 0; r < ranks; r++)
            right &= !duite_fork_at(rt, r, &PASS, &round, 2, (duite_object[]){a[r], b[r]});
        right &= !duite_wait(rt);
    }
    for (int r = 0; r < ranks && rt; r++)
        duite_free(rt, a[r]), duite_free(rt, b[r]);
    return rt && !duite_stop(&rt) && right;
}

static int failed(void)
{
    duite *rt = start(2, 0);
    const duite_object a = misuse_new(rt, 1), b = misuse_new(rt, 1);
    int32_t value = 0;
    int right = !duite_fork(rt, &CUT, NULL, 1, &a) && !DUITE_FORK(rt, &COPY, NULL, a, b);

    right &= duite_get(rt, b, &value) == DUITE_E_MPI;
    right &=
        strstr(duite_message(), "(kernel cut)") && strstr(duite_message(), "request 2 of the 2");
    right &= duite_wait(rt) == DUITE_E_MPI && !duite_wait(rt);
    right &= !duite_fork(rt, &SET, &(int32_t){5}, 1, &a) && !duite_get(rt, a, &value) && value == 5;
    duite_free(rt, a);
    duite_free(rt, b);
    return !duite_stop(&rt) && right;
}

RANKS_CASE(await)
{
    misuse_mpi_at(MPI_THREAD_SERIALIZED);
    MPI_Comm_dup(MPI_COMM_WORLD, &own);
    MPI_Comm_set_errhandler(own, MPI_ERRORS_RETURN);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN); /* MPICH asks it in tests */
    tap_case(go_round(1, 0), "values go round by requests of the program, on one thread");
    tap_case(go_round(3, 0), "on three");
    tap_case(go_round(2, 1), "in checking mode");
    tap_case(comes_late(), "a late request wakes the main thread that waits for it");
    tap_case(failed(), "a request that fails fails its task");
    MPI_Comm_free(&own);
    return tap_done();
}
