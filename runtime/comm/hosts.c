/* The machine, explored at start: which ranks share cores, and the cost of a message between ranks
 * far apart. No function here needs memory: a rank without any would leave the others waiting. */
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/comm/internal.h"

#include <math.h>

/* ---- Ranks that share cores ---- */

int comm_host_find(struct comm_host *host, MPI_Comm mpi, uint64_t hash)
{
    MPI_Comm local;
    int n;
    if (COMM_MPI(MPI_Comm_split_type, mpi, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local))
        return DUITE_E_MPI;
    const int failed =
        COMM_MPI(MPI_Comm_split, local, (int)(hash & 0x7fffffff), 0, &host->sharers) ||
        COMM_MPI(MPI_Comm_size, host->sharers, &n);
    if (COMM_MPI(MPI_Comm_free, &local) || failed)
        return DUITE_E_MPI;
    host->ranks = (unsigned)n;
    return DUITE_OK;
}

int comm_host_count(struct comm_host *host, unsigned threads)
{
    unsigned up_to_here = 0;
    const int failed =
        COMM_MPI(MPI_Scan, &threads, &up_to_here, 1, MPI_UNSIGNED, MPI_SUM, host->sharers) ||
        COMM_MPI(MPI_Allreduce, &threads, &host->total, 1, MPI_UNSIGNED, MPI_SUM, host->sharers);
    host->before = up_to_here - threads;
    return COMM_MPI(MPI_Comm_free, &host->sharers) || failed ? DUITE_E_MPI : DUITE_OK;
}

/* ---- The cost of a message ---- */

#define LEAST_PER_BYTE 1e-12 /* s: other load may hide it, but no way is free */

enum { SMALL_LINES = 1, LARGE_LINES = 1024, ROUNDS = 12 };

/* The fastest there and back, halved. */
static int link_ping(struct comm *comm, int other, void *bytes, int lines, double *seconds)
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
        mpi = link_ping(comm, other, bytes, SMALL_LINES, &small);
        if (!mpi)
            mpi = link_ping(comm, other, bytes, LARGE_LINES, &large);
        own[0] = comm->rank < half ? small : 0;
        own[1] = comm->rank < half ? fmax((large - small) / sizeof bytes, LEAST_PER_BYTE) : 0;
    }
    if (!mpi)
        mpi = MPI_Allreduce(own, all, 2, MPI_DOUBLE, MPI_MAX, comm->mpi);
    if (!comm_mpi_ok(comm, mpi, "measuring the link"))
        return;
    comm->latency = all[0];
    comm->per_byte = all[1];
}

double comm_transfer(const struct comm *comm, size_t bytes)
{
    return 2 * comm->latency + comm->per_byte * (double)bytes;
}
