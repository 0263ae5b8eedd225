#ifndef DUITE_COMM_CONTROL_H
#define DUITE_COMM_CONTROL_H

#include "runtime/comm/requests.h"
#include "runtime/data/packet.h"

#include <stdatomic.h>
#include <stdint.h>

/* Control messages: what the ranks tell one another beside values and tasks. Each is a packet of a
 * kind of this folder's own and travels like a value, so that messages between two ranks keep their
 * order. All of them share one set of MPI requests.
 *
 * Everything here is under the lock of the comm unless it says otherwise. */
enum comm_kind {
    COMM_ABORT = 64, /* communication is broken on the sender: struct comm_abort */
    COMM_CHECK,      /* a blocking call of some rank: struct comm_called */
    COMM_REQUEST,    /* a rank without work requests tasks: the header says how many */
    COMM_LAST        /* the sender stops: after this only an abort message may follow */
};

/* The abort message. A rank on which communication is broken sends it once to each other rank and
 * nothing after it. So whoever has the abort messages of all others knows that nothing is on its
 * way any more. */
struct comm_abort {
    uint64_t entered; /* collective calls so far */
    int32_t code;
    int32_t kind; /* of the last of them: enum comm_collective */
    char message[1008];
};

/* A request for tasks stands at the rank that got it until a task is granted or its time is over; a
 * newer one of the same rank takes its place. Nobody waits for a grant, and requests are no
 * movement of the program. */
struct comm_standing {
    double until; /* 0: none */
    unsigned idle;
};

struct comm_control {
    struct comm_requests sends; /* under way; what: the packet, freed then, or NULL: one of these */
    struct data_packet *abort, *last;
    struct data_packet *spare; /* for a control message that comes when there is no memory */
    bool aborts;               /* the abort messages are sent */
    int heard;                 /* abort messages */
    uint64_t entered;          /* the most collective calls that an abort message told of */
    int32_t kind;              /* of the last of these */
    int last_heard;
    struct comm_standing *standing; /* by rank */
    int turn;                       /* whose request is looked at next */
    _Atomic int standing_any;       /* there may be some; any thread */
    _Atomic uint64_t requested;     /* requests sent; any thread */
};

struct comm;

/* Makes room, so that abort messages and last ones need no memory. False without memory. */
bool comm_control_start(struct comm_control *control, int n_ranks);
void comm_control_stop(struct comm_control *control);

/* Sends the packet, which is the control's from now on. False: it is freed, and communication is
 * broken. */
bool comm_control_send(struct comm *comm, int to, struct data_packet *packet);

/* A packet came. True: it was a control message, which is done with; the packet stays the caller's.
 */
bool comm_control_hear(struct comm *comm, struct data_packet *packet);

/* What is due: the divergence check, and the abort messages if communication is broken. */
void comm_control_pass(struct comm *comm);

/* Tells those who may still send control messages that this rank stops. No other thread is left,
 * no lock is needed. */
void comm_control_end(struct comm *comm);

/* No control message is on its way to or from this rank, nor will be; communication is whole. */
bool comm_control_over(struct comm *comm);

/* Takes the lock. Broken: nothing at all is on its way to or from this rank, nor will be. */
bool comm_is_quiet(struct comm *comm);

#endif
