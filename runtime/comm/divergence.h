#ifndef DUITE_COMM_DIVERGENCE_H
#define DUITE_COMM_DIVERGENCE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* The divergence check: ranks that make different calls are told so, even where one waits for data
 * that no other one will ever send.
 *
 * Every rank logs its blocking calls: number, name, and the fingerprint of all that it forked
 * before. A rank that waits long in a call sends its entry of the log along a binomial tree over
 * all ranks, in which rank r has the parent r & (r - 1). Each rank passes on the first entry of a
 * number that it sees, whether it made that call yet or not, and compares it with its own and with
 * all further ones of that number. So a call costs a rank at most one message for each of its
 * neighbours in the tree, at most log2 of the number of ranks; and since the tree joins all ranks,
 * any difference is seen somewhere. Nothing is sent as long as nobody waits long. */

/* So many calls are logged; then all ranks agree that they were the same, and a new log begins. */
enum { COMM_LOGGED_CALLS = 1024 };

/* A blocking call of a rank. */
struct comm_called {
    uint64_t number, fingerprint; /* number: from 1 on */
    uint64_t homes;               /* data_table.homes */
    int32_t rank;                 /* which made it */
    char name[36];
};
_Static_assert(sizeof(struct comm_called) == 64, "an entry takes one cache line");

struct comm_calls {
    /* Written by the main thread; `made` last. */
    _Atomic uint64_t made, agreed;
    _Atomic uint64_t waits;  /* number of the call that it waits in, or 0 */
    struct comm_called *log; /* of this rank */
    /* Under the lock: */
    struct comm_called *seen; /* the first entries that checks showed; by number */
    uint64_t last_seen;       /* the largest number of them */
    uint64_t compared;        /* own calls up to this one were compared with them */
    uint64_t waited;          /* of the calls that it waited in, the last that was looked at ... */
    double since;             /* ... and when first */
};

struct comm;

/* False without memory. */
bool comm_calls_start(struct comm_calls *calls);
void comm_calls_stop(struct comm_calls *calls);

/* Whether two ranks are neighbours in the tree. */
bool comm_check_joins(int a, int b);

/* Under the lock: compares what this rank called meanwhile, and begins a check when one is due. */
void comm_check_pass(struct comm *comm);

/* Under the lock: a neighbour sent, or passed on, an entry. */
void comm_check_hear(struct comm *comm, int from, const struct comm_called *theirs);

/* Under the lock: all ranks agreed on all calls so far. */
void comm_calls_agreed(struct comm *comm);

/* Breaks, since the mapping is not the same on two ranks. */
void comm_homes_differ(struct comm *comm, int a, int b);

#endif
