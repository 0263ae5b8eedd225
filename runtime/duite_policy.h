#ifndef DUITE_POLICY_H
#define DUITE_POLICY_H

/* For authors of schedulers, mappings and balancers: the tables of functions that the runtime asks.
 * The built-in policies use exactly these. A policy decides; the runtime owns queues, stealing,
 * sleep, wake-up and messages. Functions of a table take no locks, read no clock, and draw random
 * numbers only from their own state.
 *
 * A function that does not return: the run waits for it. Once nothing else of its rank has moved
 * for options.stuck_seconds (60 s; 0: never) the report of a standstill (duite.h) names the policy,
 * the function, rank and worker. The function is not broken off; when it returns the run goes on.
 * Built-in policies are not named.
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

/* Queues: one a worker, numbered like the workers, and one that all share. */
#define DUITE_SHARED_QUEUE 0xfffffffeu
#define DUITE_NO_QUEUE     0xffffffffu

/* Which task of a queue is taken next. */
typedef enum duite_end {
    DUITE_NEWEST,
    DUITE_OLDEST,
    DUITE_HIGHEST /* the one with the largest priority; of equals the one with the longest path, of
                     these the oldest */
} duite_end;

/* A task that became ready. */
typedef struct duite_ready {
    const char *kernel; /* its kernel's name */
    uint64_t number;    /* its place in fork order */
    /* What its data belong to: the block of the first object it writes (w, rw), else of the first
     * it reads. Objects without leader are numbered on their home in the order they were made, from
     * 0; those that follow one (duite_colocate) are of its block. Of a task that only accumulates:
     * its place in fork order. */
    uint32_t block;
    /* As given at the fork (duite_task_options), else 0. Tasks of the runtime itself (sums, copies
     * for duite_get), which are short and waited for, have the priority INT32_MAX. */
    int32_t priority;
    double cost; /* seconds; 0: not said */
    /* Of a task of the program in a replay, if the scheduler asks for it (`paths`): the longest
     * path from its begin to the end of the round, in seconds of the costs that forks said. A fork
     * that said none counts as their mean, or as 1 if none did. Else 0. */
    double path;
    /* Affinity, of a task of the program in a replay: 1 plus the number of the worker whose core's
     * caches may have the data. That is the worker that ran the graph's last task placed by the
     * same object, if that task took 2 microseconds or more. 0: it took less, there was none, or no
     * object places this task. */
    uint32_t affinity;
} duite_ready;

/* The other workers as one of them sees them. */
typedef struct duite_near {
    unsigned n;               /* how many others there are */
    const unsigned *worker;   /* n: nearest first, equally near ones from the next number on */
    const unsigned *distance; /* n: how many levels of the machine's topology (cores, caches,
                                 packages, as hwloc sees them) lie between the cores of the two and
                                 what they share; 0 where workers are not bound to cores */
} duite_near;

typedef struct duite_scheduler {
    const char *name;
    const char *summary;
    size_t state_size; /* bytes of private state a worker, at most 2^30; zeroed before start; used
                          by that worker only */

    /* Prepares the state of one worker. Optional. */
    void (*start)(void *state, unsigned worker, unsigned n_workers, uint64_t seed);
    /* The queue a task goes to that became ready on this worker. */
    unsigned (*place)(void *state, const duite_ready *task);
    /* In which order a worker serves its own queue and the shared one; it may answer differently
     * each time. */
    duite_end (*serve)(void *state);
    /* Whose queue an idle worker steals from at its attempt-th try in a row (0, 1, ...). It takes
     * the oldest task there, or the highest if that queue's worker serves by priority.
     * DUITE_NO_QUEUE ends the round, and the worker idles for a moment. Its own queue and the
     * shared one were found empty before attempt 0; they are always served, so that a policy cannot
     * lose a task. A round without an end is ended after 64 tries and 16 for each worker, and is an
     * error that the next duite_wait returns. */
    unsigned (*victim)(void *state, unsigned attempt);
    /* Whether a task that just became ready may run inline: directly after the task that made it
     * ready, on the same worker. Such tasks form a chain, hence the name, and
     * duite_counters.chained. */
    int (*chain)(void *state, const duite_ready *task);
    /* After start: where this worker is; `near` is alive as long as the state. Optional. */
    void (*locate)(void *state, const duite_near *near);
    int paths; /* 1: duite_ready.path is wanted, which costs time when a graph is compiled */
} duite_scheduler;

/* ---- Mappings: which rank keeps an object ---- */

/* The objects to map: a graph in compressed rows, symmetric, with the program's hints. */
typedef struct duite_object_graph {
    size_t n;                  /* objects, in the order they were made */
    uint64_t before;           /* objects that were mapped before these */
    const double *weight;      /* n: share of the work */
    const size_t *start;       /* n + 1 */
    const uint32_t *neighbour; /* start[n] */
    const double *edge_weight; /* start[n] */
} duite_object_graph;

#define DUITE_NO_BLOCK 0xffffffffu

/* One round of a recorded graph as a graph of tasks, and the blocks of objects (a leader and those
 * that follow it) that they run for. */
typedef struct duite_task_graph {
    size_t n; /* tasks in fork order, those that the runtime adds (sums, sets) among them */
    /* n: seconds, as the fork said; else, from the graph's second replay on, this task's share of
     * what was measured for its block; else the mean of those that are known, or 1 microsecond.
     * 0 of what the runtime adds. */
    const double *cost;
    const uint32_t *block; /* n: it runs where this block lives; DUITE_NO_BLOCK: on the rank that
                              its fork named, or everywhere */
    const size_t *start;   /* n + 1 */
    const uint32_t *from;  /* start[n]: row i has the tasks whose results task i reads: an earlier
                              one (< i) of the same round, or any other (>= i) of the round before */
    const double *bytes;   /* start[n]: what it reads of it */
    size_t n_blocks;
    const unsigned char *fixed; /* n_blocks: 1: it must keep its home, see duite_kernel.fixed */
    int n_ranks;
    const unsigned *workers;              /* a rank */
    double byte_seconds, message_seconds; /* a byte, and a message, from rank to rank, after a
                                             measurement at start */
    uint64_t seed;
} duite_task_graph;

typedef struct duite_mapping {
    const char *name;
    const char *summary;
    /* Writes home[n], each in 0 .. n_ranks - 1. Deterministic: called with the same graph on every
     * rank; where two ranks got different homes, the next blocking call that depends on them, at
     * the latest duite_wait or duite_stop, is DUITE_E_DIFFERENT. Returns 0, or a duite code: then
     * the next get, wait or stop of every rank returns it and names the mapping and, on the other
     * ranks, the rank; only duite_stop is left. */
    int (*map)(const duite_object_graph *graph, int n_ranks, uint64_t seed, int *home);
    /* Maps blocks again, now that the tasks are known. home[n_blocks] has the present homes; blocks
     * whose home is changed move. Asked at the beginning of the first replay of each graph, and,
     * unless all forks of its kernels said what they cost, once more at its second one, with
     * measured costs. On rank 0 only, and need not be deterministic. Returns 0, or a duite code.
     * Optional. */
    int (*map_tasks)(const duite_task_graph *graph, int *home);
} duite_mapping;

/* ---- Balancers: which ready tasks run on another rank, and which objects move there ---- */

/* A ready task that may run on any rank, with all that it forks: to its home it is a leaf, whatever
 * grows there. The main program forked it, or a task that runs here, of this rank or of another.
 * Its fork named no rank, and its kernel is not fixed (duite_kernel.fixed) and has no side effects.
 * What it and its children read is here, and travels there; what they leave travels back. */
typedef struct duite_leaf {
    const char *kernel;
    uint64_t number; /* its place in fork order */
    double cost;     /* seconds: as the fork said, else what bodies of its kernel took on this rank,
                        the later ones counting more; 0: none ran yet, or the fork of a task that
                        forks did not say */
    size_t bytes;    /* that travel there and back */
    double transfer; /* seconds that this takes, after a measurement at start */
    int forks;       /* 1: parameters are postponed, and `cost` is of all that it forks, too */
} duite_leaf;

/* A rank that asks for tasks, and what there is here. */
typedef struct duite_request {
    int rank;         /* who asks */
    unsigned idle;    /* workers there that have nothing to do */
    unsigned ready;   /* tasks, leaves or not, that were ready here and found when it was served */
    unsigned granted; /* of them to this rank, so far */
    unsigned unknown; /* of those granted: tasks that fork, whose cost is 0. Such a task is offered
                         in its turn among all that are ready, those first that have been for
                         longest; others are offered as they become ready, too. */
} duite_request;

#define DUITE_NO_RANK (-1)

/* Blocks: objects that live together, a leader and those that follow it (duite_colocate); and what
 * was measured since the last time that the balancer was asked to move them. */
typedef struct duite_blocks {
    /* n blocks, in the order in which they were made. weight: seconds in the bodies of tasks that
     * ran for the block, with their children. edge_weight: bytes that recorded tasks which run for
     * one block read of the other, in all rounds since the last time. */
    duite_object_graph graph;
    const size_t *bytes;        /* n: of all its objects, which move with it */
    const unsigned char *fixed; /* n: 1: it must keep its home, see duite_kernel.fixed */
    int n_ranks;
    const double *other;     /* a rank: seconds in all other bodies */
    const unsigned *workers; /* a rank */
    double byte_seconds;     /* a byte to another rank, after a measurement at start */
    double seconds;          /* since the last time */
    double migrate_seconds;  /* that deciding and moving took the last time, all ranks waiting; 0 at
                                first */
    uint64_t replays, since; /* since start; since the last time */
    const duite_mapping *mapping; /* the program's */
    uint64_t seed;
} duite_blocks;

typedef struct duite_balancer {
    const char *name;
    const char *summary;
    size_t state_size; /* bytes of private state a worker, at most 2^30; zeroed before start; used
                          by that worker only */

    /* Prepares the state of one worker. Optional, as are the others; without any of them nothing
     * moves. */
    void (*start)(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed);
    /* This rank has nothing to do, for the attempt-th time in a row (0, 1, ...): the rank to ask
     * for tasks, or DUITE_NO_RANK: none now. `granter` is the rank that granted a leaf last, or
     * DUITE_NO_RANK. *seconds: how long the request stands; until then no other rank is asked. */
    int (*victim)(void *state, unsigned attempt, int granter, double *seconds);
    /* Whether the leaf goes to the rank that requests tasks. Needed with victim. */
    int (*grant)(void *state, const duite_request *request, const duite_leaf *leaf);
    /* The rank on which a leaf that just became ready runs, requested or not; the own one: here. */
    int (*place)(void *state, const duite_leaf *leaf);
    /* Moves blocks: home[n] has their homes, and those that are changed move, with all their
     * objects, before the replay that is about to begin. Returns after how many replays to ask
     * again (1: at the next; 0: never). It is asked for the first time at the second replay of the
     * program, when all tasks forked before are over on all ranks. It is asked on rank 0 only, with
     * the state of worker 0, and need not be deterministic. */
    uint64_t (*migrate)(void *state, const duite_blocks *blocks, int *home);
} duite_balancer;

/* ---- Policies of one's own ---- */

/* A program may point its options at tables of its own. A shared library that defines one of these
 * is loaded where a policy's name is asked for: ./mine.so, any name with a / in it
 * (duite_scheduler_find and its like; duite-cloth --scheduler ./mine.so). */
extern const duite_scheduler duite_own_scheduler;
extern const duite_mapping duite_own_mapping;
extern const duite_balancer duite_own_balancer;

/* A random number and the next state (SplitMix64: Steele, Lea, Flood 2014). Any state is a good
 * seed. */
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
