#ifndef DUITE_POLICY_H
#define DUITE_POLICY_H

/* For authors of schedulers, mappings and balancers: the tables of functions that the runtime
 * calls. The built-in policies use exactly these. A policy only decides; the runtime owns queues,
 * stealing, sleep, wake-up and messages. Functions of a table take no locks, read no clock, and
 * draw random numbers only from their own state.
 *
 * A function that does not return: the run waits for it. Once nothing else of its rank has moved
 * for options.stuck_seconds (60 s; 0: never) the report of a standstill (duite.h) names the policy,
 * the function, rank and worker. The function is not broken off; when it returns the run goes on.
 * Built-in policies are not named.
 *
 * A table begins with its size, sizeof(duite_scheduler) and the like. duite_start refuses one of
 * another size, as of a policy that was compiled with another version of this header.
 *
 * In a run, a function of a policy that is not built in and calls exit ends the process with
 * EXIT_FAILURE, whatever status it asked for, and standard error names the policy and the function.
 */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Schedulers: which worker, which task next ---- */

/* Queues: one per worker, numbered like the workers, and one shared by all. */
#define DUITE_SHARED_QUEUE 0xfffffffeu
#define DUITE_NO_QUEUE     0xffffffffu

/* The end of a queue from which the next task is taken. */
typedef enum duite_end {
    DUITE_NEWEST,
    DUITE_OLDEST,
    DUITE_HIGHEST /* largest priority first; of equals the longest path, then the oldest */
} duite_end;

/* A task that became ready. */
typedef struct duite_ready {
    const char *kernel; /* its kernel's name */
    uint64_t number;    /* its place in fork order */
    /* The block of the first object it writes (w, rw), else of the first it reads. A home numbers
     * its objects without leader from 0, in the order they were made; followers (duite_colocate)
     * have their leader's block. For a task that only accumulates: its place in fork order. */
    uint32_t block;
    /* As given at the fork (duite_task_options), else 0. The runtime's own tasks (sums, copies for
     * duite_get), which are short and awaited, have the priority INT32_MAX. */
    int32_t priority;
    double cost; /* seconds; 0: not given */
    /* For a task of the program in a replay, if the scheduler sets `paths`: seconds of given costs
     * on the longest path from its begin to the round's end. A fork without a cost counts as their
     * mean, or as 1 if none has one. Else 0. */
    double path;
    /* Affinity of a task of the program in a replay: 1 plus the number of the worker whose core's
     * caches may have the data. That worker ran the graph's last task placed by the same object, in
     * 2 microseconds or more. 0: it took less, there was none, or no object places this task. */
    uint32_t affinity;
} duite_ready;

/* The other workers as seen by one worker. */
typedef struct duite_near {
    unsigned n;               /* number of the others */
    const unsigned *worker;   /* n: nearest first, equally near ones from the next number on */
    const unsigned *distance; /* n: levels of the machine's topology (cores, caches, packages, as
                                 hwloc sees them) from the two cores to the part they share; 0 if
                                 workers are not bound to cores */
} duite_near;

/* A scheduler decides which worker runs which task next. */
typedef struct duite_scheduler {
    size_t size; /* sizeof(duite_scheduler) */
    const char *name;
    const char *summary;
    size_t state_size; /* bytes of private state a worker, at most 2^30; zeroed before start; used
                          by that worker only */

    /* Prepares the state of one worker. Optional. */
    void (*start)(void *state, unsigned worker, unsigned n_workers, uint64_t seed);
    /* The queue for a task that became ready on this worker. */
    unsigned (*place)(void *state, const duite_ready *task);
    /* The order in which a worker serves its own queue and the shared one; may change each time. */
    duite_end (*serve)(void *state);
    /* The queue from which an idle worker steals at its attempt-th try in a row (0, 1, ...). It
     * takes the oldest task there, or the highest if that queue's worker serves by priority.
     * DUITE_NO_QUEUE ends the round, and the worker idles for a moment. Its own queue and the
     * shared one were empty before attempt 0; they are always served, so that a policy cannot lose
     * a task. The runtime ends a round after 64 tries plus 16 per worker, an error that the next
     * duite_wait returns. */
    unsigned (*victim)(void *state, unsigned attempt);
    /* Returns whether a task that just became ready may run inline: directly after the task that
     * made it ready, on the same worker. Such tasks form a chain, counted by
     * duite_counters.chained. */
    int (*chain)(void *state, const duite_ready *task);
    /* Called after start with this worker's place; `near` lives as long as the state. Optional. */
    void (*locate)(void *state, const duite_near *near);
    int paths; /* 1: wants duite_ready.path, which makes compiling a graph slower */
} duite_scheduler;

/* ---- Mappings: which rank keeps an object ---- */

/* The objects to map: a graph in compressed rows, symmetric, with the program's hints. */
typedef struct duite_object_graph {
    size_t n;                  /* objects, in the order they were made */
    uint64_t before;           /* objects mapped before these */
    const double *weight;      /* n: share of the work */
    const size_t *start;       /* n + 1 */
    const uint32_t *neighbour; /* start[n] */
    const double *edge_weight; /* start[n] */
} duite_object_graph;

#define DUITE_NO_BLOCK 0xffffffffu

/* One round of a recorded graph as a graph of tasks, and the blocks of objects (a leader and its
 * followers) that they run for. */
typedef struct duite_task_graph {
    size_t n; /* tasks in fork order, including sets and the runtime's sums */
    /* n: seconds. Known costs are given at the fork or, from the graph's second replay on, this
     * task's share of its block's measured time. Others are the mean of the known ones, or 1
     * microsecond. 0 for tasks that the runtime adds. */
    const double *cost;
    const uint32_t *block; /* n: it runs where this block lives; DUITE_NO_BLOCK: on the rank that
                              its fork named, or everywhere */
    const size_t *start;   /* n + 1 */
    const uint32_t *from;  /* start[n]: row i has the tasks whose results task i reads: earlier ones
                              (< i) of the same round, others (>= i) of the previous round */
    const double *bytes;   /* start[n]: bytes that it reads */
    size_t n_blocks;
    const unsigned char *fixed; /* n_blocks: 1: it must keep its home, see duite_kernel.fixed */
    int n_ranks;
    const unsigned *workers;              /* a rank */
    double byte_seconds, message_seconds; /* per byte, per message to a rank; measured at start */
    uint64_t seed;
} duite_task_graph;

/* A mapping decides which rank keeps an object. */
typedef struct duite_mapping {
    size_t size; /* sizeof(duite_mapping) */
    const char *name;
    const char *summary;
    /* Writes home[n], each in 0 .. n_ranks - 1. Must be deterministic: every rank calls it with the
     * same graph. If two ranks get different homes, the next blocking call that depends on them, at
     * the latest duite_wait or duite_stop, returns DUITE_E_DIFFERENT. Returns 0, or a duite code.
     * The next get, wait or stop of every rank then returns the code and names the mapping and, on
     * the other ranks, the rank; only duite_stop is left. */
    int (*map)(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home);
    /* Maps blocks again, now that the tasks are known. home[n_blocks] has the present homes; blocks
     * whose home it changes move. Called at the beginning of the first replay of each graph. Called
     * again at the second, with measured costs, unless all forks of its kernels gave a cost. Runs
     * on rank 0 only and need not be deterministic. Returns 0, or a duite code. Optional. */
    int (*map_tasks)(const duite_task_graph *graph, int *home);
} duite_mapping;

/* ---- Balancers: which ready tasks run on another rank, and which objects move there ---- */

/* A ready task that may run on any rank, with all its descendants: to its home it is a leaf. The
 * main program forked it, or a task that runs here, of this rank or of another. Its fork named no
 * rank, and its kernel is not fixed (duite_kernel.fixed) and has no side effects. All that it and
 * its children read is here and travels there; their results travel back. */
typedef struct duite_leaf {
    const char *kernel;
    uint64_t number; /* its place in fork order */
    double cost;  /* seconds as given at the fork, else of its kernel's bodies on this rank, later
                     ones counting more. 0: no body ran yet, or a task that forks was given none */
    size_t bytes; /* that travel there and back */
    double transfer; /* seconds that this takes, by a measurement at start */
    int forks;       /* 1: has postponed parameters, and `cost` includes its descendants */
} duite_leaf;

/* A rank that asks for tasks, and the tasks here. */
typedef struct duite_request {
    int rank;         /* the rank that asks */
    unsigned idle;    /* idle workers there */
    unsigned ready;   /* tasks, leaves or not, found ready here when the request was served */
    unsigned granted; /* of them to this rank, so far */
    unsigned unknown; /* of those granted: tasks that fork, whose cost is 0. Such tasks are offered
                         oldest first among all ready tasks; others are also offered when they
                         become ready. */
} duite_request;

#define DUITE_NO_RANK (-1)

/* Blocks are objects that live together, a leader and its followers (duite_colocate), with
 * measurements since the balancer was last asked to move them. */
typedef struct duite_blocks {
    /* n blocks, in the order in which they were made. weight: seconds in the bodies of tasks that
     * ran for the block, with their children. edge_weight: bytes that recorded tasks of one block
     * read of the other, in all rounds since the last time. */
    duite_object_graph graph;
    const size_t *bytes;        /* n: of all its objects, which move with it */
    const unsigned char *fixed; /* n: 1: it must keep its home, see duite_kernel.fixed */
    int n_ranks;
    const double *other;          /* a rank: seconds in all other bodies */
    const unsigned *workers;      /* a rank */
    double byte_seconds;          /* per byte to another rank, measured at start */
    double seconds;               /* since the last time */
    double migrate_seconds;       /* of the last decision and move, all ranks waiting; 0 at first */
    uint64_t replays, since;      /* since start; since the last time */
    const duite_mapping *mapping; /* the program's */
    uint64_t seed;
} duite_blocks;

/* A balancer decides which ready tasks run on another rank, and which objects move there. */
typedef struct duite_balancer {
    size_t size; /* sizeof(duite_balancer) */
    const char *name;
    const char *summary;
    size_t state_size; /* bytes of private state a worker, at most 2^30; zeroed before start; used
                          by that worker only */

    /* Prepares the state of one worker. All functions are optional; without any of them nothing
     * moves. */
    void (*start)(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed);
    /* Returns the rank to ask for tasks, or DUITE_NO_RANK for none now, when this rank has nothing
     * to do for the attempt-th time in a row (0, 1, ...). `granter` is the rank that granted a leaf
     * last, or DUITE_NO_RANK. The request stands for *seconds; until then it asks no other rank. */
    int (*victim)(void *state, unsigned attempt, int granter, double *seconds);
    /* Returns whether the leaf goes to the rank that requests tasks. Needed with victim. */
    int (*grant)(void *state, const duite_request *request, const duite_leaf *leaf);
    /* Returns the rank on which a leaf that just became ready runs, requested or not; this rank:
     * here. */
    int (*place)(void *state, const duite_leaf *leaf);
    /* Moves blocks: home[n] has their homes; blocks whose home it changes move, with all their
     * objects, before the replay that is about to begin. Returns the number of replays until the
     * next call (1: at the next; 0: never). The first call comes at the program's second replay,
     * when all tasks forked before are over on all ranks. It runs on rank 0 only, with the state of
     * worker 0, and need not be deterministic. */
    uint64_t (*migrate)(void *state, const duite_blocks *blocks, int *home);
} duite_balancer;

/* ---- Policies of one's own ---- */

/* A program may point its options at tables of its own. A policy's name with a / in it, such as
 * ./mine.so, loads a shared library that defines one of these (duite_scheduler_find and its like;
 * duite-cloth --scheduler ./mine.so). */
extern const duite_scheduler duite_own_scheduler;
extern const duite_mapping duite_own_mapping;
extern const duite_balancer duite_own_balancer;

/* A random number and the next state, by SplitMix64 (Steele, Lea, Flood 2014). Any state is a good
 * seed. Local. Returns: the number. */
static inline uint64_t duite_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

#ifdef __cplusplus
}
#endif

#endif
