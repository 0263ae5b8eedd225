#ifndef DUITE_COMM_COMM_H
#define DUITE_COMM_COMM_H

#include "runtime/graph/graph.h"

#include <mpi.h>

/* Messages between ranks. A message is a packet, named by its key; it is sent as soon as its bytes
 * are there and may arrive before this rank has forked the task that wants it. Whoever polls does
 * what there is to do; nobody waits inside.
 *
 * MPI is called by one thread at a time, the one that holds `lock`; packets are delivered after it
 * is let go. */
struct comm;

/* On a duplicate of mpi. Collective. Errors: DUITE_E_MPI, memory. */
int comm_start(struct comm **comm, MPI_Comm mpi, struct graph *graph);

/* From now on messages are sent and received. Before, the lock keeps workers out of MPI, so that
 * the main thread may call it while it starts. NULL is fine. */
void comm_open(struct comm *comm);

/* Frees everything; all ranks have agreed (comm_agree) that nothing is on its way. Collective. */
void comm_stop(struct comm *comm);

/* Posts the version of a ready SEND, which is finished once it is sent, or a packet, which is freed
 * then. The next poll sends them; comm_posted: there is something to send. Any thread. */
void comm_send(struct comm *comm, struct graph_task *task);
void comm_send_packet(struct comm *comm, struct data_packet *packet, int to);
bool comm_posted(struct comm *comm);

/* The packets of that key belong to a version, or to a sum; those that came already are delivered.
 * Main thread. */
int comm_expect(struct comm *comm, void *worker, struct data_key key, struct data_version *version,
                struct data_sum *sum, uint32_t packets);

/* Sends, receives, delivers and finishes what can be. Returns whether anything happened. Any
 * thread. */
bool comm_poll(struct comm *comm, void *worker);

/* What the ranks tell one another when they wait for all: each its own, `all` one a rank. */
struct comm_word {
    uint64_t forks, fingerprint,
        failed; /* failed: number + 1 of this rank's first failed task in fork order, or 0 */
    struct data_failure failure;
};

/* Exchanges words. Calls between(context) while it waits, so that others get on. Collective, main
 * thread. */
int comm_agree(struct comm *comm, const struct comm_word *own, struct comm_word *all,
               void (*between)(void *context), void *context);

/* Sums n doubles over all ranks, in place. As comm_agree. */
int comm_sum(struct comm *comm, double *values, int n, void (*between)(void *context),
             void *context);

/* DUITE_E_MPI or DUITE_E_MEMORY with the sentence set once a message was lost, else 0. */
int comm_broken(struct comm *comm);

/* Messages and bytes sent by this rank so far. */
void comm_count(struct comm *comm, uint64_t *messages, uint64_t *bytes);

#endif
