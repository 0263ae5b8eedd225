#ifndef DUITE_BALANCE_BALANCE_H
#define DUITE_BALANCE_BALANCE_H

#include "runtime/base/policy.h"

#include <duite_policy.h>
#include <stdbool.h>

/* The built-in balancers. A balancer is a table and one row here; the first is the default. */
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

/* The names of those for tests, ended by NULL. */
const char *const *balance_test_names(void);

/* All of them. */
extern const struct base_policies balance_policies;

#endif
