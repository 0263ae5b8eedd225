/* A list that grows and shrinks on its way round the ranks: every rank finds the size it was left
 * with, and messages carry the elements there are, not those there could be. */

#include "tests/negative/misuse.h"
#include "tests/support/ranks.h"

#include <stdint.h>

enum { MOST = 1000000, ROUNDS = 12 };

struct change {
    size_t before, count;
};

/* Checks what is there, then leaves `count` elements, element i being i + count of the new size;
 * what is added must be zero first. */
KERNEL(CHANGE, "change", .access = {DUITE_RW}, .args_size = sizeof(struct change))
{
    const struct change *args = call->args;
    int64_t *values = duite_out(call, 0, int64_t);
    const size_t before = duite_count(call, 0);

    if (before != args->before || call->param[0].max != MOST)
        return duite_fail(call, 1, "%zu elements instead of %zu", before, args->before);
    for (size_t i = 0; i < before; i++)
        if (values[i] != (int64_t)(i + before))
            return duite_fail(call, 2, "element %zu of %zu is %lld", i, before,
                              (long long)values[i]);
    if (duite_resize(call, 0, args->count))
        return 3;
    for (size_t i = before; i < args->count; i++)
        if (values[i])
            return duite_fail(call, 4, "element %zu of %zu was added and is not 0", i, args->count);
    for (size_t i = 0; i < args->count; i++)
        values[i] = (int64_t)(i + args->count);
    return 0;
}

/* Copies the size and the last element to numbers. */
KERNEL(LOOK, "look", .access = {DUITE_R, DUITE_W})
{
    const size_t count = duite_count(call, 0);

    duite_out(call, 1, int64_t)[0] = (int64_t)count;
    duite_out(call, 1, int64_t)[1] = count ? duite_in(call, 0, int64_t)[count - 1] : -1;
    return 0;
}

/* Sizes go up and down, over 0. */
static size_t size_of(int round)
{
    static const size_t SIZES[] = {5, 100, 3, 0, 64, 65, 8, 1000};

    return round < 0 ? 2 : SIZES[round % 8];
}

static int go_round(duite *rt, duite_object list, duite_object numbers)
{
    static int64_t values[MOST];
    int right = 1;

    for (size_t i = 0; i < 2; i++)
        values[i] = (int64_t)i + 2;
    duite_set_sized(rt, list, values, 2);
    for (int r = 0; r < ROUNDS; r++) {
        const struct change args = {size_of(r - 1), size_of(r)};
        int64_t seen[2];
        size_t count = 0;

        duite_fork_at(rt, r % ranks, &CHANGE, &args, 1, &list);
        duite_fork_at(rt, (r + r / 2 + 1) % ranks, &LOOK, NULL, 2, (duite_object[]){list, numbers});
        if (duite_get(rt, numbers, seen))
            return 0;
        right &= seen[0] == (int64_t)args.count &&
                 seen[1] == (args.count ? (int64_t)(2 * args.count - 1) : -1);
        if (r % 3)
            continue;
        values[args.count] = -5;
        right &= !duite_get_count(rt, list, &count) && count == args.count;
        right &= !duite_get(rt, list, values) && values[args.count] == -5;
        for (size_t i = 0; i < count; i++)
            right &= values[i] == (int64_t)(i + count);
    }
    return right;
}

RANKS_CASE(sizes)
{
    static const duite_kernel *const KERNELS[] = {&CHANGE, &LOOK, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    duite_object list, numbers;
    duite_counters counters;
    duite *rt;

    misuse_mpi();
    options.kernels = KERNELS;
    tap_case(duite_start(&rt, &options) == DUITE_OK, "starts");
    duite_new_sized(rt, DUITE_I64, 2, MOST, &list);
    duite_new(rt, DUITE_I64, 2, &numbers);
    tap_case(go_round(rt, list, numbers), "every rank finds what was left");
    tap_case(duite_wait(rt) == DUITE_OK, "no body found anything wrong");
    tap_case(duite_count_all(rt, &counters) == DUITE_OK && counters.bytes < MOST,
             "messages are as large as the list is");
    duite_free(rt, list);
    duite_free(rt, numbers);
    tap_case(duite_stop(&rt) == DUITE_OK, "stops");
    return tap_done();
}
