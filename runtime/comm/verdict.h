#ifndef DUITE_COMM_VERDICT_H
#define DUITE_COMM_VERDICT_H

#include "runtime/comm/history.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rank 0's conclusion from the histories of all ranks: the sentence that names their first
 * difference. For this folder only. */

/* Rank 0's knowledge of a rank. */
struct difference_rank {
    bool answered, has_homes;
    bool compared; /* some of its calls, with the reference */
    bool older;    /* the first of these differs already */
    uint64_t homes;
    uint64_t last;              /* its last call */
    uint64_t at;                /* its first call that differs from the reference's, or 0 */
    uint64_t fingerprint, call; /* of this call ... */
    uint64_t other_fingerprint, other_call; /* ... and of the reference's */
};

struct difference_inquiry {
    struct comm_history_copy reference;
    int answers;
    struct difference_rank rank[];
};

/* A sentence under construction, cut off where it no longer fits. */
struct comm_verdict {
    size_t length;
    char text[900];
};

/* Writes the best sentence there is into an empty verdict. It is comm->difference.message without
 * an inquiry, or if the histories do not tell. Under the lock. */
struct comm;
void comm_verdict_find(const struct comm *comm, struct comm_verdict *verdict);

#endif
