#ifndef DUITE_TOOLS_PREDICT_GRAPH_H
#define DUITE_TOOLS_PREDICT_GRAPH_H

#include "runtime/data/order.h"
#include "tools/predict/predict.h"

#include <duite.h>

/* The run as a graph: nodes, and the main program's steps. Without rounds of several hosts no edge
 * points back. Plain data of one thread; its owner frees it by predict_graph_free. */

#define PREDICT_NONE UINT32_MAX

enum predict_kind {
    PREDICT_TASK,    /* runs on a worker of its host */
    PREDICT_MESSAGE, /* from `host` to `block`; number: bytes */
    PREDICT_INSTANT  /* takes no time */
};

struct predict_node {
    uint64_t number;
    uint32_t kernel; /* of kernels; beyond them: the runtime's own, by task_type */
    uint32_t host, block;
    int32_t priority;
    float seconds, cost, path;
    uint32_t pending; /* edges that end here, and 1 for the main program */
    uint32_t edge;    /* the first of those that begin here, or NONE */
    uint32_t placed;  /* tasks of a round: 1 + the object that places it; else 0 */
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
    int holder; /* the host that has the value; `copies`: further ones */
    uint32_t block;
    struct data_order_chain order; /* nodes that use it, on all hosts */
    uint32_t copies, leaves;       /* lists in `link` */
    uint64_t bytes;
    uint32_t leader; /* that it follows, or NONE */
    uint32_t hints;  /* list in `hint` */
    uint32_t place;  /* in the record that is replayed, plus 1, while its round is compiled */
    bool shown;      /* counted in `shown` of its writer */
    bool written;    /* a task has */
    bool lasts;      /* its value is of before the trace, and no task of the trace writes it */
};

enum { PREDICT_ALL = -1 }; /* in place of a host: each */

struct predict_link {
    uint32_t node, host, next;
};

/* Bytes that a block sends to another one, which the object leads. */
struct predict_hint {
    uint32_t object, next;
    double bytes;
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
    struct data_order_reader *reader; /* of all objects */
    uint32_t n_readers;
    size_t readers_capacity;
    struct predict_hint *hint;
    size_t n_hints, hints_capacity;
    void *memory;    /* of the arrays by host */
    uint32_t *began; /* by host: the node that begins a replay there, or NONE */
    uint32_t *over;  /* ... that ends it, or a task that each host runs */
    uint64_t *all;   /* the set of all hosts */
    uint32_t *count; /* by host: zeros, but for a moment */
    double own[64];  /* by task_type: s of the runtime's own tasks, those of sums left out */
    double merges;   /* that the sums of the trace took */
    uint32_t round;  /* the first node of this forked round, or NONE */
    bool decided;    /* on this forked round, where `began` has the flag's value */
    const struct predict_platform *platform; /* the cluster's, or `flat` */
    struct predict_platform flat;
    double slowest; /* speed of a core */
    struct predict_costs {
        double overhead;    /* s between two tasks, */
        double message;     /* of a core, to send or to take one, */
        double look;        /* and to look for one, which workers do now and then; 0: no messages */
    } * costs;              /* by host */
    double bodies, medians; /* s, as predict_result has them */
    uint64_t n_tasks, migrated;
    bool plain;           /* only tasks and what they read: no edges of other kinds, no gates */
    bool replays, failed; /* failed: no memory */
    bool linked;          /* the node that is being made has an edge from its own forked round */
};

/* ---- graph.c: nodes and edges ---- */

/* How fast a core of the host is, against the traced one. Seconds of nodes are those of the traced
 * one until the graph is made. */
static inline double predict_speed(const struct predict_graph *graph, uint32_t host)
{
    return graph->platform->place[host].speed;
}
/* An array has room for one more, or not for want of memory. False: graph->failed, now or before.
 */
static inline bool predict_grew(struct predict_graph *graph, bool grew)
{
    graph->failed |= !grew;
    return !graph->failed;
}
/* A node that waits for nothing yet. 0 without memory (and graph->failed). */
uint32_t predict_add(struct predict_graph *graph, const struct predict_node *node);
/* `to` waits for `from`; NONE is fine. */
void predict_edge(struct predict_graph *graph, uint32_t from, uint32_t to);
/* The same; `reads`: `to` needs a result of `from`, which otherwise only comes before it. */
void predict_edge_kind(struct predict_graph *graph, uint32_t from, uint32_t to, bool reads);
/* A node of the runtime's own: a task_type, or a message. 0 without memory. */
uint32_t predict_own_node(struct predict_graph *graph, enum predict_kind kind, uint32_t host,
                          uint32_t what, uint64_t number);
/* Puts a node on a host into a list. */
void predict_link_push(struct predict_graph *graph, uint32_t *list, uint32_t node, uint32_t host);
/* Called when all edges to the node are there, which began with `linked` false. A node waits for
 * the flag that decided on its forked round, unless one of the round comes before it. */
void predict_hold(struct predict_graph *graph, uint32_t node);

/* ---- value.c: the order of uses, and where values are ---- */

/* The node that made the object's value, or NONE. */
static inline uint32_t predict_writer(const struct predict_object *object)
{
    return object->order.writer - 1;
}
/* Like predict_edge_kind, for the value of an object. */
void predict_edge_value(struct predict_graph *graph, uint32_t from, uint32_t to, uint32_t object);
/* `node` makes the object's next value, on a host. */
void predict_overwrite(struct predict_graph *graph, uint32_t node, uint32_t object, int host);
/* The node after which the object's value is on the host; NONE: it always was. */
uint32_t predict_fetch(struct predict_graph *graph, uint32_t object, int host);
/* Called before a node on `host` that uses the object is made. Makes the nodes that come before it.
 * Returns the node after which the value is there; NONE: the value always was, or is not read. */
uint32_t predict_prepare(struct predict_graph *graph, uint32_t object, duite_mode mode, int host);
/* The same on each host; returns what it is on host 0. */
uint32_t predict_prepare_all(struct predict_graph *graph, uint32_t object, duite_mode mode);
/* The node uses the object; `prepared`: from predict_prepare. */
void predict_use(struct predict_graph *graph, uint32_t node, uint32_t object, duite_mode mode,
                 uint32_t prepared);
/* The object is set at its home. */
void predict_set(struct predict_graph *graph, uint32_t object);
/* The object has another home from now on: its value goes there. */
void predict_rehome(struct predict_graph *graph, uint32_t object, int host);
/* A part of a replay, or of a task that each host runs, begins on a host with `node`: it reads the
 * object's value there (predict_fetch made it come), or writes it there, or both. */
void predict_enter(struct predict_graph *graph, uint32_t node, uint32_t object, int host,
                   bool reads, bool writes);
/* It is over on each of these hosts, by graph->over: it read the object there, or wrote it. */
void predict_leave(struct predict_graph *graph, uint32_t object, const uint64_t *hosts,
                   bool writes);
/* A block's hint for mappings: the bytes that it and another one send each other. */
void predict_hint_add(struct predict_graph *graph, uint32_t object, uint32_t other, double bytes);
/* The bytes of the object that go to a host in a replay. */
uint64_t predict_bytes_to(const struct predict_graph *graph, uint32_t object, uint32_t host);

/* ---- sum.c ---- */

/* The open contributions to the object combine; there are some. */
void predict_reduce(struct predict_graph *graph, uint32_t object);
/* A sum of so many contributions was made in the trace, on one rank or on all. */
void predict_sum_count(struct predict_graph *graph, size_t contributions, bool all);
/* Called when all nodes are there. The seconds of sums, numbers of merges so far, become `seconds`
 * for each merge. */
void predict_sums_take(struct predict_graph *graph, double seconds);

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
