#ifndef DUITE_COMM_FAREWELL_H
#define DUITE_COMM_FAREWELL_H

#include "runtime/data/packet.h"

#include <mpi.h>

/* Once communication is broken on a rank, it sends each other rank one last packet that says why,
 * and nothing after it. Messages between two ranks keep their order, so whoever has the farewells
 * of all others knows that nothing is on its way any more. */
struct comm_farewell {
    uint64_t entered; /* collective calls so far */
    int32_t code;
    char sentence[1012];
};

struct comm_farewells {
    struct data_packet *packet; /* this rank's own */
    MPI_Request *request;       /* n_ranks of them */
    bool said;
    int heard;        /* ranks */
    uint64_t entered; /* the most that was heard of */
};

struct comm;

/* Makes room for a farewell, so that saying it needs no memory. False without memory. */
bool comm_farewells_start(struct comm_farewells *farewells, int n_ranks);
void comm_farewells_stop(struct comm_farewells *farewells);

/* Under the lock: says farewell to all others if communication is broken and it was not said yet.
 */
void comm_farewell_say(struct comm *comm);

/* A farewell came: this rank breaks, too. Under the lock. */
void comm_farewell_hear(struct comm *comm, struct data_packet *packet);

/* Nothing is on its way to or from this rank, nor will be. */
bool comm_is_quiet(struct comm *comm);

#endif
