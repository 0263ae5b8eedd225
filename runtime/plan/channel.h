#ifndef DUITE_PLAN_CHANNEL_H
#define DUITE_PLAN_CHANNEL_H

#include <stdbool.h>
#include <stddef.h>

/* Channels: a plan's messages as the communication sees them. The plan owns them. */

struct task;

/* A message of each round to or from another rank. Size and order are fixed, so tag and turn
 * identify it. */
struct plan_channel {
    struct task *node; /* SEND or RECEIVE */
    int peer;
    int tag; /* first the phase; opening the channels adds a number */
    bool sends;
    size_t bytes; /* room for a message with failures */
    void *own;    /* of the communication */
};

/* All channels of one plan. `phases` counts those of all ranks. The last release of the plan closes
 * the channels, on any thread. */
struct plan_channels {
    struct plan_channel *channel;
    size_t n;
    int phases;
    /* Set on opening. drop: the main program gave up its plan, which may run on. */
    void (*close)(struct plan_channels *channels);
    void (*drop)(struct plan_channels *channels);
    void *own;
};

/* Not an error: opening found no tags left; all ranks must first meet without any task. */
enum { PLAN_NEEDS_TAGS = 1 };

/* A SEND writes its message and returns its bytes. A RECEIVE reads its message, or (lost) poisons
 * its places. Afterwards the caller finishes the node. Any worker. */
size_t plan_channel_pack(struct task *node, void *message);
void plan_channel_unpack(struct task *node, const void *message);
void plan_channel_lost(struct task *node);
/* The channel of a SEND or RECEIVE. */
struct plan_channel *plan_channel_of(const struct task *node);
/* One of the program's tasks that wait in this round for a RECEIVE, or NULL; more: the number of
 * others. The replay must not go on meanwhile. */
const struct task *plan_channel_waits(const struct task *node, unsigned *more);

#endif
