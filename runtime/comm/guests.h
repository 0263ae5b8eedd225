#ifndef DUITE_COMM_GUESTS_H
#define DUITE_COMM_GUESTS_H

#include <duite.h>

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Guests: requests of MPI that bodies of the program began and handed over. See guests.c. */

struct comm;
struct worker;

/* The requests of one call. Its maker's until it is added, then the guests' until it is over. */
struct comm_guest {
    struct comm_guest *next;
    duite_event event; /* of the task that waits for them */
    int n;
    int failed;     /* the first of them that failed, from 1 on; 0: none */
    char text[160]; /* MPI's reason */
    MPI_Request *request;
    MPI_Status status[];
};

/* All of them are over, or will be no more: the guest is the callee's. `worker` may be NULL. */
typedef void comm_guest_over(void *context, struct worker *worker, struct comm_guest *guest);

struct comm_guests {
    atomic_flag *lock, own; /* guards MPI: of the communication; on one rank `own` */
    struct comm *comm;      /* NULL: one rank */
    comm_guest_over *over;
    void *context;
    _Atomic(struct comm_guest *) added; /* and not in the list yet */
    struct comm_guest *list;            /* under the lock */
    _Atomic int here;                   /* added and not over */
    _Atomic(const void *) holder;       /* who alone calls MPI; NULL: not said */
};

/* Begins with none; zeroed memory has none, either. Stop: no other thread is left; guests that are
 * still here go. */
void comm_guests_start(struct comm_guests *guests, struct comm *comm, comm_guest_over *over,
                       void *context);
void comm_guests_stop(struct comm_guests *guests);

/* A guest for copies of n requests. NULL without memory. base_free frees it. */
struct comm_guest *comm_guest_new(int n, const MPI_Request *requests);
/* The next poll tests its requests. Any thread. */
void comm_guest_add(struct comm_guests *guests, struct comm_guest *guest);

/* True if there is something to test. Any thread. */
static inline bool comm_guests_are_here(const struct comm_guests *guests)
{
    return atomic_load_explicit(&guests->here, memory_order_relaxed) != 0;
}

/* Tests all, and ends those that are over. Returns whether some are. Any thread. */
bool comm_guests_poll(struct comm_guests *guests, struct worker *worker);

/* Between hold and let_go the caller alone calls MPI: nothing is sent or received. `holder`: who
 * that is, for the question. Any thread. */
void comm_guests_hold(struct comm_guests *guests, const void *holder);
void comm_guests_let_go(struct comm_guests *guests);
static inline bool comm_guests_are_held(const struct comm_guests *guests, const void *holder)
{
    return atomic_load_explicit(&guests->holder, memory_order_relaxed) == holder;
}

#pragma GCC visibility pop

#endif
