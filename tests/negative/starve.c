/* The linker puts the functions below in place of those of the C library, and of what the pool of
 * small blocks does when nothing is at hand (module.mk). The latter come from the C library here
 * and go back to it. So nothing ever is at hand, and each block may fail. */

#include "tests/negative/starve.h"

#include "runtime/base/memory.h"
#include "tests/negative/misuse.h"

#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 100000 };

static _Atomic long left = LONG_MAX; /* allocations until one fails */

static int fails(void)
{
    return atomic_fetch_sub(&left, 1) == 1;
}

void *__real_malloc(size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_base_pool_take_more(size_t size);
void __wrap_base_pool_give_more(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

void *__wrap_base_pool_take_more(size_t size)
{
    const size_t lines = (size * BASE_POOL_GRAIN + BASE_LINE - 1) / BASE_LINE;
    return fails() ? NULL : __real_aligned_alloc(BASE_LINE, lines * BASE_LINE);
}

void __wrap_base_pool_give_more(void *memory, size_t size)
{
    (void)size;
    free(memory);
}

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

static int any(int here)
{
    int all;
    MPI_Allreduce(&here, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return all;
}

static int chosen(const char *variable)
{
    const char *value = getenv(variable);
    return value && !strcmp(value, "1");
}

static long stride_of(void)
{
    if (chosen("DUITE_LONG"))
        return 1;
    return chosen("DUITE_QUICK") ? 7 : ranks > 2 ? 3 : 1;
}

/* The allocations of one rank fail, one a run. */
static void each_on(int victim, const char *what, int (*run)(void))
{
    const long stride = stride_of();
    int wrong = 0, reached = 1;
    long k = 1 + victim % stride - stride;
    while (reached && k < MOST) {
        k += stride;
        atomic_store(&left, rank == victim ? k : LONG_MAX);
        const int ended = run();
        if (!ended)
            fprintf(stderr, "# rank %d: wrong when allocation %ld of rank %d fails: %s\n", rank, k,
                    victim, duite_message());
        wrong += !ended;
        reached = any(rank == victim && atomic_load(&left) < 1);
        atomic_store(&left, LONG_MAX);
    }
    char name[120];
    snprintf(name, sizeof name, "%s: each of some allocations fails on rank %d of %d", what, victim,
             ranks);
    if (rank == victim)
        fprintf(stderr, "# at most %ld allocations\n", k - 1);
    tap_case(!wrong && !reached && k > 20, name);
    tap_case(run() && !any(0), "and the next run is as if nothing had been");
}

void starve(const char *what, int (*run)(void))
{
    for (int victim = 0; victim < ranks; victim++)
        each_on(victim, what, run);
}
