/* Replicated kernels on the dynamic path: they run on every rank, what they leave is there without
 * a message, and a failing one fails everywhere. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdatomic.h>

static atomic_int ran;

KERNEL(NEXT, "next", .access = {DUITE_R, DUITE_W}, .replicated = 1)
{
    atomic_fetch_add(&ran, 1);
    duite_out(call, 1, int32_t)[0] = duite_in(call, 0, int32_t)[0] + 1;
    return duite_in(call, 0, int32_t)[0] == 100 ? duite_fail(call, 7, "a hundred") : 0;
}

KERNEL(READ, "read", .access = {DUITE_R}, .args_size = sizeof(int32_t))
{
    return duite_in(call, 0, int32_t)[0] == *(const int32_t *)call->args ? 0 : 1;
}

static uint64_t messages(duite *rt)
{
    duite_counters counters;

    duite_wait(rt);
    return duite_count_all(rt, &counters) ? 0 : counters.messages;
}

/* a is read on all ranks once; then b, c and their readers need no message. */
static void without_messages(duite *rt, int n_ranks)
{
    duite_object a = misuse_new(rt, 1), b = misuse_new(rt, 1), c = misuse_new(rt, 1);
    const int32_t start = 5;

    duite_set(rt, a, &start);
    const uint64_t before = messages(rt);

    DUITE_FORK(rt, &NEXT, NULL, a, b);
    DUITE_FORK(rt, &NEXT, NULL, b, c);
    DUITE_FORK(rt, &NEXT, NULL, c, b);
    for (int at = 0; at < n_ranks; at++)
        duite_fork_at(rt, at, &READ, &(int32_t){8}, 1, &b);
    tap_case(duite_wait(rt) == DUITE_OK, "each rank reads what it computed itself");
    tap_case(messages(rt) - before == (uint64_t)n_ranks - 1, "only the input was sent");
    tap_case(atomic_load(&ran) == 3, "each task ran once on each rank");
    duite_fork_at(rt, n_ranks - 1, &SET, &(int32_t){20}, 1, &b);
    DUITE_FORK(rt, &NEXT, NULL, b, c);
    int32_t value = 0;
    tap_case(!duite_get(rt, c, &value) && value == 21,
             "a value written on one rank is read on all");
    duite_fork_at(rt, 0, &SET, &(int32_t){100}, 1, &b);
    DUITE_FORK(rt, &NEXT, NULL, b, c);
    tap_case(duite_get(rt, c, &value) == 7, "a failure is told on every rank");
    tap_case(duite_wait(rt) == 7, "and by the wait");
    duite_free(rt, a);
    duite_free(rt, b);
    duite_free(rt, c);
}

RANKS_CASE(replicated)
{
    const duite_kernel *const list[] = {&NEXT, &READ, &SET, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = list;
    duite *rt = misuse_start_with(&options);
    if (!rt)
        return 1;
    without_messages(rt, duite_ranks(rt));
    tap_case(duite_stop(&rt) == DUITE_OK, "stop");
    return tap_done();
}
