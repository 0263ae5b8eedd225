/* Nothing is kept here: what a test knows of its tasks it keeps itself. */
#include "tests/runtime/delegation.h"

#include "tests/negative/misuse.h"

#include <stdio.h>

duite *delegation_start(const duite_kernel *const *kernels, const char *balance)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite *rt = NULL;

    options.kernels = kernels;
    options.threads = 1;
    options.balance = duite_balancer_find(balance);
    if (duite_start(&rt, &options))
        printf("# %s\n", duite_message());
    return rt;
}

duite_object delegation_beside(duite *rt, duite_object leader)
{
    const duite_object object = misuse_new(rt, 1);

    duite_colocate(rt, object, leader);
    return object;
}

int32_t delegation_value(duite *rt, duite_object number)
{
    int32_t value = -1;

    duite_get(rt, number, &value);
    return value;
}

uint64_t delegation_count(duite *rt)
{
    duite_counters counters;

    duite_wait(rt);
    return duite_count_all(rt, &counters) ? 0 : counters.delegated;
}

void delegation_say(const char *balance, const char *what, int right)
{
    char name[100];

    snprintf(name, sizeof name, "%s: %s", balance, what);
    tap_case(right, name);
}
