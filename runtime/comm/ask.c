/* A question is a header without a payload; one to a rank is under way at a time. */
#include "runtime/comm/ask.h"

#include "runtime/base/clock.h"
#include "runtime/base/memory.h"
#include "runtime/comm/internal.h"

#include <math.h>

bool comm_asks_start(struct comm_asks *asks, int n_ranks)
{
    size_t n = (size_t)n_ranks;
    asks->standing = base_alloc_zero(n * sizeof *asks->standing);
    asks->packet = base_alloc_zero(n * sizeof *asks->packet);
    asks->request = base_alloc(n * sizeof *asks->request);
    for (size_t i = 0; i < n && asks->request; i++)
        asks->request[i] = MPI_REQUEST_NULL;
    return asks->standing && asks->packet && asks->request;
}

void comm_asks_stop(struct comm_asks *asks)
{
    base_free(asks->standing);
    base_free(asks->packet);
    base_free(asks->request);
}

/* The header to this rank, or NULL: the one before has not gone yet. */
static struct data_packet *header(struct comm *comm, int rank)
{
    struct comm_asks *asks = &comm->asks;
    int sent = 1;
    if (!comm_mpi_ok(comm, MPI_Test(&asks->request[rank], &sent, MPI_STATUS_IGNORE), "MPI_Test") ||
        !sent)
        return NULL;
    asks->packet[rank] = (struct data_packet){.key.slot = (uint32_t)comm->rank};
    return &asks->packet[rank];
}

static void send(struct comm *comm, int rank)
{
    struct comm_asks *asks = &comm->asks;
    atomic_fetch_add_explicit(&asks->sent, 1, memory_order_relaxed);
    comm_mpi_ok(
        comm,
        MPI_Isend(&asks->packet[rank], 1, comm->line, rank, 0, comm->mpi, &asks->request[rank]),
        "MPI_Isend");
}

bool comm_ask(struct comm *comm, int rank, unsigned idle, double seconds)
{
    if (comm_is_broken(comm) || !comm_try_lock(comm))
        return false;
    struct data_packet *packet = header(comm, rank);
    if (packet) {
        packet->kind = DATA_ASK;
        packet->pieces = idle;
        packet->key.number = (uint64_t)(1e9 * seconds);
        send(comm, rank);
    }
    comm_unlock(
        comm); /* what was posted meanwhile is sent by the next poll, which is the caller's */
    return packet != NULL;
}

void comm_ask_hear(struct comm *comm, const struct data_packet *packet)
{
    struct comm_asks *asks = &comm->asks;
    if (packet->kind == DATA_LAST) {
        asks->last++;
        return;
    }
    asks->standing[packet->key.slot] = (struct comm_standing){
        .until = base_seconds() + 1e-9 * (double)packet->key.number, .idle = packet->pieces};
    atomic_store_explicit(&asks->open, 1, memory_order_relaxed);
}

bool comm_is_asked(struct comm *comm)
{
    return atomic_load_explicit(&comm->asks.open, memory_order_relaxed);
}

bool comm_asked(struct comm *comm, struct comm_asker *asker)
{
    struct comm_asks *asks = &comm->asks;
    double now = base_seconds();
    bool found = false;
    if (!comm_try_lock(comm))
        return false;
    for (int i = 0; i < comm->n_ranks && !found; i++) {
        int rank = asks->turn = (asks->turn + 1) % comm->n_ranks;
        struct comm_standing *standing = &asks->standing[rank];
        found = standing->until > now;
        if (found)
            *asker = (struct comm_asker){rank, standing->idle, standing->until};
        standing->until = 0;
    }
    if (!found)
        atomic_store_explicit(&asks->open, 0, memory_order_relaxed);
    comm_unlock(comm);
    return found;
}

void comm_asks_again(struct comm *comm, const struct comm_asker *asker)
{
    struct comm_standing *standing = &comm->asks.standing[asker->rank];
    if (!comm_try_lock(comm))
        return; /* it will ask again */
    if (standing->until < asker->until)
        *standing = (struct comm_standing){asker->until, asker->idle};
    atomic_store_explicit(&comm->asks.open, 1, memory_order_relaxed);
    comm_unlock(comm);
}

/* ---- The end ---- */

void comm_asks_end(struct comm *comm)
{
    struct comm_asks *asks = &comm->asks;
    for (int rank = 0; rank < comm->n_ranks && !comm_is_broken(comm); rank++) {
        if (rank == comm->rank ||
            !comm_mpi_ok(comm, MPI_Wait(&asks->request[rank], MPI_STATUS_IGNORE), "MPI_Wait"))
            continue;
        struct data_packet *packet = header(comm, rank);
        if (!packet)
            return;
        packet->kind = DATA_LAST;
        send(comm, rank);
    }
}

bool comm_asks_sent(struct comm *comm)
{
    int sent = 1;
    if (comm->asks.sent)
        MPI_Testall(comm->n_ranks, comm->asks.request, &sent, MPI_STATUSES_IGNORE);
    return sent;
}

bool comm_asks_over(struct comm *comm)
{
    return comm->asks.last == comm->n_ranks - 1 && !comm->receives.n && comm_asks_sent(comm);
}

/* ---- What a link costs ---- */

#define LEAST_PER_BYTE 1e-12 /* s: what else goes on may hide it, but no way is free */

enum { SMALL_LINES = 1, LARGE_LINES = 1024, ROUNDS = 12 };

/* The fastest there and back, halved. */
static int ping(struct comm *comm, int other, void *bytes, int lines, double *seconds)
{
    bool first = comm->rank < other;
    *seconds = 1e9;
    for (int i = 0; i < ROUNDS; i++) {
        double begin = base_seconds();
        int mpi = MPI_SUCCESS;
        if (first)
            mpi = MPI_Send(bytes, lines, comm->line, other, 0, comm->mpi);
        if (!mpi)
            mpi = MPI_Recv(bytes, lines, comm->line, other, 0, comm->mpi, MPI_STATUS_IGNORE);
        if (!mpi && !first)
            mpi = MPI_Send(bytes, lines, comm->line, other, 0, comm->mpi);
        if (mpi)
            return mpi;
        double way = (base_seconds() - begin) / 2;
        *seconds = first && i && way < *seconds ? way : *seconds;
    }
    return MPI_SUCCESS;
}

/* The partner is half of all ranks away, so on another host if there are several. */
void comm_measure(struct comm *comm)
{
    unsigned char bytes[LARGE_LINES * 64] = {0};
    int half = comm->n_ranks / 2, other = comm->rank < half ? comm->rank + half : comm->rank - half;
    double own[2] = {0, 0}, all[2], small = 0, large = 0;
    int mpi = MPI_SUCCESS;
    if (other < 2 * half && comm->rank < 2 * half) {
        mpi = ping(comm, other, bytes, SMALL_LINES, &small);
        if (!mpi)
            mpi = ping(comm, other, bytes, LARGE_LINES, &large);
        own[0] = comm->rank < half ? small : 0;
        own[1] = comm->rank < half ? fmax((large - small) / sizeof bytes, LEAST_PER_BYTE) : 0;
    }
    if (!mpi)
        mpi = MPI_Allreduce(own, all, 2, MPI_DOUBLE, MPI_MAX, comm->mpi);
    if (!comm_mpi_ok(comm, mpi, "measuring the link"))
        return;
    comm->asks.latency = all[0];
    comm->asks.per_byte = all[1];
}

double comm_transfer(const struct comm *comm, size_t bytes)
{
    return 2 * comm->asks.latency + comm->asks.per_byte * (double)bytes;
}
