/* All memory of the runtime comes from here, on cache-line boundaries, so that no two allocations
 * share a line. */
#include "runtime/base/memory.h"

#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define PAGE ((size_t)2 << 20) /* a large one */

void *base_alloc(size_t size)
{
    const size_t step = size < PAGE ? BASE_LINE : PAGE;
    if (size > SIZE_MAX - PAGE)
        return NULL;
    const size_t steps = (size + step - 1) / step;
    void *memory = aligned_alloc(step, (steps ? steps : 1) * step);
    if (memory &&
        size >= PAGE) /* only advice; the rest behind the last whole page has small ones */
        madvise(memory, size / PAGE * PAGE, MADV_HUGEPAGE);
    return memory;
}

void *base_alloc_zero(size_t size)
{
    void *memory = base_alloc(size);
    if (memory)
        memset(memory, 0, size);
    return memory;
}

void base_free(void *memory)
{
    free(memory);
}

void *base_grow(void *array, size_t *capacity, size_t needed, size_t element)
{
    if (needed <= *capacity)
        return array;
    size_t wanted = *capacity ? *capacity : 16;
    while (wanted < needed)
        wanted *= 2;
    void *moved = wanted <= SIZE_MAX / element ? realloc(array, wanted * element) : NULL;
    if (moved)
        *capacity = wanted;
    return moved;
}

/* ---- Small blocks ---- */

/* A free block is in one place: a magazine, which one thread or the common store holds. Blocks are
 * named by pointers in magazines, not linked, so that taking and giving never touch a block's own
 * memory: it may still lie in another core's cache. After Bonwick & Adams, Magazines and vmem,
 * USENIX 2001. `lock` is held for a few instructions, once per MAGAZINE blocks.
 *
 * New blocks are cut one after another from a thread's region, so that what is taken together lies
 * together. */

/* Sanitizers must see when each block is taken and given back. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DIRECT 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DIRECT 1
#endif
#endif
#ifndef DIRECT
#define DIRECT 0
#endif

enum {
    GRAIN = 8,
    LARGEST = 1536, /* bytes of a block */
    N_SIZES = LARGEST / GRAIN + 1,
    AHEAD = 2,
    MAGAZINE = 30 /* blocks: a magazine takes four cache lines */
};

/* A new chunk is as large as all chunks before it together, within these limits. */
#define SMALLEST_CHUNK ((size_t)1 << 16)
#define LARGEST_CHUNK  ((size_t)1 << 22)

struct magazine {
    struct magazine *next; /* in the store */
    size_t n;
    void *block[MAGAZINE];
};

struct chunk {
    struct chunk *next;
};

/* The rest of a chunk that a thread left when it ended. */
struct region {
    struct region *next;
    char *end;
};

static atomic_flag lock = ATOMIC_FLAG_INIT;
static struct magazine *store[N_SIZES]; /* with blocks */
static struct magazine *empties;
static struct chunk *chunks;
static struct region *regions;
static size_t chunk_bytes; /* of all chunks */
static unsigned runtimes;

/* The magazines of one size that a thread holds. Blocks are taken from and given to `loaded`;
 * `spare` is full or empty. */
struct shelf {
    struct magazine *loaded, *spare;
};

/* What a thread has at hand. By the initial-exec model it is reached without a call. For variables
 * of that model a program that loads this library late has room for some hundred bytes only. So the
 * shelves themselves are cut from a region when the thread first needs them (shelves_own). Until
 * then it has those that stay empty. */
#define THREAD_OWN static _Thread_local __attribute__((tls_model("initial-exec")))

static struct shelf no_shelves[N_SIZES];
THREAD_OWN struct shelf *shelves = no_shelves;
THREAD_OWN char *region, *region_end;

static void pool_lock(void)
{
    for (unsigned tries = 1; atomic_flag_test_and_set_explicit(&lock, memory_order_acquire);
         tries++)
        if (tries % 128 == 0)
            sched_yield();
}

static void pool_unlock(void)
{
    atomic_flag_clear_explicit(&lock, memory_order_release);
}

/* ---- New memory ---- */

static bool region_next(void)
{
    pool_lock();
    struct region *left = regions;
    if (left)
        regions = left->next;
    size_t bytes = chunk_bytes < SMALLEST_CHUNK  ? SMALLEST_CHUNK
                   : chunk_bytes > LARGEST_CHUNK ? LARGEST_CHUNK
                                                 : chunk_bytes;
    pool_unlock();
    if (left) {
        region = (char *)left;
        region_end = left->end;
        return true;
    }
    struct chunk *chunk = base_alloc(bytes);
    if (!chunk)
        return false;
    pool_lock();
    chunk->next = chunks;
    chunks = chunk;
    chunk_bytes += bytes;
    pool_unlock();
    region = (char *)chunk + BASE_LINE;
    region_end = (char *)chunk + bytes;
    return true;
}

/* Blocks of whole cache lines begin with one, all others with a multiple of 16 bytes. */
static void *region_cut(size_t bytes)
{
    size_t align = bytes % BASE_LINE ? 2 * GRAIN : BASE_LINE;
    for (;;) {
        size_t skip = -(uintptr_t)region % align;
        if ((size_t)(region_end - region) >= skip + bytes) {
            char *block = region + skip;
            region = block + bytes;
            return block;
        }
        if (!region_next())
            return NULL;
    }
}

/* What lies from `begin` to `end` is for the next thread, if it is worth it. */
static void region_leave(char *begin, char *end)
{
    size_t skip = -(uintptr_t)begin % BASE_LINE;
    if ((size_t)(end - begin) < skip + LARGEST)
        return;
    struct region *left = (struct region *)(void *)(begin + skip);
    left->end = end;
    pool_lock();
    left->next = regions;
    regions = left;
    pool_unlock();
}

/* ---- Magazines ---- */

/* The calling thread's shelves; NULL without memory. */
static struct shelf *shelves_own(void)
{
    if (shelves != no_shelves)
        return shelves;
    struct shelf *own = region_cut(sizeof no_shelves);
    if (!own)
        return NULL;
    memset(own, 0, sizeof no_shelves);
    return shelves = own;
}

/* Blocks of an odd number of grains come in pairs, so that nothing is lost between them and others.
 */
static void *block_new(size_t size)
{
    size_t bytes = size * GRAIN;
    char *block = region_cut(size % 2 ? 2 * bytes : bytes);
    if (block && size % 2)
        base_pool_give(block + bytes, bytes);
    return block;
}

static void *store_take(size_t size)
{
    struct shelf *shelf = &shelves[size];
    pool_lock();
    struct magazine *full = store[size];
    if (full)
        store[size] = full->next;
    if (full && shelf->spare) {
        shelf->spare->next = empties;
        empties = shelf->spare;
    }
    pool_unlock();
    if (!full)
        return block_new(size);
    shelf->spare = shelf->loaded;
    shelf->loaded = full;
    return full->block[--full->n];
}

/* This and magazine_give stand apart, so that the short way to `loaded` saves no registers. */
__attribute__((noinline)) static void *magazine_take(size_t size)
{
    struct shelf *shelf = shelves_own();
    if (!shelf)
        return NULL;
    shelf += size;
    struct magazine *spare = shelf->spare;
    if (!spare || !spare->n)
        return store_take(size);
    shelf->spare = shelf->loaded;
    shelf->loaded = spare;
    return spare->block[--spare->n];
}

/* Both magazines are full, or not there yet. Without memory for one more, or for the shelves, the
 * block is lost until the last runtime ends. */
static void store_give(void *block, size_t size)
{
    struct shelf *shelf = &shelves[size];
    pool_lock();
    struct magazine *empty = empties;
    if (empty)
        empties = empty->next;
    pool_unlock();
    if (!empty && !(empty = region_cut(sizeof *empty)))
        return;
    if (shelf->spare) {
        pool_lock();
        shelf->spare->next = store[size];
        store[size] = shelf->spare;
        pool_unlock();
    }
    shelf->spare = shelf->loaded;
    shelf->loaded = empty;
    empty->block[0] = block;
    empty->n = 1;
}

__attribute__((noinline)) static void magazine_give(void *block, size_t size)
{
    struct shelf *shelf = shelves_own();
    if (!shelf)
        return;
    shelf += size;
    struct magazine *spare = shelf->spare;
    if (!spare || spare->n) {
        store_give(block, size);
        return;
    }
    shelf->spare = shelf->loaded;
    shelf->loaded = spare;
    spare->block[spare->n++] = block;
}

void *base_pool_take(size_t bytes)
{
    size_t size = (bytes + GRAIN - 1) / GRAIN;
    if (DIRECT || bytes > LARGEST)
        return base_alloc(bytes);
    struct magazine *loaded = shelves[size].loaded;
    if (!loaded || !loaded->n)
        return magazine_take(size);
    /* A block that will be taken soon may lie in another core's cache: fetch it. */
    if (loaded->n > AHEAD)
        for (size_t line = 0; line < bytes; line += BASE_LINE)
            base_prefetch((char *)loaded->block[loaded->n - 1 - AHEAD] + line);
    return loaded->block[--loaded->n];
}

void base_pool_give(void *block, size_t bytes)
{
    size_t size = (bytes + GRAIN - 1) / GRAIN;
    if (DIRECT || bytes > LARGEST || !block) {
        base_free(block);
        return;
    }
    struct magazine *loaded = shelves[size].loaded;
    if (loaded && loaded->n < MAGAZINE)
        loaded->block[loaded->n++] = block;
    else
        magazine_give(block, size);
}

/* ---- Threads and runtimes ---- */

/* The calling thread holds the lock. */
static void magazine_put_away(struct magazine *magazine, size_t size)
{
    if (!magazine)
        return;
    struct magazine **list = magazine->n ? &store[size] : &empties;
    magazine->next = *list;
    *list = magazine;
}

void base_pool_enter(void)
{
    pool_lock();
    runtimes++;
    pool_unlock();
}

void base_pool_thread_end(void)
{
    struct shelf *own = shelves;
    shelves = no_shelves;
    if (own != no_shelves) {
        pool_lock();
        for (size_t size = 0; size < N_SIZES; size++) {
            magazine_put_away(own[size].loaded, size);
            magazine_put_away(own[size].spare, size);
        }
        pool_unlock();
        region_leave((char *)own, (char *)(own + N_SIZES));
    }
    region_leave(region, region_end);
    region = region_end = NULL;
}

void base_pool_leave(void)
{
    base_pool_thread_end();
    pool_lock();
    struct chunk *chunk = NULL;
    if (--runtimes == 0) {
        chunk = chunks;
        chunks = NULL;
        for (size_t size = 0; size < N_SIZES; size++)
            store[size] = NULL;
        empties = NULL;
        regions = NULL;
        chunk_bytes = 0;
    }
    pool_unlock();
    while (chunk) {
        struct chunk *next = chunk->next;
        base_free(chunk);
        chunk = next;
    }
}
