/* This file keeps nothing: each test keeps its own knowledge of its tasks. */
#include "tests/runtime/delegation.h"

#include "tests/negative/misuse.h"

#include <stdio.h>
#include <string.h>

static atomic_int mixed; /* on this rank */

KERNEL_SHARED(MIX, "mix", .access = {DUITE_R, DUITE_RW, DUITE_W, DUITE_CW},
              .args_size = sizeof(int32_t))
{
    const int32_t add = *(const int32_t *)call->args;
    atomic_fetch_add(&mixed, 1);
    for (size_t i = 0; i < duite_count(call, 0); i++) {
        duite_out(call, 1, int32_t)[i] += duite_in(call, 0, int32_t)[i] + add;
        duite_out(call, 2, int32_t)[i] = add;
        duite_out(call, 3, int32_t)[i] += add;
    }
    return 0;
}

KERNEL_SHARED(GROW, "grow", .access = {DUITE_RW})
{
    const size_t n = duite_count(call, 0) + 1;
    const int code = duite_resize(call, 0, n);
    for (size_t i = 0; !code && i < n; i++)
        duite_out(call, 0, int32_t)[i] = (int32_t)n;
    return code;
}

duite *delegation_start(const duite_kernel *const *kernels, const char *balance)
{
    duite_options options = misuse_options(MPI_COMM_WORLD);

    atomic_store(&mixed, 0);
    options.kernels = kernels;
    options.threads = 1;
    options.balance = duite_balancer_find(balance);
    return misuse_start_with(&options);
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

void delegation_values(duite *rt, const char *balance, const struct delegation_values *values)
{
    const int moves = !strcmp(balance, "scatter") && duite_ranks(rt) > 1;
    duite_object in = misuse_new(rt, 1), object[TASKS], last = delegation_beside(rt, in),
                 sum = delegation_beside(rt, in);
    const int here = duite_home(rt, in) == rank;
    int right = 1;
    duite_set(rt, in, &(int32_t){7});
    for (int32_t i = 0; i < TASKS; i++)
        object[i] = delegation_beside(rt, in);
    for (int32_t i = 0; i < TASKS; i++)
        values->fork(rt, i, (const duite_object[]){in, object[i], last, sum});
    for (int32_t i = 0; i < TASKS; i++)
        right &= delegation_value(rt, object[i]) == values->start + values->each * i;
    delegation_say(balance, "every object has its value", right);
    delegation_say(balance, "the last write is left",
                   delegation_value(rt, last) == values->last * (TASKS - 1));
    delegation_say(balance, "contributions come home",
                   delegation_value(rt, sum) == values->each * (TASKS * (TASKS - 1) / 2));
    delegation_say(balance, "tasks ran elsewhere if they could",
                   (delegation_count(rt) > 0) == moves);
    delegation_say(balance, "on every rank", here || (atomic_load(&mixed) > 0) == moves);
    if (values->ran)
        delegation_say(balance, "whole", here || (atomic_load(values->ran) > 0) == moves);
    for (int i = 0; i < TASKS; i++)
        duite_free(rt, object[i]);
    duite_free(rt, in);
    duite_free(rt, last);
    duite_free(rt, sum);
}
