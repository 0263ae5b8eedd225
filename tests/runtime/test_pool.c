/* The pool: blocks are disjoint and aligned, survive a journey between threads, and come back to be
 * used again. Arrays that grow keep what is in them, however large they get. */
#include "runtime/base/memory.h"
#include "tests/support/unit.h"

#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { N = 5000, ROUNDS = 20 };

static const size_t SIZES[] = {1, 64, 65, 200, 24 * 64, 24 * 64 + 1, 100000};
enum { N_SIZES = sizeof SIZES / sizeof SIZES[0] };

struct cargo {
    unsigned char *block[N];
    size_t size;
};

static void fill(struct cargo *cargo, unsigned char first)
{
    const size_t align = cargo->size % 64 == 0 ? 64 : cargo->size % 16 == 0 ? 16 : 8;
    for (int i = 0; i < N; i++) {
        cargo->block[i] = base_pool_take(cargo->size);
        ck_assert_ptr_nonnull(cargo->block[i]);
        ck_assert_uint_eq((uintptr_t)cargo->block[i] % align, 0);
        memset(cargo->block[i], first + i % 100, cargo->size);
    }
}

static int intact(const struct cargo *cargo, unsigned char first)
{
    for (int i = 0; i < N; i++)
        for (size_t j = 0; j < cargo->size; j++)
            if (cargo->block[i][j] != (unsigned char)(first + i % 100))
                return 0;
    return 1;
}

static void *check_and_free(void *argument)
{
    struct cargo *cargo = argument;
    const int fine = intact(cargo, 7);
    for (int i = 0; i < N; i++)
        base_pool_give(cargo->block[i], cargo->size);
    base_pool_thread_end();
    return fine ? argument : NULL;
}

UNIT_LOOP(disjoint, 0, N_SIZES - 1)
{
    static struct cargo a, b;
    a.size = b.size = SIZES[_i] < 2000 ? SIZES[_i] : 2000;
    base_pool_enter();
    fill(&a, 1);
    fill(&b, 120);
    ck_assert(intact(&a, 1));
    ck_assert(intact(&b, 120));
    for (int i = 0; i < N; i++) {
        base_pool_give(a.block[i], a.size);
        base_pool_give(b.block[i], b.size);
    }
    base_pool_leave();
}

/* One thread takes, another gives back: nothing is lost, nothing is used twice. */
UNIT_TEST(journey)
{
    static struct cargo cargo;
    cargo.size = 192;
    base_pool_enter();
    for (int round = 0; round < ROUNDS; round++) {
        pthread_t thread;
        void *fine;
        fill(&cargo, 7);
        ck_assert_int_eq(pthread_create(&thread, NULL, check_and_free, &cargo), 0);
        pthread_join(thread, &fine);
        ck_assert_ptr_nonnull(fine);
    }
    base_pool_leave();
}

UNIT_TEST(large_and_nothing)
{
    base_pool_enter();
    for (int i = 0; i < N_SIZES; i++) {
        unsigned char *block = base_pool_take(SIZES[i]);
        ck_assert_ptr_nonnull(block);
        memset(block, 1, SIZES[i]);
        base_pool_give(block, SIZES[i]);
    }
    base_pool_give(NULL, 64);
    ck_assert_ptr_null(base_pool_take(SIZE_MAX));
    base_pool_leave();
}

/* Through small pages, large pages and blocks that the system moves. */
UNIT_TEST(growing)
{
    enum { MANY = 10000000 };
    size_t capacity = 0;
    uint64_t *array = NULL;
    for (size_t i = 0; i < MANY; i++) { /* an assertion of Check each time would take minutes */
        array = base_grow(array, &capacity, i + 1, sizeof *array);
        if (!array || capacity <= i)
            ck_abort_msg("no room for element %zu", i);
        array[i] = i;
    }
    for (size_t i = 0; i < MANY; i++)
        if (array[i] != i)
            ck_abort_msg("element %zu is lost", i);
    const size_t before = capacity;
    ck_assert_ptr_null(base_grow(array, &capacity, SIZE_MAX / 4, sizeof *array));
    ck_assert_uint_eq(capacity, before);
    free(array);
}
