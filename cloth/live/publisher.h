#ifndef CLOTH_LIVE_PUBLISHER_H
#define CLOTH_LIVE_PUBLISHER_H

#include "cloth/live/live.h"
#include "cloth/live/socket.h"

#include <pthread.h>

/* Shared by publish.c, for the run, and serve.c, for the thread. */

enum { LIVE_VIEWERS = 64, LIVE_ID = 255, LIVE_ADDRESS = 300 };

/* A message on its way from the run to the thread; of no bytes: there is none. */
struct live_newest {
    zmq_msg_t message;
    uint64_t number; /* of the scene, from 1, or frame, from 0 */
};

/* A viewer that asked, and the scene and frames that it has. */
struct live_viewer {
    unsigned char id[LIVE_ID]; /* ZeroMQ's name of the connection */
    size_t n_id;               /* 0: no viewer */
    bool delimited;            /* its messages begin with an empty part, as those of REQ sockets */
    bool waits;                /* for another scene, or a frame from `next` on */
    uint64_t scene;            /* of this run that it has; 0: none */
    uint64_t next;             /* the first frame that was not sent to it */
    double seen;               /* s: when it asked last, or was answered */
};

/* The number of connections, as ZeroMQ reports it. */
struct live_door {
    int n, most;
    bool is_shut, warned;
    double opens; /* s: when it is shut */
};

struct live_publisher {
    struct live_socket link;
    int wake; /* an eventfd; the run writes to it when there is something new; -1: none */
    char address[LIVE_ADDRESS];
    void (*warn)(const char *text);
    uint64_t run;
    pthread_t thread;
    bool has_thread;
    /* the run's */
    uint64_t scenes; /* so far */
    const struct contact_bodies *bodies;
    bool *posed; /* of each of them */
    uint32_t n_bodies, n_vertices, n_body_vertices;
    double begin;
    phys_vec *place;      /* room for the vertices of the largest body that changes its shape */
    pthread_mutex_t lock; /* of what follows */
    struct live_newest scene, frame;
    bool ends;
    /* the thread's */
    zmq_msg_t scene_message, frame_message;
    bool is_sealed;                /* the frame's message has its header */
    uint64_t scene_number, frames; /* the scene's number; the newest frame's number + 1 */
    struct live_viewer viewer[LIVE_VIEWERS];
    bool warned_version, warned_bytes;
    struct live_door door;
};

/* The events that the monitor tells of. */
enum {
    LIVE_CONNECTIONS =
        ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_ACCEPT_FAILED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_CLOSED
};
/* How many may be open at once. */
int live_connections_most(void);
/* The thread looks at each event, and while the door is shut. */
void live_connections_look(struct live_publisher *publisher, double now);

/* The thread. context: the publisher. */
void *live_serve(void *context);

#endif
