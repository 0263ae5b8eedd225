#ifndef DUITE_PLAN_CHANNEL_H
#define DUITE_PLAN_CHANNEL_H

#include <stdbool.h>
#include <stddef.h>

/* Channels: what the communication knows of a plan's messages. The plan owns them. */

struct task;

/* A message of each round to or from another rank. Size and order are fixed, so tag and turn name
 * it. */
struct plan_channel {
    struct task *node; /* SEND or RECEIVE */
    int peer;
    int tag; /* at first the phase; whoever opens the channels adds a number of its own */
    bool sends;
    size_t bytes; /* room for a message; one without failures is shorter */
    void *own;    /* of who opens */
};

/* All channels of one plan, with messages of so many phases on all ranks. Whoever drops the plan
 * last closes them, from any thread. */
struct plan_channels {
    struct plan_channel *channel;
    size_t n;
    int phases;
    /* Set when they are opened; drop: the main program has the plan no more, which may run still.
     */
    void (*close)(struct plan_channels *channels);
    void (*drop)(struct plan_channels *channels);
    void *own;
};

/* No error, from who opens channels: there are no tags for their messages before all ranks have
 * met, without any task. */
enum { PLAN_NEEDS_TAGS = 1 };

/* A SEND writes its message; returns its bytes. A RECEIVE reads its message, or (lost) poisons what
 * the message would have brought. Afterwards the caller finishes the node. Any worker. */
size_t plan_channel_pack(struct task *node, void *message);
void plan_channel_unpack(struct task *node, const void *message);
void plan_channel_lost(struct task *node);
/* The channel of a SEND or RECEIVE. */
struct plan_channel *plan_channel_of(const struct task *node);
/* Of the program's tasks that wait in this round for a RECEIVE: one, or NULL, and the number of
 * others. The replay must not go on meanwhile. */
const struct task *plan_channel_waits(const struct task *node, unsigned *more);

#endif
