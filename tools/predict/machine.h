#ifndef DUITE_TOOLS_PREDICT_MACHINE_H
#define DUITE_TOOLS_PREDICT_MACHINE_H

#include "tools/predict/graph.h"
#include "tools/predict/network.h"

/* The machine in virtual time: its queues and its events. The files machine.c, simulate.c and
 * predict.c share it. One thread. */

/* Ready tasks of a worker, or that a host shares: a ring, or a heap if they are served by priority.
 */
struct predict_queue {
    uint32_t *node;
    size_t first, n, capacity; /* a power of two */
    bool heap;
};

/* False without memory. */
bool predict_queue_put(struct predict_queue *queue, const struct predict_node *nodes,
                       uint32_t node);
/* NONE: it is empty. */
uint32_t predict_queue_take(struct predict_queue *queue, const struct predict_node *nodes,
                            duite_end end);

/* In place of a worker. */
#define PREDICT_COMES (PREDICT_NONE - 1)
#define PREDICT_LEFT  (PREDICT_NONE - 2)
#define PREDICT_GOES  (PREDICT_NONE - 3)
#define PREDICT_FLOW  (PREDICT_NONE - 4)

/* At a time a node is over, on a worker or (NONE) on none; or a message GOES on its way, or has
 * LEFT its host, which may overwrite the values; or it COMES to the other one; or the first message
 * of a FLOW, whose number is in place of a node, is through. Events of one time come in the order
 * in which they were put. */
struct predict_event {
    double time;
    uint64_t order;
    uint32_t node, worker;
};
struct predict_events {
    struct predict_event *event;
    size_t n, capacity;
    uint64_t order;
};
bool predict_event_put(struct predict_events *events, double time, uint32_t node, uint32_t worker);
bool predict_event_take(struct predict_events *events, struct predict_event *event);

enum { IDLE, BUSY, RESERVED }; /* of a worker; the last: it is the main program's */

/* The cause for a node to be ready, or to begin: another node was over. That node made this one
 * ready, or left it its worker, or let the main program go on, which then forked it. */
struct predict_cause {
    uint32_t by; /* NONE: the beginning */
    enum { MADE_READY, LEFT_WORKER, FORKED } kind;
    float flight; /* s of a message */
};

struct predict_machine {
    struct predict_graph *graph;
    const struct predict_cluster *cluster;
    const struct predict_place *host;
    const duite_scheduler *scheduler;
    uint32_t n_workers;
    uint32_t *first;   /* by host: its first worker; behind the last host all */
    uint32_t *host_of; /* by worker */
    void *memory;      /* of all arrays but events and those of queues */
    unsigned char *states;
    size_t stride;
    duite_near *near; /* by worker: all of a host are equally near */
    unsigned *other, *level;
    struct predict_queue *queue, *shared; /* by worker; by host */
    unsigned char *state;                 /* by worker */
    uint32_t *next;                       /* by worker: to be run inline, or NONE */
    uint32_t *ran;                        /* by worker: the node it ran last */
    uint32_t *affinity; /* by object: the worker of its last replayed task, or NONE */
    uint32_t *last;     /* by host: the worker that ended last */
    uint32_t *idle;     /* by host: how many */
    uint32_t *waiting;  /* by host: tasks in its queues */
    struct predict_events events;
    struct predict_network network;
    double *looked;              /* by worker: when it looked for messages */
    double *handler;             /* by host: until when it handles messages, one after the other */
    double *handled;             /* by host: s that messages take of its cores from now on */
    double *begin, *end;         /* by node */
    double *path;                /* by node: s of the longest chain of nodes before it */
    double longest;              /* s of such a chain, its last node included */
    uint32_t *runs_on;           /* by node, for Paje; NULL: not kept */
    struct predict_cause *cause; /* by node */
    double now, main_time, busy;
    size_t op, cursor; /* of the main program */
    uint64_t over, stolen;
    bool blocked, wanted, failed;
    uint32_t latest;  /* the node that was over last */
    uint32_t went_on; /* ... when the main program went on last; NONE: it never waited */
};

/* Makes the machine before its first event. `paje`: it keeps the worker of each node. False without
 * memory; predict_machine_stop is due all the same. */
bool predict_machine_start(struct predict_machine *machine, bool paje);
void predict_machine_stop(struct predict_machine *machine);

static inline void *predict_worker_state(const struct predict_machine *machine, uint32_t worker)
{
    return machine->states + worker * machine->stride;
}

/* The task as schedulers see it. */
duite_ready predict_describe(const struct predict_machine *machine, uint32_t node);

/* Sums up a run that is over. */
void predict_conclude(struct predict_machine *machine, struct predict_result *result,
                      double *kernels);
int predict_write_paje(const struct predict_machine *machine, FILE *file);

#endif
