#ifndef DUITE_PLAN_MEMO_H
#define DUITE_PLAN_MEMO_H

#include "runtime/plan/plan.h"

#include <pthread.h>
#include <string.h>

/* Repeated forks are recognised: if a main program forks the same tasks round after round,
 * arguments aside, they are replayed without being asked for. Bytes, failures, numbers and windows
 * stay the same. Main thread of a runtime of one rank.
 *
 * Each fork is hashed (kernel and objects). When the last forks repeat those before them, and
 * bodies are short, the next round is recorded while it is forked, and a thread compiles it to a
 * plan. Then each fork that is the expected one becomes a run of its node, in an open replay. Any
 * other fork or call closes that. Only forks without options, of plain kernels that write
 * something, on objects of fixed size are recognised. */

enum {
    MEMO_HISTORY = 2 * PLAN_OPEN_MAX, /* hashes kept; a power of 2 */
    MEMO_HASHED = 16,                 /* max. objects of a fork; a larger fork resembles no other */
    MEMO_ANCHORS = 8,
    MEMO_PLANS = 8
};

/* A fork of a round. */
struct plan_memo_step {
    const duite_kernel *kernel;
    size_t n, bytes, args; /* objects; bytes of arguments and their place in a round's */
    const struct plan_memo_step *next; /* the last one's: the first */
    duite_object object[];
};

/* A round that was recognised. */
struct plan_memo_round {
    struct plan_record *record;   /* with its plan; NULL: free */
    struct plan_memo_step *first; /* contiguous */
    uint32_t *hash;               /* of each fork */
    uint64_t key;                 /* of the hashes, whichever fork is first */
    size_t n;
    uint64_t used;          /* its last opening, by number */
    struct plan_gate *gate; /* outlives the round, see plan_gate */
    pthread_t thread;       /* compiles the plan */
    bool compiles;          /* the thread is not joined yet */
    _Atomic int made;       /* 1: the plan is there; -1: it failed */
};

enum plan_memo_state { MEMO_WATCH, MEMO_RECORD, MEMO_SEEK };

struct plan_memo {
    struct task_graph *graph;
    struct worker *worker;
    /* The open replay. */
    const struct plan_memo_step *step; /* the expected fork; NULL: no replay is open */
    struct plan *plan;
    unsigned char *args;         /* of this round */
    uint32_t at;                 /* the node of `step` */
    uint64_t round, room, first; /* rounds forked; with room for arguments; first task */
    uint64_t tasks, rounds;      /* recognised, in closed replays */
    /* The watch. */
    uint64_t skip;       /* forks still to be ignored */
    uint64_t begin, pos; /* the history has the forks from `begin` on; next fork */
    uint64_t due;        /* each fork from this one on is looked at */
    uint32_t anchor;     /* each fork with this hash is looked at, too */
    uint32_t n_anchors;
    uint64_t anchored[MEMO_ANCHORS]; /* its forks, newest first */
    uint64_t spent;                  /* comparisons since `begin` */
    uint64_t penalty;                /* forks to skip after the next failure */
    bool always;                     /* see plan_memo_new */
    uint64_t bodies;                 /* run at the last look */
    double seconds, mean;            /* of those bodies; of a recent body */
    enum plan_memo_state state;
    size_t period;
    uint64_t since, seen; /* where this state began; MEMO_SEEK: forks from there to the last begin
                             of the round */
    struct plan_memo_round *found; /* MEMO_SEEK: its round */
    struct plan_record *record;    /* MEMO_RECORD */
    uint64_t openings;
    struct plan_memo_round rounds_kept[MEMO_PLANS];
    uint32_t hash[MEMO_HISTORY];
};

/* Always: replays even long bodies, and compiles plans at once. NULL without memory. */
struct plan_memo *plan_memo_new(struct task_graph *graph, struct worker *worker, bool always);
/* Only once no task is left; NULL is fine. */
void plan_memo_free(struct plan_memo *memo);

/* Another call than the expected fork: closes an open replay and begins the history again. */
void plan_memo_break(struct plan_memo *memo);

/* Part of plan_memo_fork, for a fork that may end a period or is to be recorded. True: the fork is
 * made. */
bool plan_memo_look(struct plan_memo *memo, uint32_t hash, const duite_kernel *kernel,
                    const void *args, size_t n, const duite_object *objects);
/* A round was forked: makes room for the arguments of the next one, or closes the replay. */
void plan_memo_next_round(struct plan_memo *memo);

static inline uint32_t plan_memo_hash(const struct plan_memo *memo, const duite_kernel *kernel,
                                      size_t n, const duite_object *objects)
{
    const bool hashed = n <= MEMO_HASHED && (objects || !n);
    return (uint32_t)((hashed ? task_fork_hash_all((uintptr_t)kernel, n, objects)
                              : task_fork_hash(memo->pos)) >>
                      32);
}

static inline bool plan_memo_is_step(const struct plan_memo_step *step, const duite_kernel *kernel,
                                     const void *args, size_t n, const duite_object *objects)
{
    if (step->kernel != kernel || step->n != n || !task_args_fit(args, step->bytes) || !objects)
        return false;
    uint64_t different = 0;
    for (size_t i = 0; i < n; i++)
        different |= (uint64_t)(step->object[i].slot ^ objects[i].slot) |
                     (step->object[i].generation ^ objects[i].generation);
    return !different;
}

/* The expected fork becomes the next run of its node. */
static inline void plan_memo_take(struct plan_memo *memo, const struct plan_memo_step *step,
                                  const void *args)
{
    const uint32_t at = memo->at;
    if (step->bytes)
        memcpy(memo->args + step->args, args, step->bytes);
    plan_forked(memo->plan, memo->worker, at);
    memo->step = step->next;
    memo->at = at + 1;
    if (memo->at == memo->plan->n_calls)
        plan_memo_next_round(memo);
}

/* A fork without options by the main program, outside builds and with homes settled. True: the fork
 * is made. False: the caller makes it. */
static inline bool plan_memo_fork(struct plan_memo *memo, const duite_kernel *kernel,
                                  const void *args, size_t n, const duite_object *objects)
{
    const struct plan_memo_step *step = memo->step;
    if (step) {
        if (plan_memo_is_step(step, kernel, args, n, objects)) {
            plan_memo_take(memo, step, args);
            return true;
        }
        plan_memo_break(memo);
    }
    if (memo->skip) {
        memo->skip--;
        return false;
    }
    const uint32_t hash = plan_memo_hash(memo, kernel, n, objects);
    memo->hash[memo->pos++ % MEMO_HISTORY] = hash;
    if (hash != memo->anchor && memo->pos <= memo->due)
        return false;
    return plan_memo_look(memo, hash, kernel, args, n, objects);
}

#endif
