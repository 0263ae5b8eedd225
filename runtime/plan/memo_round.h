#ifndef DUITE_PLAN_MEMO_ROUND_H
#define DUITE_PLAN_MEMO_ROUND_H

#include "runtime/plan/memo.h"
#include "runtime/plan/plan.h"

#include <string.h>

/* The watch, recognised rounds and their plans, for memo.c and memo_round.c alone. */

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
    uint64_t since;                /* where this state began */
    struct plan_memo_round *found; /* MEMO_SEEK: its round */
    struct plan_record *record;    /* MEMO_RECORD */
    uint64_t openings;
    uint64_t tasks, rounds; /* of closed replays */
    struct plan_memo_round rounds_kept[MEMO_PLANS];
    uint32_t hash[MEMO_HISTORY];
};

/* Returns whether this is the expected fork. */
static inline bool memo_is_step(const struct plan_memo_step *step, const duite_kernel *kernel,
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

/* The round with that key and so many forks, or NULL. */
struct plan_memo_round *memo_round_find(struct plan_memo *memo, uint64_t key, size_t n);
/* Records a fork before it is made. False: not recognisable, or no memory. */
bool memo_round_add(struct plan_memo *memo, const duite_kernel *kernel, const void *args, size_t n,
                    const duite_object *objects);
/* Takes over memo->record and compiles it, in place of the least recently used round. NULL: all
 * rounds are in use, no plan is possible, or no memory. */
struct plan_memo_round *memo_round_make(struct plan_memo *memo, uint64_t key);
/* Returns whether no replay of it goes on. */
bool memo_round_is_idle(const struct plan_memo_round *round);
/* Opens a replay of an idle round; the next fork is its first. False: an object is gone, or no
 * memory. */
bool memo_round_open(struct plan_memo *memo, struct plan_memo_round *round);
/* Frees all but the gate. */
void memo_round_free(struct plan_memo_round *round, struct worker *worker);

#endif
