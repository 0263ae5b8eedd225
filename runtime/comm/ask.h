#ifndef DUITE_COMM_ASK_H
#define DUITE_COMM_ASK_H

#include "runtime/data/packet.h"

#include <mpi.h>
#include <stdatomic.h>

/* Questions for tasks, of ranks that have none. A question stands at the rank that is asked until
 * it is answered by a task or its time is over; a newer one of the same rank takes its place. They
 * are no movement of the program, and nobody waits for them: at stop each rank says that it was its
 * last. All under the lock but `open`. */
struct comm_standing {
    double until; /* 0: none */
    unsigned idle;
};

struct comm_asks {
    _Atomic int open;               /* there may be some */
    struct comm_standing *standing; /* by rank */
    struct data_packet *packet;     /* a header to each rank, ... */
    MPI_Request *request;           /* ... and its way */
    int turn;                       /* who is answered next */
    int last;                       /* ranks that will not ask any more */
    _Atomic uint64_t sent;
    double latency, per_byte; /* seconds: of the slowest link measured */
};

struct comm;

/* False without memory. */
bool comm_asks_start(struct comm_asks *asks, int n_ranks);
void comm_asks_stop(struct comm_asks *asks);

/* A question, or the last word, came. */
void comm_ask_hear(struct comm *comm, const struct data_packet *packet);

/* Workers have ended: says the last word to all others. */
void comm_asks_end(struct comm *comm);

/* What this rank asked is sent; and all last words were heard. */
bool comm_asks_sent(struct comm *comm);
bool comm_asks_over(struct comm *comm);

#endif
