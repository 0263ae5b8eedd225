/* Collective calls of the main thread. There are three kinds: a small reduction, which finds
 * whether all ranks forked the same; a gathering of words; a search for the first failure's word.
 * The last two only follow a reduction that let all ranks go on. So even ranks that run different
 * programs are in the same kind of call.
 *
 * A rank leaves an unfinished call when communication breaks. MPI goes on using the buffers, so
 * they belong to the comm. No rank is more than one call ahead of another. At stop, ranks that
 * missed the last call join it, in the kind that the abort message tells. */
#include "runtime/base/error.h"
#include "runtime/comm/internal.h"

#include <string.h>

/* ---- Words ---- */

/* Keeps the word whose failure is first in fork order; between equal ones, the lower rank's. */
static void word_first(void *from, void *to, int *n, MPI_Datatype *type)
{
    const struct comm_word *one = from;
    struct comm_word *other = to;
    (void)type;
    for (int i = 0; i < *n; i++) {
        const bool same = one[i].failed == other[i].failed;
        if (one[i].failed && (!other[i].failed || one[i].failed < other[i].failed ||
                              (same && one[i].failure.rank < other[i].failure.rank)))
            other[i] = one[i];
    }
}

int comm_collective_start(struct comm *comm)
{
    const int code = comm_bytes_type(sizeof(struct comm_word), &comm->word);
    return code ? code : COMM_MPI(MPI_Op_create, word_first, 1, &comm->first);
}

void comm_collective_stop(struct comm *comm)
{
    if (comm->word != MPI_DATATYPE_NULL)
        MPI_Type_free(&comm->word);
    if (comm->first != MPI_OP_NULL)
        MPI_Op_free(&comm->first);
}

/* ---- Entering and waiting ---- */

/* Under the lock. */
static bool collective_enter(struct comm *comm, enum comm_collective kind)
{
    struct comm_word *own = &comm->words[comm->n_ranks];
    int mpi;
    comm->entered++;
    comm->kind = kind;
    if (kind == COMM_GATHERS)
        mpi = MPI_Iallgather(own, 1, comm->word, comm->words, 1, comm->word, comm->mpi,
                             &comm->request);
    else if (kind == COMM_FIRSTS)
        mpi =
            MPI_Iallreduce(own, comm->words, 1, comm->word, comm->first, comm->mpi, &comm->request);
    else
        mpi = MPI_Iallreduce(&comm->own, &comm->max, COMM_REDUCED, MPI_UINT64_T, MPI_MAX, comm->mpi,
                             &comm->request);
    return comm_mpi_ok(comm, mpi, kind == COMM_GATHERS ? "MPI_Iallgather" : "MPI_Iallreduce");
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
