#ifndef DUITE_COMM_MESSAGE_H
#define DUITE_COMM_MESSAGE_H

#include "runtime/data/packet.h"

#include <stdbool.h>
#include <stddef.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Messages between ranks, for those who send and expect them. A message is a packet: bytes and a
 * key. It is sent as soon as its bytes are there and may arrive before its receiver expects it. Its
 * sender or receiver is called when it is sent or came. comm.h has the rest. */
struct comm;
struct worker; /* the caller, for those who are called back; NULL: no worker */

/* A letter or a channel that is posted. The comm's, from then until it is over. */
struct comm_post {
    struct comm_post *next;
    bool is_channel;
};

/* A packet on its way to a rank, from comm_send until it is sent. The sender keeps it. */
struct comm_letter {
    struct comm_post post; /* first */
    struct data_key key;
    struct data_packet *packet; /* freed once it is sent; NULL: the sender's, see comm_owner */
    void *sender;
    int to;
};

/* Called when a packet came for `what`, which expected it; the callee owns the packet. NULL: it
 * will not come. `context`: of the comm. */
typedef void comm_arrived(void *context, struct worker *worker, void *what,
                          struct data_packet *packet);

/* The receiver of a packet, and the rank it comes from (-1: several). */
struct comm_target {
    comm_arrived *arrived;
    void *what;
    int from;
    bool result; /* of a task there: until it comes, no time counts as awaiting messages */
};

/* ---- Channels ---- */

/* Channels: messages that come again and again, of a fixed size and in a fixed order. The layer
 * above owns them; a plan has one for each message of its rounds. */

/* A message of each round to or from another rank. Size and order are fixed, so tag and turn
 * identify it. */
struct comm_channel {
    struct comm_post post; /* first */
    void *node;            /* the owner's: what sends it or waits for it */
    int peer;
    int tag; /* first the phase; opening the channels adds a number */
    bool sends;
    size_t bytes; /* the most that a message may have */
    void *own;    /* the comm's */
};

/* Channels that are opened and closed together. `phases` counts those of all ranks. The owner calls
 * close on any thread, when none of them is under way. */
struct comm_channel_set {
    struct comm_channel *channel;
    size_t n;
    int phases;
    /* Set on opening. drop: the main program gave up the owner, which may run on. */
    void (*close)(struct comm_channel_set *set);
    void (*drop)(struct comm_channel_set *set);
    void *own;
};

/* Not an error: opening found no tags left; all ranks must first meet without any task. */
enum { COMM_NEEDS_TAGS = 1 };

/* ---- Calls ---- */

/* Posts a letter, which the next poll sends. comm_has_posts: whether there is something to send, a
 * letter or a channel's message. Any thread. */
void comm_send(struct comm *comm, struct comm_letter *letter);
bool comm_has_posts(struct comm *comm);

/* Sets the target of the packets of that key; those that came already are delivered. Any thread.
 * Errors: memory, also if nothing comes any more. */
int comm_expect(struct comm *comm, struct worker *worker, struct data_key key,
                struct comm_target target, uint32_t packets);

/* Opens channels. Main thread, all ranks alike. Errors: DUITE_E_MPI, memory; or COMM_NEEDS_TAGS on
 * all ranks: then the ranks meet, call comm_channels_settle, meet again, call comm_channels_met,
 * and try once more. */
int comm_channels_open(struct comm *comm, struct comm_channel_set *set);

/* A channel is ready for its next message: sends it right now, or awaits it. Any thread. */
void comm_channel_ready(struct comm *comm, struct worker *worker, struct comm_channel *channel);

/* Breaks; the first reason counts. Any thread. */
void comm_break(struct comm *comm, int code, const char *message);
/* The same, for want of memory for `what`. */
void comm_break_memory(struct comm *comm, const char *what);

#pragma GCC visibility pop

#endif
