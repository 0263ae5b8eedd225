#ifndef TESTS_RUNTIME_ROUNDS_RUN_H
#define TESTS_RUNTIME_ROUNDS_RUN_H

#include "runtime/plan/passes.h"

#include <duite_policy.h>

/* Rounds that run without a runtime. Values are numbers that tell what they were made of. The
 * reference runs the forks of a source one after the other. The nodes that the passes made for all
 * ranks run in random order, and rounds overlap. Each task must find the values that it found in
 * the reference. */

enum {
    ROUNDS = 3,
    ROUNDS_MAX = 64,       /* forks, and objects */
    ROUNDS_ACCESSES = 256, /* of all forks */
    MAX_RANKS = 16,
    PLACES = 1024,
    QUEUE = 256,
    PHASES = 64
};

struct reference {
    const struct plan_source *source;
    uint64_t value[ROUNDS_MAX];
    uint64_t open[ROUNDS_MAX][ROUNDS_ACCESSES];
    size_t n_open[ROUNDS_MAX];
    const duite_law *law[ROUNDS_MAX];
    uint64_t found[ROUNDS][ROUNDS_MAX]; /* by round and fork: of what it read */
};

struct rank {
    struct plan_round part;
    uint64_t value[PLACES];
    uint32_t *pending, *over; /* by node; over: rounds that it ran */
};

/* Messages on their way: values in order, see run_send. */
struct queue {
    uint64_t value[QUEUE];
    size_t first, last, messages;
};

struct run {
    const struct reference *reference;
    struct rank rank[MAX_RANKS];
    struct queue *queue[MAX_RANKS][MAX_RANKS]; /* by sender and phase of this receiver */
    int n_ranks;
    uint64_t random;
    size_t tasks;
};

static inline uint64_t draw(uint64_t *random, uint64_t below)
{
    return duite_random(random) % below;
}

/* The value of an object before the first round. */
uint64_t initial(uint32_t object);

/* Runs ROUNDS rounds of the source. */
void reference_run(struct reference *r, const struct plan_source *source);

/* Runs the parts of all ranks until none can go on; fails the test if a node ran less or more often
 * than so many rounds. */
void run_all(struct run *run, int rounds_of);

#endif
