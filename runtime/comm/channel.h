#ifndef DUITE_COMM_CHANNEL_H
#define DUITE_COMM_CHANNEL_H

#include "runtime/comm/requests.h"
#include "runtime/task/task.h"

/* Channels: the messages of recorded graphs (plan_channel). Each has two buffers and, if it
 * receives, a receive posted for each of them, so that a message finds its place when it comes a
 * round early. Their tags are theirs alone. Used by this folder only. */

struct comm;
struct comm_group; /* the channels of one plan */

struct comm_channels {
    _Atomic(struct task *) ready;     /* nodes to be run, linked by next */
    struct comm_requests awaited;     /* under the lock: receives whose nodes are ready */
    struct task *stalled;             /* under the lock: nodes whose buffers are still sent */
    struct comm_group *open, *closed; /* under the lock; closed: some messages are still sent */
    size_t room;                      /* of `awaited`: receives of the open ones */
    unsigned looks;
    int next_tag, last_tag;
    _Atomic bool awaits; /* there are some */
    bool lost;           /* nothing comes any more */
};

/* Whether MPI says how many tags there are. Under no lock yet. */
bool comm_channels_start(struct comm *comm);
/* Under the lock, at the end: false if MPI may still read or write memory, which then stays. */
bool comm_channels_stop(struct comm *comm);

/* Posts a node that is ready; the caller sees to it that somebody comes by. Any thread. */
void comm_channel_post(struct comm *comm, struct task *node);

/* Under the lock: sends and receives what can be; the nodes that are through are linked before
 * `over`, which is returned. */
struct task *comm_channels_pass(struct comm *comm, struct task *over);

/* Under the lock: communication is broken, and nothing is awaited any more. */
void comm_channels_give_up(struct comm *comm);

/* Shows messages that have not come, and those that cannot be sent yet. Under the lock. */
struct comm_looker;
void comm_channels_look(struct comm *comm, const struct comm_looker *looker);

#endif
