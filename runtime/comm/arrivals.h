#ifndef DUITE_COMM_ARRIVALS_H
#define DUITE_COMM_ARRIVALS_H

#include "runtime/data/sum.h"

#include <pthread.h>

/* Brings packets that arrive together with whom they are for, whichever comes first. Safe from any
 * thread. */
struct comm_arrivals {
    pthread_mutex_t lock;
    struct comm_arrival
        *table; /* uthash by key: expected and not all there, or there and not expected yet */
};

/* To whom a packet goes: one of the two is set. */
struct comm_target {
    struct data_version *version;
    struct data_sum *sum;
};

void comm_arrivals_start(struct comm_arrivals *arrivals);
void comm_arrivals_stop(struct comm_arrivals *arrivals); /* frees packets that nobody wanted */

/* Notes a target for so many packets; *early gets those that came already, linked by next. False
 * without memory. */
bool comm_arrivals_expect(struct comm_arrivals *arrivals, struct data_key key,
                          struct comm_target target, uint32_t packets, struct data_packet **early);

/* A packet came. True: *target is set, deliver it; false: kept until it is expected. *lost without
 * memory. */
bool comm_arrivals_take(struct comm_arrivals *arrivals, struct data_packet *packet,
                        struct comm_target *target, bool *lost);

#endif
