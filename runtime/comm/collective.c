/* Collective calls of the main thread. There are two kinds: a small reduction, which finds whether
 * all ranks forked the same; and a gathering of words, which only follows a reduction that let all
 * ranks go on. So even ranks that run different programs are in the same kind of call.
 *
 * A rank leaves an unfinished call when communication breaks. MPI goes on using the buffers, so
 * they belong to the comm. No rank is more than one call ahead of another. At stop, ranks that
 * missed the last call join it, in the kind that the abort message tells. */
#include "runtime/base/error.h"
#include "runtime/comm/internal.h"

/* Under the lock. */
static bool collective_enter(struct comm *comm, enum comm_collective kind)
{
    struct comm_word *own = &comm->words[comm->n_ranks];
    comm->entered++;
    comm->kind = kind;
    if (kind == COMM_GATHERS)
        return COMM_OK(comm, MPI_Iallgather, own, 1, comm->word, comm->words, 1, comm->word,
                       comm->mpi, &comm->request);
    return COMM_OK(comm, MPI_Iallreduce, &comm->own, &comm->max, COMM_REDUCED, MPI_UINT64_T,
                   MPI_MAX, comm->mpi, &comm->request);
}

/* Under the lock: all ranks came to the agreement. True if they have the same: the largest is the
 * smallest. Else rank 0 asks for the difference, and breaks. */
static bool collective_agrees(struct comm *comm)
{
    const struct comm_reduced *max = &comm->max;
    const bool same = max->fingerprint == ~max->not_fingerprint && max->homes == ~max->not_homes;
    comm->words[0].failed = max->failed;
    if (same)
        atomic_store(&comm->calls.agreed, atomic_load(&comm->calls.made));
    else if (!comm->rank)
        comm_difference_found(comm, atomic_load(&comm->calls.made),
                              "ranks forked different tasks, made different objects or other "
                              "calls, or have different homes");
    return same;
}

void comm_enter(struct comm *comm, enum comm_collective kind, const struct comm_word *own)
{
    if (comm_is_broken(comm)) /* MPI may still read these */
        return;
    comm->next = kind;
    comm->enters = true;
    comm->words[comm->n_ranks] = *own;
    const uint64_t homes = kind == COMM_AGREES ? comm->setup.table->homes : 0;
    comm->own = (struct comm_reduced){.fingerprint = own->fingerprint,
                                      .not_fingerprint = ~own->fingerprint,
                                      .homes = homes,
                                      .not_homes = ~homes,
                                      .failed = own->failed != 0};
}

/* Under the lock. */
static bool collective_test(struct comm *comm)
{
    int done = 0;
    if (comm_is_broken(comm))
        return true;
    if (comm->enters && !collective_enter(comm, comm->next))
        return true;
    comm->enters = false;
    if (!COMM_OK(comm, MPI_Test, &comm->request, &done, MPI_STATUS_IGNORE))
        return true;
    return done && (comm->kind != COMM_AGREES || collective_agrees(comm));
}

bool comm_is_entered(void *context)
{
    struct comm *comm = context;
    if (!comm_try_lock(comm))
        return comm_is_broken(comm);
    const bool done = collective_test(comm);
    comm_let_go(comm);
    return done && !comm_left_to_us(comm);
}

const struct comm_word *comm_words(const struct comm *comm)
{
    return comm->words;
}

static bool collective_wait(struct comm *comm)
{
    return COMM_OK(comm, MPI_Wait, &comm->request, MPI_STATUS_IGNORE);
}

void comm_catch_up(struct comm *comm)
{
    bool fine = collective_wait(comm);
    while (fine && comm->entered < comm->control.entered)
        fine = collective_enter(comm, (enum comm_collective)comm->control.kind) &&
               collective_wait(comm);
}
