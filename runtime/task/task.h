#ifndef DUITE_TASK_TASK_H
#define DUITE_TASK_TASK_H

#include "runtime/comm/guests.h"
#include "runtime/comm/history.h"
#include "runtime/comm/message.h"
#include "runtime/data/object.h"
#include "runtime/data/sum.h"
#include "runtime/queue/pool.h"
#include "runtime/task/fingerprint.h"
#include "runtime/task/owner.h"

#include <duite_policy.h>
#include <pthread.h>
#include <stdatomic.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* Tasks and what they wait for, on one rank.
 *
 * The main thread forks. In fork order, it derives from the accesses which rank runs a task, which
 * versions the task reads and makes here, and which must be sent or awaited. Workers run ready
 * tasks and publish their results. Only versions and sums join the two sides. */

/* A task's type, from its birth to its end. Traces use the same numbers; there, TASK_TRACED_VOID is
 * a task that could not be forked. */
enum task_type {
    TASK_BODY = 0,    /* a task of the program */
    TASK_COMBINE = 1, /* combines the contributions with an object */
    TASK_PIECES = 2,  /* combines this rank's contributions, and sends them */
    TASK_GATHER = 3,  /* combines the contributions of a task's children into one of its own */
    TASK_SEND = 4,    /* sends a version to another rank */
    TASK_LEAVE = 5,   /* duite_free of adopted memory: gives it back with the last value */
    TASK_COPY = 6,    /* duite_get: copies a version to the main program */
    TASK_MOVE = 7,    /* an object that moves here has come: nothing is left to do */
    TASK_TRACED_VOID = 8,
    TASK_OFFLOADED = 10, /* a task of another rank that runs here, and sends its results */
    TASK_REPLAY = 12,    /* replays of a recorded graph: begins them; over when the last round is */
    /* Nodes of a replay: */
    TASK_NODE = 13,         /* a task of the program */
    TASK_NODE_SET = 14,     /* duite_set */
    TASK_NODE_SUM = 15,     /* combines contributions with an object */
    TASK_NODE_PARTIAL = 16, /* combines this rank's contributions as far as they go */
    TASK_NODE_COPY =
        17, /* copies a value that is about to be overwritten, or came from elsewhere */
    TASK_NODE_FLAG = 19,   /* decides whether there is another round */
    TASK_NODE_SEND = 20,   /* sends a message to another rank, */
    TASK_NODE_RECEIVE = 21 /* or awaits one: both are the communication's to run */
};

/* A task's state. */
enum task_state {
    TASK_LOCAL = 0, /* nothing: it waits, runs and ends here, as its type says */
    TASK_VOID, /* memory ran out while it was forked: does not run, and poisons what it writes */
    TASK_DELEGATED, /* a BODY: goes to another rank in a message, until that rank answers */
    TASK_LEAVES,    /* PIECES, OFFLOADED: it ran, and its results are to be sent */
    TASK_HELD, /* a BODY or NODE whose kernel has `events`: ends when they are completed, too */
    TASK_ENDED /* ... which they are: it ran, and is to be ended */
};

struct task_scope;
struct task_graph;

/* One parameter of a task: a quarter of a cache line. The version, the sum or, if it is postponed,
 * the task's scope says the rest about the object. */
struct task_access {
    union {
        struct data_waiter waiter; /* r, w, rw: the version, or waits for it */
        struct {
            union {
                struct data_object *object; /* while it is forked */
                struct data_piece *leaf;    /* cw, cwp: this task's part of the sum */
                struct data_version *left;  /* OFFLOADED, postponed: what its children write */
                bool sized;                 /* OFFLOADED: the object changes its size */
            };
            uint32_t lent; /* postponed: its place in the task's scope */
            uint32_t mode; /* the waiter's */
        };
    };
};
_Static_assert(sizeof(struct task_access) == 16, "tasks that wait take little memory");

/* One cache line, then the accesses, then, at a multiple of 16 bytes, the arguments or the union's
 * target. */
struct task {
    _Atomic uint32_t pending; /* accesses that wait, and 1 while it is being forked */
    uint32_t n;
    struct queue_link link; /* for whoever holds the task: queues, lists */
    union {
        struct task_scope *inner;       /* BODY: its children's scope, or NULL */
        struct task_sum *sum;           /* COMBINE, PIECES, GATHER */
        struct comm_letter *send;       /* SEND; as long as it is DELEGATED or LEAVES */
        struct offload_task *offloaded; /* OFFLOADED */
        struct task_copy *copy;         /* COPY */
        struct data_adopted *adopted;   /* LEAVE */
        struct plan_replay *replay;     /* REPLAY */
        struct plan_node *node;         /* NODE... */
    };
    struct task_scope *scope; /* where it was forked */
    uint64_t number;          /* in fork order among the tasks of its scope */
    uint32_t kernel;          /* index in the list given at start */
    uint32_t block;           /* for schedulers: of the object that it runs for */
    int32_t priority;
    float cost; /* seconds; 0: not said */
    union {
        uint32_t grains; /* of all of it, TASK_GRAIN bytes each */
        float path;      /* NODE...: seconds from its begin to the end of the round, or 0 */
    };
    enum task_type type : 8;
    enum task_state state : 8;
    unsigned at_rank : 1; /* its fork named a rank: no other one runs it */
    unsigned placed : 1;  /* by the home of an object, whose block it has: it moves with that */
    unsigned later : 1; /* a BODY of a later round than the first of a replay: see task_round_at */
    struct task_access access[];
};
_Static_assert(offsetof(struct task, link) == QUEUE_LINK_AT, "queues know where the link is");

enum { TASK_GRAIN = 16, TASK_MAX_OBJECTS = 1 << 26 /* of a task */ };

/* The bytes behind the accesses: in a BODY its copy of the arguments. n: as when the task was
 * made. */
static inline void *task_rest(struct task *task, size_t n)
{
    return (char *)task + sizeof *task + n * sizeof task->access[0];
}

/* True if a fork gives arguments exactly when its kernel takes some. */
static inline bool task_args_fit(const void *args, size_t args_size)
{
    return !args == !args_size;
}

/* The offset in task_rest of the round of a BODY that is `later`; and that round. */
static inline size_t task_round_at(size_t args_size)
{
    return (args_size + sizeof(uint64_t) - 1) / sizeof(uint64_t) * sizeof(uint64_t);
}
uint64_t task_later_round(const struct task *task);

/* True if the task has one of these types, a set of TASK_TYPE_BITs. */
#define TASK_IS(task, types) ((types) >> (task)->type & 1)
#define TASK_TYPE_BIT(type)  (UINT32_C(1) << (type))
#define TASK_TYPES_CHANNEL   (TASK_TYPE_BIT(TASK_NODE_SEND) | TASK_TYPE_BIT(TASK_NODE_RECEIVE))
#define TASK_TYPES_NODE                                                                            \
    (TASK_TYPE_BIT(TASK_NODE) | TASK_TYPE_BIT(TASK_NODE_SET) | TASK_TYPE_BIT(TASK_NODE_SUM) |      \
     TASK_TYPE_BIT(TASK_NODE_PARTIAL) | TASK_TYPE_BIT(TASK_NODE_COPY) |                            \
     TASK_TYPE_BIT(TASK_NODE_FLAG) | TASK_TYPES_CHANNEL)
#define TASK_TYPES_WITH_BODY                                                                       \
    (TASK_TYPE_BIT(TASK_BODY) | TASK_TYPE_BIT(TASK_NODE) | TASK_TYPE_BIT(TASK_OFFLOADED))

/* True for a node of a replay. */
static inline bool task_is_node(const struct task *task)
{
    return TASK_IS(task, TASK_TYPES_NODE);
}

static inline float task_path(const struct task *task)
{
    return task_is_node(task) ? task->path : 0;
}

/* COMBINE, PIECES and GATHER: the contributions to close. */
struct task_sum {
    struct data_waiter waiter; /* waits for them all */
    struct data_sum *sum;
    struct comm_letter send; /* the version they make; PIECES: to the rank that adds */
};

/* COPY: where a value goes. `done` is set last. */
struct task_copy {
    void *values; /* NULL: nowhere */
    size_t bytes; /* how many there were */
    const struct data_failure *failure;
    _Atomic int done;
};

/* Tasks are forked in a scope: the main program's, or a task's. A task's scope (scope.c) holds the
 * objects that its children may use, each a chain of versions like the main program's. It lives
 * until all of the task's descendants are over. While the body runs, only its worker uses the
 * scope; afterwards nothing forks here, and only `unfinished` and `failure` change. */
struct task_scope {
    struct task_graph *graph;
    struct task_scope *parent;   /* where its task was forked; NULL: the main program, or the
                                    `above` of an offloaded task */
    struct task_scope *top;      /* the last of the parents: the main program's, or an offloaded
                                    task's */
    _Atomic uint64_t unfinished; /* tasks forked here, each with its descendants; values to be
                                    passed to the scope above; 1 while the body runs. The main
                                    program's: see queue_over */
    uint64_t forks;              /* so far; inside a task waits count, too */
    const struct data_failure *failure; /* first in reference order since the last wait; `lock` */
    uint64_t number;                    /* of its task; as are: */
    uint32_t block;
    bool placed;
    uint64_t segment;                 /* `forks` at the last wait of the body */
    uint32_t depth;                   /* 0: the main program */
    bool outward;                     /* its children may wait for tasks outside of it */
    const struct data_failure *place; /* of an offloaded task's top: where it stands
                                         at home */
};

/* Checking mode: calls the body of the task with that number, and returns its code. */
typedef int task_check_body(struct queue_pool *pool, const duite_kernel *kernel, uint64_t number,
                            duite_call *call);

/* The task of another rank with this top scope is over, with all its descendants. */
typedef void task_top_over(struct task_scope *top, struct worker *worker);

/* A HELD task of the runtime's own is over; failure: NULL, or why its results are poisoned. */
typedef void task_own_over(struct task_graph *graph, const void *args,
                           const struct data_failure *failure);

/* Events of this rank by slot. */
struct task_events {
    struct task_event *event;
    size_t capacity;
    uint32_t n, vacant;
    uint32_t pending;        /* the program is to complete; without those of requests of MPI */
    _Atomic uint32_t inside; /* threads in task_complete */
};

struct task_graph {
    /* Read by all workers, with every task. */
    int rank, n_ranks;
    const duite_kernel **kernels;
    struct task_fixed { /* parameters in each kernel's `access` */
        const duite_kernel *kernel;
        uint32_t index, n, postponed;
        uint32_t owner[2]; /* which of n objects, of more than n, a task runs for: see owner.h */
        uint32_t grains;   /* of a task with n objects */
        uint64_t hash;     /* of a fork that names no rank, before its objects */
        bool few;          /* r, w, rw and cw alone, few of them, no others; it is not replicated
                              and has no events */
        bool plain;        /* ... and no cw */
        bool direct;       /* ... and there is one rank */
        struct task *head; /* plain: template of a task that was just forked; owned */
    } * fixed;
    uint32_t n_kernels;
    struct task_fixed **kernel_place; /* by address, open addressing */
    uint32_t kernel_mask;
    bool paths; /* plans are to know the paths of their tasks; set before the first of them */
    _Atomic int given_up;    /* bodies do not run any more */
    task_check_body *check;  /* checking mode: calls bodies; NULL: they are called directly */
    struct queue_pool *pool; /* runs the tasks; NULL: not yet, or no more */
    struct comm *comm;       /* NULL: there is one rank */
    /* The main thread's, written with every fork: on cache lines of its own. */
    _Alignas(
        64) struct task_scope root; /* the main program; its `forks` are the same on all ranks */
    uint64_t fingerprint;           /* of the main program's calls */
    struct comm_history *history;   /* of them; NULL on one rank */
    uint64_t tasks;                 /* of this rank that it forked, or that serve it */
    struct data_table table;
    /* Seldom used. */
    _Alignas(64) _Atomic int broken; /* memory ran out in a fork: the code of every later call */
    _Atomic uint64_t offloaded;      /* tasks of other ranks that are here */
    _Atomic uint64_t delegated; /* tasks of this rank that went to others so far: their names */
    task_top_over *offloaded_over;
    pthread_mutex_t lock; /* of the rest, and of the failures of scopes */
    struct task_failure *failures;
    struct task_events events;
    struct comm_guests guests;   /* requests of MPI that tasks wait for */
    const duite_law **laws;      /* of the program, ended by NULL */
    uint32_t own_kernels, n_own; /* the first kernel of the runtime's own, and how many there are */
    task_own_over *own_over;
    struct data_sum *unclosed; /* sums of ended tasks, kept for want of memory */
};

/* Checks `kernels`, which NULL ends, and `laws`, likewise or NULL, and copies the lists. The runner
 * of the tasks sets `pool`, `comm`, `check` and `offloaded_over`. Errors: DUITE_E_KERNEL,
 * DUITE_E_LAW, memory; task_graph_stop is due all the same. */
int task_graph_start(struct task_graph *graph, int rank, int n_ranks,
                     const duite_kernel *const *kernels, const duite_law *const *laws);
/* Frees everything, also objects that were not freed. No task is left. */
void task_graph_stop(struct task_graph *graph);

/* Checks a kernel that is to be added, with the laws that it names. Errors: DUITE_E_KERNEL,
 * DUITE_E_LAW, memory. */
int task_kernel_check(const struct task_graph *graph, const duite_kernel *kernel);
/* Adds it, with its laws. No task is left on any rank, and no other thread looks at kernels.
 * Errors: memory; nothing has changed then. */
int task_kernel_add(struct task_graph *graph, const duite_kernel *kernel);

/* ---- Main thread, collective; the homes of all objects are settled ---- */

/* Mixes a value that is the same on all ranks into the fingerprint, if there are several ranks.
 * Forks, sets, frees and copies do so themselves. Once all of a call is mixed in, task_mixed enters
 * the call into the history. */
static inline void task_mix(struct task_graph *graph, uint64_t value)
{
    if (graph->n_ranks == 1)
        return;
    graph->fingerprint = task_fingerprint(graph->fingerprint, value);
}
static inline void task_mixed(struct task_graph *graph, enum comm_call_kind kind, uint32_t which)
{
    if (graph->n_ranks == 1)
        return;
    comm_history_add(graph->history, graph->fingerprint,
                     comm_call_bits(kind, which, graph->root.forks));
}
/* Does both for a fork on several ranks; `kind` tells whether it is recorded. */
static inline void task_mix_fork(struct task_graph *graph, uint64_t hash, enum comm_call_kind kind,
                                 uint32_t kernel)
{
    graph->fingerprint = task_fingerprint(graph->fingerprint, hash);
    comm_history_add(graph->history, graph->fingerprint,
                     comm_call_bits(kind, kernel, graph->root.forks));
}

/* ---- Main thread with the graph's root as scope: collective, the homes of all objects are
 * settled. Or a body with its own scope: local; the task forked runs here. ---- */

/* Overwrites the object with a copy of *count values, or with zeros if `values` is NULL; waits for
 * nothing. `count` NULL: the object's maximum. at: the rank whose values count, or TASK_ANYWHERE:
 * all have the same. Errors: objects, DUITE_E_SIZE, memory. */
int task_set_object(struct task_scope *scope, struct worker *worker, duite_object object, int at,
                    const void *values, const size_t *count);
/* The last value of an adopted object goes into the program's memory, which is then given back. */
int task_free_object(struct task_scope *scope, struct worker *worker, duite_object object);

/* The object, which is new, has the program's memory at its home, and its value. Errors: memory;
 * DUITE_E_ARGUMENT at home alone if that cannot be adopted: then the object is poisoned. */
int task_adopt(struct task_graph *graph, struct data_object *object, void *values, duite_done *done,
               void *user);

/* Starts copying an object to `copy` on rank `to`, or on all ranks with TASK_ANYWHERE. The caller
 * waits for copy->done on the ranks it goes to. Main thread only. */
int task_copy(struct task_graph *graph, struct worker *worker, duite_object object, int to,
              struct task_copy *copy);
/* The same without bytes, and without a transfer: copy->done is set once the value is there, or at
 * once on ranks that do not hold it. */
int task_await(struct task_graph *graph, struct worker *worker, duite_object object,
               struct task_copy *copy);
/* Combines the object's contributions, which an access that comes now would not be part of. Then
 * task_is_there tells whether the value is there, or another rank holds it. */
int task_close(struct task_graph *graph, struct worker *worker, duite_object object);
bool task_is_there(const struct task_graph *graph, duite_object object);

/* ---- Any worker ---- */

/* A task may run: goes to a worker, or is sent. task_place: the same for one that others than tasks
 * of this folder made ready, with its affinity (see duite_ready). */
void task_ready(struct task_graph *graph, struct worker *worker, struct task *task);
void task_place(struct task_graph *graph, struct worker *worker, struct task *task,
                uint32_t affinity);
/* For queues. */
queue_ranks_by task_rank;

/* Runs a ready task of one of this folder's types, which task_finish then ends; the workers know
 * who runs other types. `call` has context, rt, rank and worker set. Returns whether a body ran. */
bool task_run(struct task_graph *graph, struct worker *worker, struct task *task,
              const duite_call *call);
/* Ends a task: publishes its outputs, releases its inputs, makes its successors ready, frees it. */
void task_finish(struct task_graph *graph, struct worker *worker, struct task *task);

/* Fills the task's prepared parameters with the results of its body on another rank, or returns the
 * body's failure. */
typedef const struct data_failure *task_take_result(const struct task *task, duite_param *param,
                                                    struct data_packet *result);
/* Completes a task, a leaf, whose body ran on another rank: `take` fetches the results. The task
 * must then be finished. */
void task_run_result(struct task_graph *graph, struct task *task, task_take_result *take,
                     struct data_packet *result);

/* True once bodies no longer run. */
static inline bool task_has_given_up(const struct task_graph *graph)
{
    return atomic_load_explicit(&graph->given_up, memory_order_relaxed);
}

/* True if the task is to be sent now, by its type or by its state. */
static inline bool task_to_send(const struct task *task)
{
    return task->type == TASK_SEND || task->state == TASK_DELEGATED || task->state == TASK_LEAVES;
}

/* The task that the waiter is embedded in; only for a waiter that is a task's. */
static inline const struct task *task_who_waits(const struct data_waiter *waiter)
{
    return (const struct task *)(const void *)((const char *)waiter - waiter->back);
}

/* True if the communication runs the task. */
static inline bool task_is_channel(const struct task *task)
{
    return TASK_IS(task, TASK_TYPES_CHANNEL);
}

/* True if an object's home decided where the task, or its ancestor in the main program, runs. Then
 * *block is that object's. */
static inline bool task_follows(const struct task *task, uint32_t *block)
{
    const struct task_scope *scope = task->scope;
    *block = task->block;
    if (!scope->depth)
        return task->placed;
    while (scope->depth > 1)
        scope = scope->parent;
    *block = scope->block;
    return scope->placed;
}

/* The number of the main program's task, on any rank, that the task is or descends from. *nested:
 * it descends. */
uint64_t task_main_number(const struct task *task, bool *nested);

/* In traces: the number of a task without a body, and the name for a number. */
static inline uint32_t task_own_number(const struct task *task)
{
    return task->state == TASK_VOID ? TASK_TRACED_VOID : task->type;
}
const char *task_own_name(uint32_t number);

/* True if the task calls a body of the program. */
static inline bool task_has_body(const struct task *task)
{
    return (task->state == TASK_LOCAL || task->state == TASK_HELD) &&
           TASK_IS(task, TASK_TYPES_WITH_BODY);
}

/* A packet of pieces came for an expected sum. NULL: it will not come. The context of comm is the
 * graph. */
comm_arrived task_pieces_arrived;

/* The bytes that a ready task sends, under their key: letter->packet, or the version that a SEND
 * reads, as it lies. NULL without memory. */
struct data_packet *task_send_packet(struct comm_letter *letter);

/* Gives the object another home. The value that the forks so far leave goes there if the old home
 * holds it; the old home then frees it, since no other rank would. If the object has contributions,
 * its value stays until it is overwritten. No task is left on any rank. Main thread, collective.
 * Errors: memory. */
int task_move_object(struct task_graph *graph, struct worker *worker, struct data_object *object,
                     int home);

/* The version that the forks so far leave. Main thread; the object exists. */
struct data_key task_version_of(const struct task_graph *graph, duite_object object);

/* Sets the message of a failure; returns its code. */
int task_failure_error(const struct task_graph *graph, const struct data_failure *failure);

#pragma GCC visibility pop

#endif
