#ifndef DUITE_PLAN_PLAN_H
#define DUITE_PLAN_PLAN_H

#include "runtime/plan/channel.h"
#include "runtime/plan/record.h"

/* A plan: a record compiled to flat arrays; of several ranks, this one's part of it. Workers and
 * the predictor use the affinity of its nodes. All else is this folder's. */

/* All steps of a node that adds. */
struct plan_tree {
    const duite_law *law;
    const struct plan_merge *merge;
    size_t n;
};

/* The part of a node that is not a task's; it lies in the cache line behind the task. */
struct plan_node {
    struct plan *plan;
    union {
        void *args;                   /* or what a set writes; NULL: zeros */
        struct plan_channel *channel; /* NODE_SEND, NODE_RECEIVE */
        const struct plan_tree *tree; /* NODE_SUM, NODE_PARTIAL */
    };
    duite_param *param; /* task->n */
    struct task **next; /* n_next tasks that wait for it, those of the next round first */
    uint32_t n_next, n_cyclic;
    uint32_t steady;        /* predecessors in this round and the last one */
    uint32_t first_use;     /* its uses, one a parameter: task->n */
    uint32_t n_leaves;      /* parameters to be cleared: contributions */
    bool sink;              /* nothing of its round waits for it */
    bool runs_inline;       /* no task of the program, and a message waits for it */
    _Atomic uint64_t round; /* the one it runs next; written by whoever has it */
};

/* Bytes that nodes use: first the objects of the record and the flag, if it is none of them, then
 * the buffers of contributions, of what comes from other ranks, and of copies. */
struct plan_place {
    void *data;
    const struct data_failure *failure; /* poison; kept only once the plan is tainted */
    duite_type type;
    duite_mode mode; /* of the whole replay on this rank: r, w or rw; none for buffers, and for
                        objects whose values neither come from outside nor stay here */
    size_t count, bytes;
    const duite_law *law;         /* of a contribution */
    size_t first_param, n_params; /* in param_of: those that point here */
    _Atomic uint32_t affinity;    /* see duite_ready.affinity */
};

/* A replay that is open: its rounds are not known beforehand, and a node may run once the main
 * program forked it. It outlives all plans that use it one after the other, since a worker may look
 * here after the replay is over. See open.c. */
enum { PLAN_OPEN_MAX = 4096 /* nodes of a round */ };
struct plan_gate {
    _Alignas(64) _Atomic uint64_t forked; /* tasks below this number are; the main thread's */
    _Alignas(64) _Atomic uint64_t seen;   /* what workers last saw of it */
    _Alignas(64) _Atomic uint64_t parked[PLAN_OPEN_MAX]; /* by node: its task's number, if it waits
                                                            for nothing but its fork; or 0 */
};

/* What is wrong in the replay that runs: bits of `tainted`. */
enum {
    PLAN_POISONED = 1, /* something is */
    PLAN_CLOSED = 2,   /* it was open: tasks from `unforked` on were not forked, and do not run */
    PLAN_STARVED = 4   /* there was no memory to begin it: no task runs */
};

struct plan {
    _Atomic uint32_t refs; /* the record, and each replay on its way */
    struct task_graph *graph;
    _Atomic uint32_t n_affine; /* places with an affinity */
    size_t n_nodes, n_calls, n_uses, n_roots, n_sinks, n_places;
    size_t n_objects;     /* places that are objects */
    void *memory;         /* of all arrays from here to `tree`, but for arguments and buffers */
    unsigned char *nodes; /* the tasks: PLAN_NODE_BYTES each */
    struct task **root;   /* those without predecessors in their own round */
    struct task **next;
    uint32_t *first; /* by node: predecessors in the first round */
    uint32_t *call;  /* by node: tasks forked before it, which gives its number */
    uint32_t *owner; /* by node: the place it runs for, or PLAN_NONE */
    struct plan_node_use *use;
    duite_param *param; /* one a use */
    uint32_t *param_of;
    struct plan_place *place;
    unsigned char *args, *buffers;
    struct plan_merge *merge;
    struct plan_tree *tree;
    size_t n_trees;
    /* Of several ranks. */
    struct plan_channels channels;
    size_t words;          /* of a set of ranks; 0: there is one rank */
    uint64_t *enter, *end; /* by object: the ranks whose rounds begin with it, that have it after */
    int *home;             /* by object: when the plan was made */
    uint64_t at_home; /* main thread: table->changes, plus 1, when objects were last found there; 0:
                         they were not, or others were bound since */
    bool decides;     /* the last node reads a flag and decides whether there is another round */
    size_t flag_place;
    /* Main thread only. */
    struct data_object turn; /* written by each replay: one waits for the other */
    uint64_t started;        /* replays */
    /* Of the replay that runs. */
    struct task *replay;
    struct plan_gate *gate;   /* it is open, or was; NULL: it is not */
    size_t ring_mask, stride; /* round r finds its arguments r & mask strides on; 0: there is one */
    _Atomic uint64_t begun;   /* replays of which nodes may run */
    _Atomic uint64_t unforked; /* the number of the first task that was not forked */
    uint64_t first_round;      /* as the program counts; the plan's own rounds begin with 0 */
    _Atomic uint64_t last; /* the last round, or the last that the flag can ask for; of an open one
                              a round whose tasks were not forked */
    bool stop;             /* said by the deciding node */
    _Atomic uint64_t over, rounds;         /* replays that are over; rounds of the last of them */
    _Alignas(64) _Atomic uint32_t tainted; /* bits, see above */
    _Alignas(64) _Atomic int64_t left;     /* sinks to come, see plan_node_finish */
};

/* A replay on its way: what its task carries. */
struct plan_replay {
    struct plan *plan;
    uint64_t first_round;        /* as the program counts */
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

/* The place that a node runs for, by the owner rule; NULL: none. */
static inline struct plan_place *plan_node_place(const struct task *task)
{
    const struct plan *plan = task->node->plan;
    const size_t at = (size_t)((const unsigned char *)task - plan->nodes) / PLAN_NODE_BYTES;
    return plan->owner[at] == PLAN_NONE ? NULL : &plan->place[plan->owner[at]];
}

/* What takes less is over before another core has its data: it leaves no affinity. */
#define PLAN_AFFINITY_SECONDS 2e-6

/* Notes whose caches may have what the node runs for: 1 and the worker, or 0. All workers read what
 * this writes: it is written only where it changes. */
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

/* Whether nodes of the plan may have an affinity. Short ones have none, and are not looked up. */
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
 * NULL: PLAN_NEEDS_TAGS, or an error: memory, MPI. */
int plan_new(struct plan **plan, const struct plan_record *record, const duite_object *flag);
/* Could plan_new have made this plan? */
bool plan_fits(struct plan *plan, const struct plan_record *record, const duite_object *flag);
/* Of several ranks. The first makes this rank's part of a round, without edges. The second opens
 * the channels, when all nodes are there. Errors: memory. */
bool plan_of_ranks(struct plan *plan, const struct plan_round *round, struct plan_round *part,
                   const struct plan_record *record, const duite_object *flag);
int plan_open(struct plan *plan, const struct plan_round *part);
/* The mode of a whole replay on this rank. */
duite_mode plan_mode(const struct plan *plan, size_t i);
/* Sends an object's value to all ranks whose rounds begin with it, or receives it. */
int plan_fetch(const struct plan *plan, struct worker *worker, size_t i,
               struct data_object *object);
/* The object has a new version where the plan leaves it. False: the plan does not write it. */
bool plan_moves(const struct plan *plan, size_t i, struct data_object *object);
/* Bytes of a node's message with all its failures. */
size_t plan_channel_room(const struct plan *plan, const struct task *task);
/* Whether the homes are those that the plan was made for. */
bool plan_at_home(struct plan *plan, const struct plan_record *record);

/* The record drops its plan (NULL is fine); a replay is over. The last of them frees the plan. */
void plan_drop(struct plan *plan, struct worker *worker);
void plan_release(struct plan *plan);

/* A replay: binds the objects; starts the first round. */
void plan_replay_run(struct task *task);
void plan_replay_start(struct task_graph *graph, struct worker *worker, struct task *task);
/* Open replays. Open: begins one of the record's plan, of which no other one is on its way; the
 * next task that is forked will be its first. Errors: memory. Forked: the main program forked its
 * next task, node i. Close: no more are to come; `first` was its first task. All three by the main
 * thread. */
int plan_replay_open(struct plan_record *record, struct worker *worker, struct plan_gate *gate);
static inline void plan_forked(struct plan *plan, struct worker *worker, uint32_t i);
void plan_replay_close(struct plan *plan, struct worker *worker, uint64_t first);
/* Of plan_replay_open: no task from `first` on is forked yet. */
void plan_gate_close(struct plan *plan, struct plan_gate *gate, uint64_t first);
/* Of plan_forked: the node may wait for that, with its task of this number. */
void plan_unpark(struct plan *plan, struct worker *worker, uint32_t i, uint64_t number);
/* Of plan_node_may_run: workers have not seen yet that the task was forked. */
bool plan_passes(struct plan *plan, struct task *task);
/* Room for the arguments of so many rounds, a power of 2, `stride` bytes each; no replay is on its
 * way. False without memory. Then, for the main program: those of node i in this round; rounds,
 * beginning with the first, whose arguments nobody needs any more. */
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

/* A node of a replay: runs it, and returns whether a body ran; counts its successors down. */
bool plan_node_run(struct task_graph *graph, struct worker *worker, struct task *task,
                   const duite_call *call);
void plan_node_finish(struct task_graph *graph, struct worker *worker, struct task *task);

#endif
