#ifndef TESTS_SUPPORT_RANK_H
#define TESTS_SUPPORT_RANK_H

#include <stdlib.h>

/* The rank of this process as Open MPI's or MPICH's mpirun says it, before MPI begins; NULL: there
 * was no mpirun. */
static inline const char *rank_said(void)
{
    const char *rank = getenv("OMPI_COMM_WORLD_RANK");
    return rank ? rank : getenv("PMI_RANK");
}

/* How many ranks it says that there are; NULL as above. */
static inline const char *ranks_said(void)
{
    const char *size = getenv("OMPI_COMM_WORLD_SIZE");
    return size ? size : getenv("PMI_SIZE");
}

#endif
