/* Collective calls of the main thread. MPI reads and writes their buffers until they are over, so
 * the buffers are the comm's own and stay if a call is left because communication broke. */
#include "runtime/base/error.h"
#include "runtime/comm/internal.h"

#include <string.h>

/* Runs `between` until the request is done. */
static int finish(struct comm *comm, int mpi, void (*between)(void *), void *context)
{
    int done = 0;
    bool fine = comm_mpi_ok(comm, mpi, "a collective call");
    comm->entered++;
    comm_unlock(comm);
    while (fine && !done && !comm_is_broken(comm)) {
        if (comm_try_lock(comm)) {
            fine =
                comm_mpi_ok(comm, MPI_Test(&comm->request, &done, MPI_STATUS_IGNORE), "MPI_Test");
            comm_unlock(comm);
        }
        if (!done)
            between(context);
    }
    return comm_broken(comm);
}

/* Takes the lock, or false if communication broke meanwhile. */
static bool lock(struct comm *comm, void (*between)(void *), void *context)
{
    while (!comm_try_lock(comm))
        between(context);
    if (!comm_is_broken(comm))
        return true;
    comm_unlock(comm);
    return false;
}

int comm_agree(struct comm *comm, const struct comm_word *own, struct comm_word **all,
               void (*between)(void *context), void *context)
{
    struct comm_word *sent = &comm->words[comm->n_ranks];
    *all = comm->words;
    if (!lock(comm, between, context))
        return comm_broken(comm);
    *sent = *own;
    int mpi = MPI_Iallgather(sent, sizeof *sent, MPI_BYTE, comm->words, sizeof *sent, MPI_BYTE,
                             comm->mpi, &comm->request);
    return finish(comm, mpi, between, context);
}

int comm_sum(struct comm *comm, double *values, int n, void (*between)(void *context),
             void *context)
{
    if (!lock(comm, between, context))
        return comm_broken(comm);
    memcpy(comm->sums, values, (size_t)n * sizeof *values);
    int mpi =
        MPI_Iallreduce(MPI_IN_PLACE, comm->sums, n, MPI_DOUBLE, MPI_SUM, comm->mpi, &comm->request);
    int code = finish(comm, mpi, between, context);
    if (!code)
        memcpy(values, comm->sums, (size_t)n * sizeof *values);
    return code;
}
