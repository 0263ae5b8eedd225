/* Who shares cores with whom is asked once, at start. Nothing here needs memory: a rank that had
 * none would leave the others waiting. */
#include "runtime/comm/host.h"

#include "runtime/base/error.h"

/* The ranks that share this one's cores. */
static int exchange(struct comm_host *host, MPI_Comm sharers, unsigned n_cores, unsigned *threads)
{
    int n, self;
    if (MPI_Comm_size(sharers, &n) || MPI_Comm_rank(sharers, &self))
        return base_error(DUITE_E_MPI, "MPI_Comm_size failed");
    *host = (struct comm_host){.ranks = (unsigned)n};
    if (!*threads)
        *threads = n_cores > host->ranks ? n_cores / host->ranks : 1;
    if (MPI_Exscan(threads, &host->before, 1, MPI_UNSIGNED, MPI_SUM, sharers) ||
        MPI_Allreduce(threads, &host->total, 1, MPI_UNSIGNED, MPI_SUM, sharers))
        return base_error(DUITE_E_MPI, "MPI_Allreduce failed");
    if (!self)
        host->before = 0; /* MPI_Exscan leaves it undefined there */
    return DUITE_OK;
}

int comm_host_find(struct comm_host *host, MPI_Comm mpi, uint64_t hash, unsigned n_cores,
                   unsigned *threads)
{
    MPI_Comm local, sharers;
    if (MPI_Comm_split_type(mpi, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local))
        return base_error(DUITE_E_MPI, "MPI_Comm_split_type failed");
    int code = DUITE_OK;
    if (MPI_Comm_split(local, (int)(hash & 0x7fffffff), 0, &sharers))
        code = base_error(DUITE_E_MPI, "MPI_Comm_split failed");
    MPI_Comm_free(&local);
    if (code)
        return code;
    code = exchange(host, sharers, n_cores, threads);
    MPI_Comm_free(&sharers);
    return code;
}
