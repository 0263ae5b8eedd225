#ifndef DUITE_GRAPH_GRAPH_H
#define DUITE_GRAPH_GRAPH_H

#include "runtime/data/object.h"

#include <pthread.h>
#include <stdatomic.h>

/* Tasks and what they wait for, on one rank.
 *
 * The main thread forks: it derives from the accesses, in fork order, which rank runs a task, which
 * versions it reads and makes here, and which of them must be sent or awaited. Workers run what is
 * ready and publish what it wrote. Nothing but versions and sums joins the two sides. */

enum graph_kind {
    GRAPH_BODY,    /* a task of the program */
    GRAPH_COMBINE, /* combines the contributions with an object */
    GRAPH_PIECES,  /* combines this rank's contributions, and turns into the SEND of them */
    GRAPH_SEND,    /* sends a version or pieces to another rank */
    GRAPH_COPY,    /* duite_get: copies a version to the main program */
    GRAPH_VOID,   /* memory ran out while it was forked: does not run, and poisons what it writes */
    GRAPH_REPLAY, /* replays of a recorded graph: begins them; over when the last round is */
    /* Nodes of a replay: */
    GRAPH_NODE,     /* a task of the program */
    GRAPH_NODE_SET, /* duite_set */
    GRAPH_NODE_SUM, /* combines contributions with an object */
    GRAPH_NODE_FLAG /* decides whether there is another round */
};

/* One parameter of a task. */
struct graph_access {
    struct data_waiter waiter; /* waits for `in`, as a reader or as its heir */
    duite_mode mode;
    bool sized;               /* the object's size changes */
    struct data_version *in;  /* what is read or overwritten; NULL: a w without bytes to reuse */
    struct data_version *out; /* what is written */
    struct data_sum *sum;     /* cw: what is contributed to */
    struct data_piece *leaf;  /* cw: this task's part of it */
    size_t bytes;             /* of the object, at most */
};

struct graph_task {
    _Atomic uint32_t pending; /* accesses that wait, and 1 while it is being forked */
    uint32_t n;
    struct graph_task *next; /* a link for whoever holds the task: queues, lists */
    enum graph_kind kind;
    uint32_t kernel; /* index in the list given at start */
    uint64_t number; /* in fork order */
    uint32_t block;  /* for schedulers: of the object that it runs for */
    int32_t priority;
    double cost; /* seconds; 0: not said */
    union {
        void *args;                  /* BODY: its copy of the arguments */
        struct graph_sum *sum;       /* COMBINE, PIECES */
        struct graph_send *send;     /* SEND */
        struct graph_copy *copy;     /* COPY */
        struct graph_replay *replay; /* REPLAY */
        struct graph_node *node;     /* NODE... */
    };
    size_t size;        /* of all of it, in bytes */
    duite_param *param; /* n */
    struct graph_access access[];
};

/* SEND: a version and where it goes. */
struct graph_send {
    struct data_key key;
    int to;
    struct data_packet *packet; /* NULL: the version that the task reads, as it lies */
};

/* COMBINE and PIECES: the contributions to close. */
struct graph_sum {
    struct data_waiter waiter; /* waits for them all */
    struct data_sum *sum;
    struct graph_send send; /* the version they make; PIECES: to the rank that adds */
};

/* COPY: where a value goes. `done` is set last. */
struct graph_copy {
    void *values; /* NULL: nowhere */
    size_t bytes; /* how many there were */
    const struct data_failure *failure;
    _Atomic int done;
};

/* What lies above: handed over at start. `worker` is whoever calls, passed through untouched. */
struct graph_hooks {
    void *context;
    /* A task may run; a SEND may be posted, and ends with graph_finish when its bytes are gone. */
    void (*ready)(void *context, void *worker, struct graph_task *task);
    /* Calls the body of the task with that number, and returns its code. NULL: called directly. */
    int (*body)(void *context, const duite_kernel *kernel, uint64_t number, duite_call *call);
    /* Something the main program may be waiting for happened. */
    void (*notify)(void *context);
    /* The version or the pieces of that key come from elsewhere: call graph_arrived or
     * graph_pieces_arrived with each packet. 0, or DUITE_E_MEMORY. */
    int (*expect)(void *context, void *worker, struct data_key key, struct data_version *version,
                  struct data_sum *sum, uint32_t packets);
};

struct graph {
    int rank, n_ranks;
    struct data_table table;
    const duite_kernel **kernels;
    uint32_t *n_fixed; /* parameters in each kernel's `access` */
    uint32_t n_kernels;
    struct graph_hooks hooks;
    uint64_t forks;       /* so far, on all ranks the same */
    uint64_t fingerprint; /* of the forks since the last wait */
    int broken;           /* memory ran out in the middle of a fork: the code of every later call */
    _Atomic int given_up; /* bodies do not run any more */
    _Atomic uint64_t unfinished;   /* tasks of this rank */
    uint64_t resume;               /* and as few of them let a throttled main program go on */
    uint64_t rename_most;          /* limit of `rename_bytes` */
    _Atomic uint64_t rename_bytes; /* of packets that exist since a w did not wait */
    _Atomic uint64_t renamed;      /* such w */
    pthread_mutex_t lock;          /* failures */
    struct graph_failure *failures;
    const struct data_failure *first_failure; /* in fork order, since the last wait */
};

/* kernels: ended by NULL, checked, the list copied; laws likewise, or NULL, not kept. `hooks` are
 * set by whoever runs the tasks. Errors: DUITE_E_KERNEL, DUITE_E_LAW, memory; graph_stop is due all
 * the same. */
int graph_start(struct graph *graph, int rank, int n_ranks, const duite_kernel *const *kernels,
                const duite_law *const *laws);
/* No task is left. Frees everything, objects that were not freed among it. */
void graph_stop(struct graph *graph);

/* ---- Main thread, collective; the homes of all objects are settled ---- */

/* Makes something that all ranks do alike part of the fingerprint. Forks, sets, frees and copies do
 * so themselves. */
void graph_mix(struct graph *graph, uint64_t value);

enum { GRAPH_ANYWHERE = -1 };

/* What a fork says of how its task runs. Priority and cost are the running rank's; they do not
 * belong to the fingerprint. */
struct graph_how {
    int at; /* a rank, or GRAPH_ANYWHERE */
    int32_t priority;
    double cost; /* seconds; 0: not said */
};

int graph_fork(struct graph *graph, void *worker, const struct graph_how *how,
               const duite_kernel *kernel, const void *args, size_t n, const duite_object *objects);
/* Overwrites with a copy of *count values, or with zeros if they are NULL, without waiting for
 * anything. count NULL: as many as the object has at most. Errors: objects, DUITE_E_SIZE, memory.
 */
int graph_set(struct graph *graph, void *worker, duite_object object, const void *values,
              const size_t *count);
int graph_free(struct graph *graph, void *worker, duite_object object);

/* Starts copying an object to `copy` on rank `to`, or on all ranks with GRAPH_ANYWHERE. The caller
 * waits for copy->done on the ranks it goes to. */
int graph_copy(struct graph *graph, void *worker, duite_object object, int to,
               struct graph_copy *copy);

/* ---- Any worker ---- */

/* What the running body may say of its failure, and what it was refused. */
struct duite_call_private {
    struct graph_task *task; /* NULL in replays */
    int refused;             /* code of a call that failed, or 0: the task fails with it at least */
    char text[sizeof((struct data_failure *)0)->text];
};

/* Runs a ready task (not a SEND), which graph_finish then ends. `call` has context, rank, worker
 * and own set. Returns whether a body ran. */
bool graph_run(struct graph *graph, struct graph_task *task, duite_call *call);

/* What became a SEND when it ran is to be sent now. */
static inline bool graph_to_send(const struct graph_task *task)
{
    return task->kind == GRAPH_SEND;
}

/* The task is over: publishes what it wrote, makes its successors ready, frees it. */
void graph_finish(struct graph *graph, void *worker, struct graph_task *task);

/* A packet came for an expected version or sum; the callee owns it. */
void graph_arrived(struct graph *graph, void *worker, struct data_version *version,
                   struct data_packet *packet);
void graph_pieces_arrived(struct graph *graph, void *worker, struct data_sum *sum,
                          struct data_packet *packet);

/* What was expected will not come: poison in its place. */
void graph_lost(struct graph *graph, void *worker, struct data_version *version);
void graph_pieces_lost(struct graph *graph, void *worker, struct data_sum *sum);

/* The bytes of a ready SEND, under its key: the version itself, or send->packet, which the caller
 * frees once it is sent. NULL without memory. */
struct data_packet *graph_send_packet(struct graph_task *send);

/* Sets the sentence of a failure; returns its code. */
int graph_failure_error(const struct graph *graph, const struct data_failure *failure);

#endif
