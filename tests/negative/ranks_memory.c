/* Out of memory at every allocation in turn, on one rank: nothing hangs, nothing crashes, what is
 * returned as good is right, and the next start finds a clean process. With an argument objects are
 * sent in pieces. */

#include "runtime/comm/internal.h"
#include "tests/negative/misuse.h"
#include "tests/negative/starve.h"
#include "tests/support/ranks.h"

#include <stdint.h>

enum { OBJECTS = 6, COUNT = 40, PIECE = 64 };

static int expected(int object)
{
    return object == OBJECTS - 1 ? 7 : 4;
}

/* Objects that go round the ranks, contributions from everywhere, a set, a free. */
static void work(duite *rt, const duite_object *a)
{
    const int32_t one = 1;
    for (int i = 0; i < OBJECTS; i++)
        duite_fork_at(rt, i % ranks, &SET, &one, 1, &a[i]);
    for (int i = 1; i < OBJECTS; i++)
        duite_fork_at(rt, (i + 1) % ranks, &COPY, NULL, 2, (duite_object[]){a[0], a[i]});
    for (int i = 0; i < OBJECTS; i++)
        for (int k = 0; k < 2; k++)
            duite_fork_at(rt, (i + k) % ranks, &ADD, NULL, 1, &a[i]);
    int32_t values[COUNT];
    for (int i = 0; i < COUNT; i++)
        values[i] = 5;
    duite_set(rt, a[OBJECTS - 1], values);
    for (int k = 0; k < 2; k++)
        duite_fork_at(rt, k % ranks, &ADD, NULL, 1, &a[OBJECTS - 1]);
    duite_free(rt, a[0]);
}

/* Results are right as long as no error was told. */
static int right(duite *rt, const duite_object *a)
{
    int32_t values[COUNT];
    for (int i = 1; i < OBJECTS; i++) {
        if (duite_get(rt, a[i], values))
            return 1;
        if (values[0] != expected(i))
            return 0;
    }
    return 1;
}

/* An object grows where it was small. */
static void grow(duite *rt)
{
    const int32_t value = 8, values[3] = {1, 2, 3};
    duite_object list;
    if (duite_new_sized(rt, DUITE_I32, 1, COUNT, &list))
        return;
    duite_set_sized(rt, list, values, 3);
    duite_fork(rt, &SET, &value, 1, &list);
    duite_fork_at(rt, ranks - 1, &SET, &value, 1, &list);
    duite_free(rt, list);
}

/* Parameters under rwp and cwp; adds 1 to both once a leaf, of which there are 2^depth, and counts
 * them on objects of its own. */
static int tree(const duite_call *call);
static const duite_kernel TREE = {
    .name = "tree", .body = tree, .access = {DUITE_RWP, DUITE_CWP}, .args_size = sizeof(int32_t)};
static const duite_kernel NEXT = {.name = "next", .body = tree, .access = {DUITE_RW}};

static int tree(const duite_call *call)
{
    if (call->n_params == 1) {
        duite_out(call, 0, int32_t)[0]++;
        return 0;
    }
    const int32_t depth = *(const int32_t *)call->args, less = depth - 1;
    const duite_object a = call->param[0].object, b = call->param[1].object;
    if (!depth) {
        duite_fork(call->rt, &NEXT, NULL, 1, &a);
        return duite_fork(call->rt, &ADD, NULL, 1, &b);
    }
    int32_t values[COUNT] = {0};
    duite_object made[4];
    for (int i = 0; i < 4; i++)
        duite_new(call->rt, DUITE_I32, COUNT, &made[i]);
    duite_set(call->rt, made[1], values);
    for (int i = 0; i < 2; i++) {
        duite_fork(call->rt, &TREE, &less, 2, (duite_object[]){a, b});
        duite_fork(call->rt, &TREE, &less, 2, (duite_object[]){made[0], made[1]});
        duite_fork(call->rt, &COPY, NULL, 2, (duite_object[]){made[1], made[2]});
    }
    const int code = duite_get(call->rt, made[1], values), waited = duite_wait(call->rt);
    if (!code && !waited && values[0] != 2 << less)
        return 99;
    return code ? code : waited;
}

/* Tasks that fork, on every rank. */
static int nest(duite *rt)
{
    const int32_t depth = 2;
    int32_t value[COUNT], sum[COUNT];
    duite_object a = misuse_new(rt, COUNT), b = misuse_new(rt, COUNT);
    for (int i = 0; i < ranks; i++)
        duite_fork_at(rt, i, &TREE, &depth, 2, (duite_object[]){a, b});
    const int code = duite_get(rt, a, value), other = duite_get(rt, b, sum);
    duite_free(rt, a);
    duite_free(rt, b);
    if (code || other)
        return code != 99 && other != 99;
    return value[0] == 4 * ranks && sum[0] == 4 * ranks;
}

/* Memory of the test's own, in parts and in turns. It must be given back, or the next run is
 * refused it. */
static int lend(duite *rt)
{
    static int32_t memory[COUNT];
    static const size_t COUNTS[] = {10, COUNT - 10};
    const int32_t three = 3, one = 1;
    duite_object object, part[2];
    int32_t values[COUNT];
    void *data;
    if (duite_adopt(rt, 0, DUITE_I32, COUNT, memory, NULL, NULL, &object) == DUITE_E_ARGUMENT)
        return 0;
    duite_fork(rt, &SET, &three, 1, &object);
    if (!duite_split(rt, object, 2, COUNTS, part)) {
        duite_fork(rt, &SET, &one, 1, &part[0]);
        duite_fork_at(rt, ranks - 1, &ADD, NULL, 1, &part[1]);
        if (!duite_acquire(rt, part[1], DUITE_RW, &data) && data)
            *(int32_t *)data += 2;
        duite_release(rt, part[1]);
        duite_join(rt, object);
    }
    const int code = duite_get(rt, object, values);
    duite_free(rt, object);
    return code || (values[0] == 1 && values[10] == 6 && values[11] == 3);
}

/* One run; returns whether it ended as it may. */
static int run(void)
{
    duite *rt = NULL;
    duite_object a[OBJECTS];
    static const duite_kernel *const KERNELS[] = {&SET, &COPY, &ADD, &TREE, &NEXT, NULL};
    duite_options options = misuse_options(MPI_COMM_WORLD);
    options.kernels = KERNELS;
    int code = duite_start(&rt, &options), fine = 1;
    if (code)
        return rt == NULL;
    for (int i = 0; i < OBJECTS; i++)
        a[i] = misuse_new(rt, COUNT);
    duite_hint(rt, a[1], 2, 1, &a[0], NULL);
    duite_colocate(rt, a[2], a[1]);
    work(rt, a);
    grow(rt);
    fine = right(rt, a) && nest(rt) && lend(rt);
    code = duite_wait(rt);
    for (int i = 1; i < OBJECTS; i++)
        duite_free(rt, a[i]);
    int stopped = duite_stop(&rt);
    return fine && rt == NULL && (!code || stopped || code == DUITE_E_MEMORY);
}

RANKS_CASE(memory)
{
    misuse_mpi();
    if (argc > 1)
        comm_piece_bytes = PIECE;
    starve("tasks", run);
    return tap_done();
}
