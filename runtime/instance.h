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
    struct comm *comm;   /* NULL: one rank */
    struct check *check; /* NULL: not in checking mode */
    struct work_pool *pool;
    const duite_mapping *mapping;
    uint64_t seed;
    unsigned threads;
    int oversubscribed;
    int remembered;      /* code of a failed fork, new, ... */
    char sentence[1024]; /* of `remembered` */
};

/* True once nothing but stop is left: memory ran out in a fork, the ranks differ, a message was
 * lost. */
bool instance_is_broken(const duite *rt);

/* It is broken: tells the other ranks, awaits nothing any more, and returns when no task is left.
 * Does nothing the second time. */
void instance_give_up(duite *rt);

#endif
