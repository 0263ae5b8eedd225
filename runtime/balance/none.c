/* none: every task runs where the owner rule says, and no rank asks another for work. */
#include "runtime/balance/balance.h"

const duite_balancer balance_none = {
    .name = "none",
    .summary = "tasks run where the objects they write live",
};
