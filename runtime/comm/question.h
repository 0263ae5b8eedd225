#ifndef DUITE_COMM_QUESTION_H
#define DUITE_COMM_QUESTION_H

#include "runtime/data/packet.h"

#include <mpi.h>
#include <stdatomic.h>

/* Ranks that make different calls are told so, even where one waits for data that no other one will
 * ever send. Every rank logs its blocking calls: number, name, and the fingerprint of all that it
 * forked before. A rank that waits long in one asks all others whether their call of that number
 * was the same; one that finds it was not breaks. Nothing is sent as long as nobody waits long. */

/* So many calls are logged; then all ranks agree that they were the same, and a new log begins. */
enum { COMM_LOGGED_CALLS = 1024 };

struct comm_called {
    uint64_t number, fingerprint; /* number: from 1 on */
    uint64_t homes;               /* data_table.homes */
    char name[48];
};

struct comm_calls {
    /* Written by the main thread; `made` last. */
    _Atomic uint64_t made, agreed;
    _Atomic uint64_t waits; /* number of the call that it waits in, or 0 */
    struct comm_called *log;
    /* Under the lock: */
    uint64_t seen, asked; /* of those it waited in, the last that was seen, and asked about */
    double since;         /* when it was seen */
    struct comm_called *pending; /* by rank: what was asked before this rank came to it; number 0:
                                    nothing */
    struct data_packet *packet;
    MPI_Request *request; /* n_ranks */
    uint64_t questions;   /* that this rank asked, each of all others */
    uint64_t heard;       /* from others */
    uint64_t to_hear;     /* from others, by what they said when all agreed last */
};

struct comm;

/* False without memory. */
bool comm_calls_start(struct comm_calls *calls, int n_ranks);
void comm_calls_stop(struct comm_calls *calls);

/* Under the lock: asks what there is to ask, and looks at what was asked. */
void comm_question_ask(struct comm *comm);

/* Breaks, since the mapping is not the same on two ranks. */
void comm_homes_differ(struct comm *comm, int a, int b);

/* Under the lock: a question came. */
void comm_question_hear(struct comm *comm, struct data_packet *packet);

/* Under the lock: all ranks agreed on all calls so far. */
void comm_calls_agreed(struct comm *comm);

/* Under the lock: what this rank asked is sent. */
bool comm_questions_sent(struct comm *comm);

/* The same, and what others had asked when all agreed last came. No other thread is left. */
bool comm_questions_over(struct comm *comm);

#endif
