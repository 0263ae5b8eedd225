#ifndef DUITE_PLAN_PLAN_H
#define DUITE_PLAN_PLAN_H

#include "runtime/comm/message.h"
#include "runtime/plan/record.h"

/* A plan: a record compiled to flat arrays; with several ranks, this rank's part of it. Workers and
 * the predictor use the affinity of its nodes. The rest is private to this folder. */

/* The merges of a sum's node. */
struct plan_tree {
    const duite_law *law;
    const struct plan_merge *merge;
    size_t n;
};

/* The part of a node beside its task; it lies in the cache line behind the task. */
struct plan_node {
    struct plan *plan;
    union {
        void *args;                   /* or the values of a set; NULL: zeros */
        struct comm_channel *channel; /* NODE_SEND, NODE_RECEIVE */
        const struct plan_tree *tree; /* NODE_SUM, NODE_PARTIAL */
    };
    duite_param *param; /* task->n */
    struct task **next; /* n_next tasks that wait for it, the next round's first */
    uint32_t n_next, n_cyclic;
    uint32_t steady;        /* predecessors in this round and the previous one */
    uint32_t first_use;     /* task->n uses, one for each parameter */
    uint32_t n_leaves;      /* contributions: parameters to be cleared */
    bool sink;              /* no node of its round waits for it */
    bool runs_inline;       /* not a task of the program, and a message waits for it */
    _Atomic uint64_t round; /* that it runs next; written by its worker */
};

/* Bytes that nodes use: the objects of the record; the flag, if it is none of them; then buffers of
 * contributions, of received values, and of copies. */
struct plan_place {
    void *data;
    const struct data_failure *failure; /* poison; kept only once the plan is tainted */
    duite_type type;
    duite_mode mode; /* of the whole replay on this rank: r, w or rw; none for buffers and for
                        objects whose values neither enter nor stay here */
    size_t count, bytes;
    const duite_law *law;         /* of a contribution */
    size_t first_param, n_params; /* in param_of: the parameters that point here */
    _Atomic uint32_t affinity;    /* see duite_ready.affinity */
};

/* The gate of an open replay: its rounds are not known beforehand, and a node may run once the main
 * program has forked it. A gate outlives the plans that use it one after the other, since a worker
 * may look here after the replay is over. See open.c. */
enum { PLAN_OPEN_MAX = 4096 /* nodes of a round */ };
struct plan_gate {
    _Alignas(64) _Atomic uint64_t forked; /* tasks below this number; written by the main thread */
    _Alignas(64) _Atomic uint64_t seen;   /* the value that workers last saw */
    _Alignas(64) _Atomic uint64_t parked[PLAN_OPEN_MAX]; /* by node: its task's number while it
                                                            waits only for its fork, else 0 */
};

/* Faults of the running replay: bits of `tainted`. */
enum {
    PLAN_POISONED = 1, /* something is poisoned */
    PLAN_CLOSED = 2,   /* an open replay was closed: tasks from `unforked` on do not run */
    PLAN_STARVED = 4   /* no memory to begin it: no task runs */
};

struct plan {
    _Atomic uint32_t refs; /* the record, and each unfinished replay */
    struct task_graph *graph;
    _Atomic uint32_t n_affine; /* places with an affinity */
    size_t n_nodes, n_calls, n_uses, n_roots, n_sinks, n_places;
    size_t n_objects;     /* places that are objects */
    void *memory;         /* of all arrays from here to `tree`, without arguments and buffers */
    unsigned char *nodes; /* the tasks: PLAN_NODE_BYTES each */
    struct task **root;   /* nodes without predecessors in their own round */
    struct task **next;
    uint32_t *first;        /* by node: predecessors in the first round */
    uint32_t *call;         /* by node: tasks forked before it, for its number */
    uint32_t *owner;        /* by node: the place that it runs for, or PLAN_NONE */
    struct task_held *held; /* by node, if some kernel has `events` */
    struct plan_node_use *use;
    duite_param *param; /* one a use */
    uint32_t *param_of;
    struct plan_place *place;
    unsigned char *args, *buffers;
    struct plan_merge *merge;
    struct plan_tree *tree;
    size_t n_trees;
    /* With several ranks. */
    struct comm_channel_set channels;
    size_t words;          /* of a set of ranks; 0: there is one rank */
    void *sets;            /* the memory of these: */
    uint64_t *enter, *end; /* by object: ranks that have it before a round; after */
    int *home;             /* by object: when the plan was made */
    uint64_t at_home; /* main thread: table->changes, plus 1, when all objects were last found at
                         home; 0: not found, or others were bound since */
    bool decides;     /* the last node reads a flag and decides on another round */
    size_t flag_place;
    /* Main thread only. */
    struct data_object turn; /* written by each replay, so that replays run one after the other */
    uint64_t started;        /* replays */
    /* The running replay. */
    struct task *replay;
    struct plan_gate *gate;    /* of an open replay, also once closed; else NULL */
    size_t ring_mask, stride;  /* round r has its arguments r & mask strides on; 0: no ring */
    _Atomic uint64_t begun;    /* replays whose nodes may run */
    _Atomic uint64_t unforked; /* the number of the first task that was not forked */
    uint64_t first_round;      /* in the program's count; the plan's own rounds begin with 0 */
    _Atomic uint64_t last; /* the last round, or with a flag the last possible one; of a closed open
                              replay a round whose tasks were not forked */
    bool stop;             /* set by the deciding node */
    _Atomic uint64_t over, rounds;         /* replays that are over; rounds of the last one */
    _Alignas(64) _Atomic uint32_t tainted; /* bits, see above */
    _Alignas(64) _Atomic int64_t left;     /* sinks to come, see plan_node_finish */
};

/* The data of a replay's task. */
struct plan_replay {
    struct plan *plan;
    uint64_t first_round;        /* in the program's count */
    uint64_t rounds;             /* with a flag: the maximum of them */
    uint64_t number;             /* of the first task */
    struct plan_change *changes; /* oldest last; owned */
    uint32_t block[];            /* by place */
};

#define PLAN_NODE_AT    ((sizeof(struct task) + 63) / 64 * 64)
#define PLAN_NODE_BYTES (PLAN_NODE_AT + (sizeof(struct plan_node) + 63) / 64 * 64)

static inline struct task *plan_task(const struct plan *plan, size_t i)
{
    return (struct task *)(void *)(plan->nodes + i * PLAN_NODE_BYTES);
}

/* The number of a node: nodes are in the order of forks. */
static inline size_t plan_node_number(const struct task *task)
{
    return (size_t)((const unsigned char *)task - task->node->plan->nodes) / PLAN_NODE_BYTES;
}

/* The place that a node runs for, by the owner rule; NULL: none. */
static inline struct plan_place *plan_node_place(const struct task *task)
{
    const struct plan *plan = task->node->plan;
    const size_t at = plan_node_number(task);
    return plan->owner[at] == PLAN_NONE ? NULL : &plan->place[plan->owner[at]];
}

/* A shorter task is over before another core has its data: it leaves no affinity. */
#define PLAN_AFFINITY_SECONDS 2e-6

/* Notes the worker, plus 1, whose caches may have the node's place; 0: none. All workers read it,
 * so it is written only when it changes. */
static inline void plan_task_set_affinity(const struct task *task, uint32_t affinity)
{
    struct plan_place *place = plan_node_place(task);
    if (!place || atomic_load_explicit(&place->affinity, memory_order_relaxed) == affinity)
        return;
    const bool had =
        atomic_exchange_explicit(&place->affinity, affinity, memory_order_relaxed) != 0;
    if (had != (affinity != 0))
        atomic_fetch_add_explicit(&task->node->plan->n_affine, affinity ? 1 : UINT32_MAX,
                                  memory_order_relaxed);
}

/* Returns whether nodes of the plan may have an affinity, which is then looked up. */
static inline bool plan_is_affine(const struct plan *plan)
{
    return atomic_load_explicit(&plan->n_affine, memory_order_relaxed) != 0;
}

/* See duite_ready.affinity. */
static inline uint32_t plan_task_affinity(const struct task *task)
{
    if (task->type != TASK_NODE || !plan_is_affine(task->node->plan))
        return 0;
    const struct plan_place *place = plan_node_place(task);
    return place ? atomic_load_explicit(&place->affinity, memory_order_relaxed) : 0;
}

/* Compiles a record for a fixed number of rounds, or with a flag: an object of the record that is
 * bound to it, or one more if there is none. Time and memory are linear in the record. With *plan
 * NULL: COMM_NEEDS_TAGS, or an error: memory, MPI. */
int plan_new(struct plan **plan, const struct plan_record *record, const duite_object *flag);
/* Returns whether plan_new could have made this plan. */
bool plan_fits(struct plan *plan, const struct plan_record *record, const duite_object *flag);
/* For several ranks. The first makes this rank's part of a round, without edges. The second opens
 * the channels once all nodes are there. Errors: memory. */
bool plan_of_ranks(struct plan *plan, const struct plan_round *round, struct plan_round *part,
                   const struct plan_record *record, const duite_object *flag);
int plan_open(struct plan *plan, const struct plan_round *part);
/* The mode of a whole replay on this rank. */
duite_mode plan_mode(const struct plan *plan, size_t i);
/* Sends an object's value to all ranks whose rounds begin with it, or receives it. */
int plan_fetch(const struct plan *plan, struct worker *worker, size_t i,
               struct data_object *object);
/* Moves the object to the ranks where the plan leaves it. False: the plan does not write it. */
bool plan_moves(const struct plan *plan, size_t i, struct data_object *object);
/* Bytes of a node's message with all its failures. */
size_t plan_channel_room(const struct plan *plan, const struct task *task);
/* A NODE_SEND writes its message and returns its bytes. A NODE_RECEIVE reads its message, or (lost)
 * poisons its places. Afterwards the caller finishes the node. Any worker. */
size_t plan_channel_pack(struct comm_channel *channel, void *message);
void plan_channel_unpack(struct comm_channel *channel, const void *message);
void plan_channel_lost(struct comm_channel *channel);
/* One of the program's tasks that wait in this round for a NODE_RECEIVE, or NULL; more: the number
 * of others. The replay must not go on meanwhile. */
const struct task *plan_channel_waits(const struct comm_channel *channel, unsigned *more);
/* Returns whether the homes are still those that the plan was made for. */
bool plan_at_home(struct plan *plan, const struct plan_record *record);

/* Drop: the record gives up its plan (NULL is fine). Release: a replay is over. The last of them
 * frees the plan. */
void plan_drop(struct plan *plan, struct worker *worker);
void plan_release(struct plan *plan);

/* A replay: binds the objects; starts the first round. */
void plan_replay_run(struct task *task);
void plan_replay_start(struct task_graph *graph, struct worker *worker, struct task *task);
/* Open replays, main thread only. Open: begins one of the record's plan, which has no other
 * unfinished replay; the next forked task is its first. Errors: memory. Forked: the main program
 * forked its next task, node i. Close: no more tasks come; `first` was the first. */
int plan_replay_open(struct plan_record *record, struct worker *worker, struct plan_gate *gate);
static inline void plan_forked(struct plan *plan, struct worker *worker, uint32_t i);
void plan_replay_close(struct plan *plan, struct worker *worker, uint64_t first);
/* Part of plan_replay_open: no task from `first` on is forked yet. */
void plan_gate_close(struct plan *plan, struct plan_gate *gate, uint64_t first);
/* Part of plan_forked: the node may be parked with its task of this number. */
void plan_unpark(struct plan *plan, struct worker *worker, uint32_t i, uint64_t number);
/* Part of plan_node_may_run: workers have not seen yet that the task was forked. */
bool plan_passes(struct plan *plan, struct task *task);
/* Makes room for the arguments of so many rounds, a power of 2, `stride` bytes each; no replay is
 * unfinished. False without memory. Rounds over: how many rounds, from the first, no longer need
 * their arguments. */
bool plan_ring(struct plan *plan, size_t rounds, size_t stride);
uint64_t plan_rounds_over(const struct plan *plan);
bool plan_is_over(const struct plan *plan);

static inline void plan_forked(struct plan *plan, struct worker *worker, uint32_t i)
{
    struct task_graph *const graph = plan->graph;
    const uint64_t number = ++graph->root.forks;
    graph->tasks++;
    atomic_exchange_explicit(&plan->gate->forked, number + 1, memory_order_seq_cst);
    if (atomic_load_explicit(&plan->gate->parked[i], memory_order_seq_cst) == number)
        plan_unpark(plan, worker, i, number);
}

/* Run: runs a node and returns whether a body ran. Finish: counts its successors down, unless the
 * node waits for events, which hand it to the workers; then the caller has it no more. */
bool plan_node_run(struct task_graph *graph, struct worker *worker, struct task *task,
                   const duite_call *call);
void plan_node_finish(struct task_graph *graph, struct worker *worker, struct task *task);

#endif
