#ifndef DUITE_COMM_HOST_H
#define DUITE_COMM_HOST_H

#include <mpi.h>
#include <stdint.h>

/* Ranks of one host that share their cores. */
struct comm_host {
    unsigned ranks;  /* this one among them */
    unsigned before; /* workers of the ranks below this one */
    unsigned total;  /* workers of all of them */
};

/* hash: of the cores this rank may use; n_cores: how many; threads: workers this rank wants, or 0
 * for its share, which is written back. Collective over mpi. Errors: DUITE_E_MPI. */
int comm_host_find(struct comm_host *host, MPI_Comm mpi, uint64_t hash, unsigned n_cores,
                   unsigned *threads);

#endif
