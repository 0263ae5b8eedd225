/* none: every task runs where the owner rule says, and no rank requests tasks of another. */
#include "runtime/balance/balance.h"

const duite_balancer balance_none = {
    .name = "none",
    .summary = "tasks run where the objects they write live",
};
