/* Collective calls of the main thread, all of one kind: words are gathered. A rank leaves a call
 * before it is over when communication broke; MPI goes on using the buffers, which therefore are
 * the comm's own, and at stop the ranks that did not come to it join it after all. */
#include "runtime/base/error.h"
#include "runtime/comm/internal.h"

#include <stdio.h>

/* Under the lock. */
static bool enter(struct comm *comm)
{
    struct comm_word *own = &comm->words[comm->n_ranks];
    comm->entered++;
    int mpi = MPI_Iallgather(own, sizeof *own, MPI_BYTE, comm->words, sizeof *own, MPI_BYTE,
                             comm->mpi, &comm->request);
    return comm_mpi_ok(comm, mpi, "MPI_Iallgather");
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

static void tell_difference(struct comm *comm, int rank)
{
    const struct comm_word *words = comm->words;
    char sentence[200];
    snprintf(
        sentence, sizeof sentence,
        "ranks 0 and %d forked different tasks, or made different objects, since the last wait "
        "(%llu and %llu tasks since start)",
        rank, (unsigned long long)words[0].forks, (unsigned long long)words[rank].forks);
    comm_broke(comm, DUITE_E_DIFFERENT, sentence);
}

/* Under the lock, all words are there: did all ranks fork the same? */
static void settle(struct comm *comm)
{
    const struct comm_word *words = comm->words;
    for (int i = 0; i < comm->n_ranks; i++) {
        if (words[i].fingerprint != words[0].fingerprint)
            tell_difference(comm, i);
        else if (words[i].homes != words[0].homes)
            comm_homes_differ(comm, 0, i);
    }
    comm_calls_agreed(comm);
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
            if (fine && done)
                settle(comm);
            comm_unlock(comm);
        }
        if (!done || comm_left_to_us(comm))
            between(context);
    }
    return comm_broken(comm);
}

static void put_word(struct comm *comm, const struct comm_word *own)
{
    struct comm_word *word = &comm->words[comm->n_ranks];
    *word = *own;
    word->homes = comm->graph->table.homes;
}

int comm_agree(struct comm *comm, const struct comm_word *own, struct comm_word **all,
               void (*between)(void *context), void *context)
{
    *all = comm->words;
    if (!lock(comm, between, context))
        return comm_broken(comm);
    put_word(comm, own);
    return gather(comm, between, context);
}

int comm_sum(struct comm *comm, struct comm_word *word, int n, void (*between)(void *context),
             void *context)
{
    if (!lock(comm, between, context))
        return comm_broken(comm);
    put_word(comm, word);
    int code = gather(comm, between, context);
    if (code)
        return code;
    for (int i = 0; i < n; i++)
        word->sums[i] = 0;
    for (int rank = 0; rank < comm->n_ranks; rank++)
        for (int i = 0; i < n; i++)
            word->sums[i] += comm->words[rank].sums[i];
    return DUITE_OK;
}

void comm_catch_up(struct comm *comm)
{
    MPI_Wait(&comm->request, MPI_STATUS_IGNORE);
    while (comm->entered < comm->control.entered && enter(comm))
        MPI_Wait(&comm->request, MPI_STATUS_IGNORE);
}
