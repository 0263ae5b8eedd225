#ifndef DUITE_BALANCE_BALANCE_H
#define DUITE_BALANCE_BALANCE_H

#include <duite_policy.h>
#include <stdbool.h>

/* The built-in balancers. A balancer is one file, which defines its table, and one row here; the
 * first is the default. */
#define BALANCE_ROWS(ROW)                                                                          \
    ROW(none)                                                                                      \
    ROW(delegate)                                                                                  \
    ROW(migrate)
/* Adversaries for tests: programs may name them, but no list of all has them. */
#define BALANCE_TEST_ROWS(ROW)                                                                     \
    ROW(scatter)                                                                                   \
    ROW(wander)

#define BALANCE_DECLARE(name) extern const duite_balancer balance_##name;
BALANCE_ROWS(BALANCE_DECLARE)
BALANCE_TEST_ROWS(BALANCE_DECLARE)

/* The state of those that choose at random: numbers of its own for each worker. */
struct balance_chance {
    uint64_t random;
    int rank, n_ranks;
};
void balance_start_chance(void *state, int rank, int n_ranks, unsigned worker, uint64_t seed);

/* A rank from 0 to n - 1. */
int balance_draw(struct balance_chance *own, int n);

/* The names of those for tests, ended by NULL. */
const char *const *balance_test_names(void);

/* True if the balancer is not built in. */
bool balance_is_foreign(const duite_balancer *balancer);

#endif
