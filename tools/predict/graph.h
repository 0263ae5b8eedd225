#ifndef DUITE_TOOLS_PREDICT_GRAPH_H
#define DUITE_TOOLS_PREDICT_GRAPH_H

#include "tools/predict/predict.h"

#include <duite.h>

/* The run as a graph: nodes in an order in which no edge points back, and the main program's steps.
 * Plain data of one thread; its owner frees it by predict_graph_free. */

#define PREDICT_NONE UINT32_MAX

enum predict_kind {
    PREDICT_TASK,       /* runs on a worker of its host */
    PREDICT_EVERYWHERE, /* on several hosts at once, with the time of a worker, but on none of them
                         */
    PREDICT_MESSAGE,    /* from `host` to `block`; number: bytes */
    PREDICT_EXCHANGE,   /* number bytes from their holders to the hosts that need them */
    PREDICT_INSTANT     /* takes no time */
};

struct predict_node {
    uint64_t number;
    uint32_t kernel; /* of kernels; beyond them: the runtime's own, by task_type */
    uint32_t host, block;
    int32_t priority; /* of messages: packets that it adds */
    float seconds;
    uint32_t hops; /* of exchanges: messages one after the other */
    union {
        struct {
            float cost, path;
        };
        uint64_t copies; /* of exchanges: of the bytes that each sends, in all */
    };
    uint32_t pending; /* edges that end here, and 1 for the main program */
    uint32_t edge;    /* the first of those that begin here, or NONE */
    /* Tasks of the program in a replay: 1 + the object that places it; 0: none. Exchanges: the
     * copies that go through the busiest card. */
    uint32_t placed;
    enum predict_kind kind;
};

struct predict_edge {
    uint32_t to, next;
};

/* A step of the main program: it forks the nodes up to `end`, `each` seconds apart. Then it waits
 * for `node`, or for all nodes so far (NONE), or not at all. */
struct predict_op {
    uint32_t end, node;
    bool waits;
    double each;
};

struct predict_object {
    int home;   /* a host */
    int holder; /* the host that has the value; PREDICT_ALL: all */
    uint32_t block;
    uint32_t writer;                  /* node, or NONE */
    uint32_t readers, copies, leaves; /* lists in `link` */
    uint64_t bytes;
    uint32_t leader; /* that it follows, or NONE */
    uint32_t hints;  /* list in `hint` */
    uint32_t place;  /* in the record that is replayed, plus 1, while its round is compiled */
    bool shown;      /* counted in `shown` of its writer */
    bool written;    /* a task has */
    bool lasts;      /* its value is of before the trace, and no task of the trace writes it */
};

enum { PREDICT_ALL = -1 }; /* holder */

struct predict_link {
    uint32_t node, host, next;
};

/* Bytes that a block sends to another one, which the object leads. */
struct predict_hint {
    uint32_t object, next;
    double bytes;
};

/* A replay's round gives this for the value, or the sum, that comes next. */
struct predict_travel {
    const uint64_t *need; /* the hosts that read it; NULL: outside of rounds, all */
    const uint64_t *runs; /* of a sum: the hosts that make it */
    uint32_t phase;       /* it moves in */
    /* If a sum goes from host to host: n_hops in so many rounds, the first one in a phase. */
    const struct predict_hop *hop;
    size_t n_hops;
    uint32_t rounds, sum_phase;
};

/* In a round of a sum's way one host sends another n subtrees. */
struct predict_hop {
    uint32_t round, from, to, n;
};

struct predict_graph {
    const struct trace_run *run;
    const struct predict_cluster *cluster;
    struct predict_node *node;
    size_t n_nodes, nodes_capacity;
    float *shown; /* plain: by node, bytes that it writes and tasks of other blocks read */
    size_t shown_capacity;
    struct predict_edge *edge;
    size_t n_edges, edges_capacity;
    struct predict_op *op;
    size_t n_ops, ops_capacity;
    struct predict_object *object;
    size_t n_objects, objects_capacity;
    struct predict_link *link;
    size_t n_links, links_capacity;
    struct predict_hint *hint;
    size_t n_hints, hints_capacity;
    uint64_t *packet; /* of this round: phase, from, to of each, plus 1; a power of two */
    size_t n_packets, packets_capacity;
    uint32_t *piece; /* by host: this rank's part of a sum that is being closed */
    uint32_t *began; /* by host: the node that begins or ends a replay there */
    uint32_t *count; /* by host: zeros, but for a moment */
    double own[64];  /* by task_type: s of the runtime's own tasks, those of sums left out */
    double merges;   /* that the sums of the trace took */
    uint64_t *among; /* a set of hosts, for a moment */
    int *ring;       /* hosts, for a moment */
    uint32_t *phase; /* by host: that its pieces of a sum move in */
    struct predict_travel travel;
    uint32_t round;         /* the first node of this round of a replay, or NONE */
    uint32_t flag;          /* the node that decided on this round, or NONE */
    double overhead;        /* s between two tasks, */
    double message;         /* of a core, to send or to take one, */
    double look;            /* and to look for one, which workers do now and then; 0: no messages */
    double bodies, medians; /* s, as predict_result has them */
    uint64_t n_tasks, migrated;
    bool plain;           /* only tasks and what they read: no edges of other kinds, no gates */
    bool replays, failed; /* failed: no memory */
    bool linked;          /* the node that is being made has an edge from its own round */
};

/* A node that waits for nothing yet. 0 without memory (and graph->failed). */
uint32_t predict_add(struct predict_graph *graph, const struct predict_node *node);
/* `to` waits for `from`; NONE is fine. */
void predict_edge(struct predict_graph *graph, uint32_t from, uint32_t to);
/* The same; `reads`: `to` needs a result of `from`, which otherwise only comes before it. */
void predict_edge_kind(struct predict_graph *graph, uint32_t from, uint32_t to, bool reads);
/* The same, for the value of an object. */
void predict_edge_value(struct predict_graph *graph, uint32_t from, uint32_t to, uint32_t object);
/* A node of the runtime's own: a task_type, or a message. A round's beginning holds it back like
 * any other root. 0 without memory. */
uint32_t predict_own_node(struct predict_graph *graph, enum predict_kind kind, uint32_t host,
                          uint32_t what, uint64_t number);
/* `node` makes the object's next value, on a host or on all. */
void predict_overwrite(struct predict_graph *graph, uint32_t node, uint32_t object, int host);
/* The node after which the object's value is on the host, or everywhere; NONE: it always was. */
uint32_t predict_fetch(struct predict_graph *graph, uint32_t object, int host);
/* Called before a node on `host` (PREDICT_ALL: everywhere) that uses the object is made. Makes the
 * nodes that come before it. Returns the node after which the value is there; NONE: the value
 * always was, or is not read. */
uint32_t predict_prepare(struct predict_graph *graph, uint32_t object, duite_mode mode, int host);
/* The node uses the object; `prepared`: from predict_prepare. */
void predict_use(struct predict_graph *graph, uint32_t node, uint32_t object, duite_mode mode,
                 uint32_t prepared);
/* A round adds these to its forks, on a host, or on those that the round says (PREDICT_ALL). The
 * open contributions to the object combine; there are some. The object is set. */
void predict_reduce(struct predict_graph *graph, uint32_t object, int host);
void predict_set(struct predict_graph *graph, uint32_t object, int host);
/* The object has another home from now on: its value goes there. */
void predict_rehome(struct predict_graph *graph, uint32_t object, int host);
/* Called when all nodes are there. The seconds of sums, numbers of merges so far, become `seconds`
 * for each merge. */
void predict_sums_take(struct predict_graph *graph, double seconds);
/* A block's hint for mappings: the bytes that it and another one send each other. */
void predict_hint_add(struct predict_graph *graph, uint32_t object, uint32_t other, double bytes);
/* Called when all edges to the node are there, which began with `linked` false. A node waits for
 * the node that decided on its round, unless one of the round comes before it. */
void predict_hold(struct predict_graph *graph, uint32_t node);

/* A round of a replay begins: no packet of it is on its way. */
void predict_packets_clear(struct predict_graph *graph);
/* The packets that a message from a host to another adds to a phase of this round. predict_packets:
 * one to n hosts of a set, without `from`. Outside of replays each message is one packet. */
int32_t predict_packet(struct predict_graph *graph, uint32_t phase, uint32_t from, uint32_t to);
int32_t predict_packets(struct predict_graph *graph, uint32_t phase, uint32_t from,
                        const uint64_t *to, uint32_t n);

/* Checks both: DUITE_OK or DUITE_E_ARGUMENT. */
int predict_check(const struct trace_run *run, const struct predict_cluster *cluster);

/* Makes the graph of a trace. Errors as of predict. */
int predict_build(struct predict_graph *graph);
/* The plain graph, on one host. Errors as of predict; predict_graph_free is due all the same. */
int predict_build_plain(struct predict_graph *graph, const struct trace_run *run);
void predict_graph_free(struct predict_graph *graph);

/* Runs it. */
int predict_simulate(struct predict_graph *graph, struct predict_result *result,
                     const struct predict_more *more);

/* Seconds of tasks by their numbers. */
struct predict_times;
/* `steady`: bodies take the median of their kernel. NULL without memory. */
struct predict_times *predict_times_new(const struct trace_run *run, bool steady);
void predict_times_free(struct predict_times *times);
/* True if the task ran; *seconds: for how long. */
bool predict_times_find(const struct predict_times *times, uint64_t number, double *seconds);
/* The mean of the tasks of a kernel, or their median; of the runtime's own tasks of a kind; between
 * two tasks. */
double predict_times_kernel(const struct predict_times *times, uint32_t kernel);
double predict_times_own(const struct predict_times *times, uint32_t kind);
/* All seconds of the runtime's own tasks that combine contributions. */
double predict_times_sums(const struct predict_times *times);
double predict_times_gap(const struct predict_times *times);
/* All seconds of bodies; and all had each taken the median of its kernel. */
void predict_times_spread(const struct predict_times *times, double *bodies, double *medians);
/* Seconds of a core in the trace: for a message at each of its ends, and for a look that found
 * none. Each worker is assumed to look between two tasks PREDICT_LOOKS apart. False: no worker that
 * had tasks sent or took a message. */
#define PREDICT_LOOKS 5e-6
bool predict_times_messages(const struct predict_times *times, double *message, double *look);

#endif
