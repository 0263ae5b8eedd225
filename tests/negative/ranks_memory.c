/* Out of memory at every allocation in turn, on one rank: nothing hangs, nothing crashes, what is
 * returned as good is right, and the next start finds a clean process. The linker puts the
 * functions below in place of those of the C library (module.mk). */

#include "tests/negative/misuse.h"

#include <limits.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { OBJECTS = 6, COUNT = 40, MOST = 100000 };

static _Atomic long left = LONG_MAX; /* allocations until one fails */
static int rank, ranks;

static int fails(void)
{
    return atomic_fetch_sub(&left, 1) == 1;
}

void *__real_malloc(size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    return fails() ? NULL : __real_realloc(memory, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : __real_aligned_alloc(alignment, size);
}

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

/* What is said to be good is good, as long as no error was told. */
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

/* One run; returns whether it ended as it may. */
static int run(void)
{
    duite *rt = NULL;
    duite_object a[OBJECTS];
    duite_options options = misuse_options(MPI_COMM_WORLD);
    int code = duite_start(&rt, &options), fine = 1;
    if (code)
        return rt == NULL;
    for (int i = 0; i < OBJECTS; i++)
        a[i] = misuse_new(rt, COUNT);
    duite_hint(rt, a[1], 2, 1, &a[0], NULL);
    duite_follow(rt, a[2], a[1]);
    work(rt, a);
    grow(rt);
    fine = right(rt, a);
    code = duite_wait(rt);
    for (int i = 1; i < OBJECTS; i++)
        duite_free(rt, a[i]);
    int stopped = duite_stop(&rt);
    return fine && rt == NULL && (!code || stopped || code == DUITE_E_MEMORY);
}

static int any(int here)
{
    int all;
    MPI_Allreduce(&here, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return all;
}

/* Every allocation of one rank fails once. */
static void each_on(int victim)
{
    int wrong = 0, reached = 1;
    long k = 0;
    while (reached && k < MOST) {
        k++;
        atomic_store(&left, rank == victim ? k : LONG_MAX);
        const int ended = run();
        if (!ended)
            fprintf(stderr, "# rank %d: wrong when allocation %ld of rank %d fails: %s\n", rank, k,
                    victim, duite_message());
        wrong += !ended;
        reached = any(rank == victim && atomic_load(&left) < 1);
        atomic_store(&left, LONG_MAX);
    }
    char name[100];
    snprintf(name, sizeof name, "each of some allocations fails on rank %d of %d", victim, ranks);
    if (rank == victim)
        fprintf(stderr, "# %ld allocations\n", k - 1);
    tap_case(!wrong && !reached && k > 20, name);
    tap_case(run() && !any(0), "and the next run is as if nothing had been");
}

int main(void)
{
    misuse_mpi();
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    for (int victim = 0; victim < ranks; victim++)
        each_on(victim);
    return tap_done();
}
