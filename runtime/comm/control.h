#ifndef DUITE_COMM_CONTROL_H
#define DUITE_COMM_CONTROL_H

#include "runtime/comm/comm.h"

/* Messages between ranks beside values and tasks, for this folder only: control messages, the
 * divergence check, and the search for the first difference. Everything here is under the lock of
 * the comm unless it says otherwise. */

/* ---- Control messages (control.c) ---- */

/* Kinds of control messages. Each is a packet and travels like a value, so that messages between
 * two ranks keep their order. */
enum comm_kind {
    COMM_ABORT = 64, /* communication is broken on the sender: struct comm_abort */
    COMM_LOSS,    /* a rank is lost, which was found after the sender's abort message: the same */
    COMM_CHECK,   /* a blocking call of some rank: struct comm_called */
    COMM_DIFFERS, /* to rank 0: the sender found that ranks differ */
    COMM_INQUIRY, /* of rank 0: the history of the receiver */
    COMM_ANSWER,  /* to rank 0: this history */
    COMM_REQUEST, /* a rank without work requests tasks: the header says how many */
    COMM_LAST     /* the sender stops: after this only the first two may follow */
};

/* The abort message. A rank on which communication is broken sends it once to each other rank and
 * nothing after it. So a rank that has the abort messages of all others knows that nothing more is
 * on its way. Only the news that a rank is lost may follow: that rank would never send its own. */
struct comm_abort {
    uint64_t entered; /* collective calls so far */
    int32_t code;
    int32_t kind; /* of the last of them: enum comm_collective */
    char message[1008];
};

struct comm_control {
    struct data_packet *abort, *loss, *last;
    struct data_packet *spare; /* for a control message that comes when there is no memory */
    bool aborts, loss_sent;    /* the abort messages are sent; and those of a loss */
    int heard;                 /* abort messages */
    uint64_t entered;          /* the most collective calls that an abort message told of */
    int32_t kind;              /* of the last of these */
    int last_heard;
    struct comm_requester *standing; /* by rank; a newer request replaces an older one */
    int turn;                        /* the rank whose request was looked at last */
    _Atomic int standing_any;        /* there may be some; any thread */
    _Atomic uint64_t requested;      /* requests sent; any thread */
};

/* Takes memory ahead, so that abort messages and last messages need none later. False without
 * memory. */
bool comm_control_start(struct comm *comm);
void comm_control_stop(struct comm_control *control);

/* Sends the packet, which is the control's from now on. False: it is freed, and communication is
 * broken. */
bool comm_control_send(struct comm *comm, int to, struct data_packet *packet);

/* Sends a control message of so many bytes. False without memory. */
bool comm_control_tell(struct comm *comm, int to, enum comm_kind kind, const void *what,
                       size_t bytes);

/* A packet came. True: it was a control message, which is done with; the packet stays the caller's.
 */
bool comm_control_hear(struct comm *comm, struct data_packet *packet);

/* Does what is due (comm_control_is_due): the divergence check, and the abort messages if
 * communication is broken. */
void comm_control_pass(struct comm *comm);

/* Tells the ranks that may still send control messages that this rank stops. Takes the lock, since
 * heartbeats go on. */
void comm_control_end(struct comm *comm);

/* True if no message is on its way to or from this rank, nor will be: all sent their last message
 * or, if communication broke, their abort message; or nothing can be awaited, as a rank is lost.
 * Takes the lock. */
bool comm_control_over(struct comm *comm);

/* ---- The divergence check (divergence.c) ---- */

/* The divergence check finds ranks that make different calls, even where one waits for data that no
 * other rank will ever send.
 *
 * Every rank logs its blocking calls: number, name, and the fingerprint of its forks before. A rank
 * that waits long in a call sends the call's entry along a binomial tree over all ranks; the parent
 * of rank r is r & (r - 1). Each rank passes on the first entry of a number that it sees, even
 * before it makes that call. It compares that entry with its own and with all later ones of the
 * number. So a call costs a rank at most one message for each neighbour in the tree, at most log2
 * of the number of ranks. Since the tree joins all ranks, any difference is seen somewhere. The
 * check sends no messages while no rank waits long. */

/* After so many logged calls all ranks agree that they were the same, and a new log begins. */
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
    uint64_t waited; /* the last of the calls that this rank waited in and that was looked at ... */
    double since;    /* ... and when first */
};

/* False without memory. */
bool comm_calls_start(struct comm_calls *calls);

/* True if two ranks are neighbours in the tree. */
bool comm_check_joins(int a, int b);

/* Under the lock: compares this rank's new calls, and begins a check when one is due. */
void comm_check_pass(struct comm *comm);

/* Under the lock: takes an entry of this rank itself, or one that a neighbour sent or passed on. */
void comm_check_see(struct comm *comm, int from, const struct comm_called *call);

/* Under the lock: this rank's call of that number, or NULL: it is not in the log. */
const struct comm_called *comm_calls_logged(struct comm_calls *calls, uint64_t number);

/* ---- The first difference between ranks (difference.c) ---- */

struct comm_difference {
    bool found;      /* that ranks differ; the rest is about this */
    uint64_t number; /* of the blocking call where it was found */
    double until;    /* then communication breaks with `message`; 0: no longer, or not yet */
    char message[300];
    struct difference_inquiry *inquiry; /* rank 0's */
};

/* Under the lock: ranks were found to differ at the blocking call of that number. Communication
 * breaks soon, with the same sentence on all ranks: it names the first difference, or is `message`
 * if that stays unknown. */
void comm_difference_found(struct comm *comm, uint64_t number, const char *message);

/* Under the lock: a control message about it came. */
void comm_difference_hear(struct comm *comm, struct data_packet *packet);

/* Under the lock: breaks if the time is over. */
void comm_difference_pass(struct comm *comm);

/* ---- Rank 0's conclusion from the histories of all ranks (verdict.c) ---- */

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
void comm_verdict_find(const struct comm *comm, struct comm_verdict *verdict);

#endif
