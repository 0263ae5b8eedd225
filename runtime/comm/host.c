/* Who shares cores with whom is asked once, at start. */
#include "runtime/comm/host.h"

#include "runtime/base/error.h"
#include "runtime/base/memory.h"

struct entry {
    uint64_t hash, threads;
};

static void count(struct comm_host *host, const struct entry *all, int n, int self)
{
    *host = (struct comm_host){0};
    for (int i = 0; i < n; i++) {
        if (all[i].hash != all[self].hash)
            continue;
        host->ranks++;
        host->total += (unsigned)all[i].threads;
        if (i < self)
            host->before += (unsigned)all[i].threads;
    }
}

static int exchange(struct comm_host *host, MPI_Comm local, struct entry own, unsigned n_cores,
                    unsigned *threads)
{
    int n, self;
    if (MPI_Comm_size(local, &n) || MPI_Comm_rank(local, &self))
        return base_error(DUITE_E_MPI, "MPI_Comm_size failed");
    struct entry *all = base_alloc((size_t)n * sizeof *all);
    if (!all)
        return base_no_memory("the ranks of this host");
    int mpi = MPI_Allgather(&own, 2, MPI_UINT64_T, all, 2, MPI_UINT64_T, local);
    count(host, all, n, self);
    if (!*threads)
        *threads = n_cores > host->ranks ? n_cores / host->ranks : 1;
    for (int i = 0; i < n; i++)
        if (!all[i].threads)
            all[i].threads = *threads; /* those who share these cores come to the same number */
    count(host, all, n, self);
    base_free(all);
    return mpi ? base_error(DUITE_E_MPI, "MPI_Allgather failed") : DUITE_OK;
}

int comm_host_find(struct comm_host *host, MPI_Comm mpi, uint64_t hash, unsigned n_cores,
                   unsigned *threads)
{
    MPI_Comm local;
    if (MPI_Comm_split_type(mpi, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local))
        return base_error(DUITE_E_MPI, "MPI_Comm_split_type failed");
    int code = exchange(host, local, (struct entry){hash, *threads}, n_cores, threads);
    MPI_Comm_free(&local);
    return code;
}
