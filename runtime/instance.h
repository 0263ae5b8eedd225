#ifndef DUITE_INSTANCE_H
#define DUITE_INSTANCE_H

#include "runtime/comm/comm.h"
#include "runtime/graph/graph.h"
#include "runtime/workers/workers.h"

/* A running runtime: the parts, and the errors that the next get, wait or stop still has to tell.
 * Main thread only. */
struct duite {
    MPI_Comm mpi;
    struct graph graph;
    struct comm *comm; /* NULL: one rank */
    struct work_pool *pool;
    const duite_mapping *mapping;
    uint64_t seed;
    unsigned threads;
    int oversubscribed;
    struct comm_word *words; /* one a rank */
    int remembered;          /* code of a failed fork, new, ... */
    char sentence[1024];     /* of `remembered` */
};

#endif
