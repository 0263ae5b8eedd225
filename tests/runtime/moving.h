#ifndef TESTS_RUNTIME_MOVING_H
#define TESTS_RUNTIME_MOVING_H

#include "tests/negative/misuse.h"

#include <duite_policy.h>
#include <stdatomic.h>

/* Shared by the tests of migration: a balancer that obeys the test, kernels, and graphs of one
 * fork. */

enum {
    STAY = -1,
    NEXT = -2,
    WRONG = -3,
    FORCED = -4
}; /* or a rank to which all blocks are to go */

enum { MOVING_BLOCKS = 64, MOVING_RANKS = 16 };

extern int wanted;
extern atomic_int ran; /* bodies of STEP and STAYS, here */

/* The last sight of the balancer; on rank 0. */
extern struct moving_seen {
    int calls;
    duite_blocks blocks; /* of which the arrays are gone */
    double weight[MOVING_BLOCKS], other[MOVING_RANKS], edge[MOVING_BLOCKS][MOVING_BLOCKS];
    size_t bytes[MOVING_BLOCKS];
    unsigned char fixed[MOVING_BLOCKS];
    int home[MOVING_BLOCKS];
} seen;

extern const duite_balancer TOLD;

/* STEP and STAYS add to an object what they read and 1. DOZE takes 2 ms, PARENT forks it on its
 * second object. THIRD contributes 1 / its argument; COUNTDOWN, replicated,
 * subtracts 1. */
extern const duite_kernel STEP, STAYS, DOZE, PARENT, THIRD, COUNTDOWN;

/* Starts with all of these, GROW, SET and FAIL, objects dealt out one after the other. */
duite *moving_start(const duite_balancer *balancer);

/* A graph of `tasks` forks of a kernel on n objects. */
struct things {
    duite_object object[4];
    const duite_kernel *kernel;
    int at; /* -1: by the owner rule */
    int n, tasks;
};
duite_graph moving_record(duite *rt, struct things things);

/* Records a graph of nothing and replays it once: the first replay of all asks nobody. */
duite_graph moving_begin(duite *rt);
/* Replays it, and with that moves what is wanted. Returns the replay's code. */
int moving(duite *rt, duite_graph nothing, int where);
/* Frees the graph; stops, which is a case. */
void moving_end(duite *rt, duite_graph nothing, const char *name);

/* The first element; -2: there was an error. */
int value_of(duite *rt, duite_object object);
/* Objects so far. */
uint64_t migrated(duite *rt);

#endif
