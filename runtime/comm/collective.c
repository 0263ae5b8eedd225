/* Collective calls of the main thread, all of one kind: words are gathered. A rank leaves a call
 * before it is over when communication broke; MPI goes on using the buffers, which therefore are
 * the comm's own, and at stop the ranks that did not come to it join it after all. */
#include "runtime/base/error.h"
#include "runtime/comm/internal.h"

#include <string.h>

/* Under the lock. */
static bool enter(struct comm *comm)
{
    struct comm_word *own = &comm->words[comm->n_ranks];
    comm->entered++;
    int mpi = MPI_Iallgather(own, sizeof *own, MPI_BYTE, comm->words, sizeof *own, MPI_BYTE,
                             comm->mpi, &comm->request);
    return comm_mpi_ok(comm, mpi, "MPI_Iallgather");
}

/* Gathers the words; runs `between` until they are there. The lock is held, and let go. */
static int gather(struct comm *comm, void (*between)(void *), void *context)
{
    int done = 0;
    bool fine = enter(comm);
    comm_unlock(comm);
    while (fine && !done && !comm_is_broken(comm)) {
        if (comm_try_lock(comm)) {
            fine =
                comm_mpi_ok(comm, MPI_Test(&comm->request, &done, MPI_STATUS_IGNORE), "MPI_Test");
            comm_unlock(comm);
        }
        if (!done || comm_left_to_us(comm))
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
    *all = comm->words;
    if (!lock(comm, between, context))
        return comm_broken(comm);
    comm->words[comm->n_ranks] = *own;
    return gather(comm, between, context);
}

int comm_sum(struct comm *comm, double *values, int n, void (*between)(void *context),
             void *context)
{
    if (!lock(comm, between, context))
        return comm_broken(comm);
    memcpy(&comm->words[comm->n_ranks], values, (size_t)n * sizeof *values);
    int code = gather(comm, between, context);
    if (code)
        return code;
    memset(values, 0, (size_t)n * sizeof *values);
    for (int rank = 0; rank < comm->n_ranks; rank++) {
        double part[COMM_MOST_SUMS];
        memcpy(part, &comm->words[rank], (size_t)n * sizeof *part);
        for (int i = 0; i < n; i++)
            values[i] += part[i];
    }
    return DUITE_OK;
}

void comm_catch_up(struct comm *comm)
{
    MPI_Wait(&comm->request, MPI_STATUS_IGNORE);
    while (comm->entered < comm->farewells.entered && enter(comm))
        MPI_Wait(&comm->request, MPI_STATUS_IGNORE);
}
