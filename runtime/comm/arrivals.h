#ifndef DUITE_COMM_ARRIVALS_H
#define DUITE_COMM_ARRIVALS_H

#include "runtime/comm/comm.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

/* The time in which messages were awaited. `clock` is one word, so it can be read without a lock.
 * While none is awaited it holds the ticks so far, with bit 0 clear. Otherwise it holds these minus
 * the moment at which waiting began, with bit 0 set. Written under the lock of its owner. */
struct comm_gauge {
    uint64_t awaited; /* messages */
    _Atomic uint64_t clock;
};

/* Matches packets that arrive with their targets, whichever comes first. Safe from any thread. */
struct comm_arrivals {
    pthread_mutex_t lock;
    bool closed;
    struct comm_gauge gauge; /* of the packets that are expected and not there */
    struct comm_arrival
        *table; /* uthash by key: expected and not all there, or there and not expected yet */
};

void comm_arrivals_start(struct comm_arrivals *arrivals);
void comm_arrivals_stop(struct comm_arrivals *arrivals); /* frees packets never wanted */

/* Notes a target for so many packets; *early gets those that came already, linked by next. False
 * without memory. */
bool comm_arrivals_expect(struct comm_arrivals *arrivals, struct data_key key,
                          struct comm_target target, uint32_t packets, struct data_packet **early);

enum comm_take {
    COMM_WANTED, /* *target is set: deliver it */
    COMM_KEPT,   /* until it is expected */
    COMM_LOST    /* it is wanted nowhere, or there is no memory: the caller frees it */
};

/* A packet came. */
enum comm_take comm_arrivals_take(struct comm_arrivals *arrivals, struct data_packet *packet,
                                  struct comm_target *target);

/* Adds messages that are awaited elsewhere to the gauge; negative: takes them off. */
void comm_arrivals_also(struct comm_arrivals *arrivals, int messages);

/* Calls back with everything awaited and its number of packets. No awaited packet is handed out
 * during the call. */
void comm_arrivals_look(struct comm_arrivals *arrivals,
                        void (*awaited)(void *context, const struct data_key *key,
                                        const struct comm_target *target, uint32_t packets),
                        void *context);

/* After the first call no packet is expected, and those that come are lost. Each call takes one
 * waiting target, once for every packet that it wants; false: there are no more. */
bool comm_arrivals_close(struct comm_arrivals *arrivals, struct comm_target *target);

#endif
