#ifndef DUITE_PLAN_CHANNEL_H
#define DUITE_PLAN_CHANNEL_H

#include <stdbool.h>
#include <stddef.h>

/* Channels: what a plan says to the communication about its messages. The plan owns them. */

struct task;

/* A recorded graph's message of one round to or from another rank: fixed in size and order, so that
 * it needs no name but its tag and its turn. */
struct plan_channel {
    struct task *node; /* SEND or RECEIVE */
    int peer;
    int tag; /* to begin with the phase; who opens the channels adds a number of their own */
    bool sends;
    size_t bytes; /* room for a message; without failures to tell it is shorter */
    void *own;    /* of who opens */
};

/* All of one plan, with messages of so many phases on all ranks. Closed by whoever lets go of the
 * plan last, from any thread. */
struct plan_channels {
    struct plan_channel *channel;
    size_t n;
    int phases;
    void (*close)(struct plan_channels *channels); /* set when they are opened */
    void *own;
};

/* A SEND writes its message, which has so many bytes; a RECEIVE reads it, or poisons all that it
 * would have brought. Afterwards the node is to be finished. Any worker. */
size_t plan_channel_pack(struct task *node, void *message);
void plan_channel_unpack(struct task *node, const void *message);
void plan_channel_lost(struct task *node);
/* Of a SEND or RECEIVE. */
struct plan_channel *plan_channel_of(const struct task *node);
/* One of the program's tasks that wait in this round for a RECEIVE, or NULL, and how many more do.
 * The replay must not go on meanwhile. */
const struct task *plan_channel_waits(const struct task *node, unsigned *more);

#endif
