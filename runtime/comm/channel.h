#ifndef DUITE_COMM_CHANNEL_H
#define DUITE_COMM_CHANNEL_H

#include <stdbool.h>
#include <stddef.h>

/* Channels: messages that come again and again, of a fixed size and in a fixed order. The layer
 * above owns them; a plan has one for each message of its rounds. */

/* A message of each round to or from another rank. Size and order are fixed, so tag and turn
 * identify it. */
struct comm_channel {
    struct comm_channel *next; /* the comm's, from comm_channel_ready until it is through */
    void *node;                /* the owner's: what sends it or waits for it */
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

#endif
