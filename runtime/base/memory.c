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
        size >= PAGE) /* only advice; the rest behind the last large page has small ones */
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

static size_t array_lines(const struct base_array *array)
{
    return (array->bytes + BASE_LINE - 1) / BASE_LINE * BASE_LINE;
}

void *base_arrays(const struct base_array *list)
{
    size_t bytes = 0;
    for (const struct base_array *array = list; array->pointer; array++)
        bytes += array_lines(array);
    char *const block = base_alloc(bytes), *part = block;
    for (const struct base_array *array = list; block && array->pointer; array++) {
        memcpy(array->pointer, &part, sizeof part);
        if (array->zero)
            memset(part, 0, array->bytes);
        part += array_lines(array);
    }
    return block;
}

/* The new capacity of an array; 0: it would exceed the address space. */
static size_t grown_capacity(size_t capacity, size_t needed, size_t element, size_t factor)
{
    size_t wanted = capacity ? capacity : 16;
    while (wanted < needed)
        wanted *= factor;
    return wanted <= SIZE_MAX / element ? wanted : 0;
}

/* Moves the array to a new block of so many elements. */
static void *grown_block(void *array, size_t *capacity, size_t wanted, size_t element)
{
    void *moved = wanted ? base_alloc(wanted * element) : NULL;
    if (!moved)
        return NULL;
    if (array)
        memcpy(moved, array, *capacity * element);
    base_free(array);
    *capacity = wanted;
    return moved;
}

/* Arrays of a large page or more lie in such pages and quadruple, so that little is copied: unused
 * pages take no memory. The system moves very large arrays without a copy. */
void *base_grow_more(void *array, size_t *capacity, size_t needed, size_t element)
{
    const size_t large = PAGE / element, very_large = 32 * large;
    const size_t wanted =
        grown_capacity(*capacity, needed, element, needed < large || needed > very_large ? 2 : 4);
    if (wanted >= large && needed <= very_large)
        return grown_block(array, capacity, wanted, element);
    void *moved = wanted ? realloc(array, wanted * element) : NULL;
    if (moved)
        *capacity = wanted;
    return moved;
}

void *base_grow_lines(void *array, size_t *capacity, size_t needed, size_t element)
{
    return needed <= *capacity
               ? array
               : grown_block(array, capacity, grown_capacity(*capacity, needed, element, 2),
                             element);
}

/* ---- Small blocks ---- */

/* A free block is in one magazine, which one thread or the common store holds. Magazines have
 * pointers to blocks instead of links in them, so that taking and giving never touch a block's own
 * memory: it may still lie in another core's cache. After Bonwick & Adams, Magazines and vmem,
 * USENIX 2001. `lock` is held for a few instructions, once per magazine.
 *
 * New blocks are cut one after another from a thread's region, so blocks taken together lie
 * together. */

enum { N_SIZES = BASE_POOL_LARGEST / BASE_POOL_GRAIN + 1 };

/* A new chunk is as large as all chunks before it together, within these limits. */
#define SMALLEST_CHUNK ((size_t)1 << 16)
#define LARGEST_CHUNK  ((size_t)1 << 22)

struct chunk {
    struct chunk *next;
};

/* The rest of a chunk that a thread left when it ended. */
struct region {
    struct region *next;
    char *end;
};

static atomic_flag lock = ATOMIC_FLAG_INIT;
static _Atomic(struct base_magazine *) store[N_SIZES]; /* with blocks; written under `lock` */
static struct base_magazine *empties;
static struct chunk *chunks;
static struct region *regions;
static size_t chunk_bytes; /* of all chunks */
static unsigned runtimes;

/* A thread's own blocks. A program that loads this library late has room for only some hundred
 * bytes of initial-exec variables. So the shelves themselves are cut from a region when the thread
 * first needs them (shelves_own); until then it has no_shelves, which stay empty. */
static struct base_shelf no_shelves[N_SIZES];
_Thread_local struct base_shelf *base_shelves = no_shelves;
#define THREAD_OWN static _Thread_local __attribute__((tls_model("initial-exec")))
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

/* Blocks of whole cache lines begin at a line, all others at a multiple of 16 bytes. */
static void *region_cut(size_t bytes)
{
    size_t align = bytes % BASE_LINE ? 2 * BASE_POOL_GRAIN : BASE_LINE;
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

/* Leaves the memory from `begin` to `end` to the next thread, if it is enough. */
static void region_leave(char *begin, char *end)
{
    size_t skip = -(uintptr_t)begin % BASE_LINE;
    if ((size_t)(end - begin) < skip + BASE_POOL_LARGEST)
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
static struct base_shelf *shelves_own(void)
{
    if (base_shelves != no_shelves)
        return base_shelves;
    struct base_shelf *own = region_cut(sizeof no_shelves);
    if (!own)
        return NULL;
    memset(own, 0, sizeof no_shelves);
    return base_shelves = own;
}

/* Empty; NULL without memory. */
static struct base_magazine *magazine_new(void)
{
    pool_lock();
    struct base_magazine *empty = empties;
    if (empty)
        empties = empty->next;
    pool_unlock();
    if (!empty && (empty = region_cut(sizeof *empty)))
        empty->n = 0;
    return empty;
}

/* Cuts several small blocks at a time: the others are then at hand, in the order in which they lie.
 * Blocks of an odd number of grains come in even numbers, so no room between blocks is lost.
 * `loaded` is NULL or empty. */
static void *blocks_new(struct base_shelf *shelf, size_t size)
{
    enum { AT_ONCE = 16, SMALL = 256 /* bytes */ };
    const size_t bytes = size * BASE_POOL_GRAIN, n = bytes <= SMALL ? AT_ONCE : 1 + size % 2;
    struct base_magazine *loaded = shelf->loaded;
    if (!loaded && !(loaded = shelf->loaded = magazine_new()))
        return NULL;
    char *block = region_cut(n * bytes);
    if (!block)
        return NULL;
    for (size_t i = 1; i < n; i++)
        loaded->block[n - 1 - i] = block + i * bytes;
    loaded->n = n - 1;
    return block;
}

/* Returns a full magazine of the store, or NULL; `empty`, which may be NULL, goes there in
 * exchange. */
static struct base_magazine *store_exchange(struct base_magazine *empty, size_t size)
{
    /* While the number of blocks grows the store is empty: seen without the lock. */
    if (!atomic_load_explicit(&store[size], memory_order_relaxed))
        return NULL;
    pool_lock();
    struct base_magazine *full = atomic_load_explicit(&store[size], memory_order_relaxed);
    if (full)
        atomic_store_explicit(&store[size], full->next, memory_order_relaxed);
    if (full && empty) {
        empty->next = empties;
        empties = empty;
    }
    pool_unlock();
    return full;
}

void *base_pool_take_more(size_t size)
{
    struct base_shelf *shelf = shelves_own();
    if (!shelf)
        return NULL;
    shelf += size;
    struct base_magazine *full = shelf->spare;
    if ((!full || !full->n) && !(full = store_exchange(full, size)))
        return blocks_new(shelf, size);
    shelf->spare = shelf->loaded;
    shelf->loaded = full;
    return full->block[--full->n];
}

/* Both magazines are full, or missing. Without memory for one more, or for the shelves, the block
 * is lost until the last runtime ends. */
static void store_give(void *block, size_t size)
{
    struct base_shelf *shelf = &base_shelves[size];
    struct base_magazine *empty = magazine_new();
    if (!empty)
        return;
    if (shelf->spare) {
        pool_lock();
        shelf->spare->next = atomic_load_explicit(&store[size], memory_order_relaxed);
        atomic_store_explicit(&store[size], shelf->spare, memory_order_relaxed);
        pool_unlock();
    }
    shelf->spare = shelf->loaded;
    shelf->loaded = empty;
    empty->block[0] = block;
    empty->n = 1;
}

void base_pool_give_more(void *block, size_t size)
{
    struct base_shelf *shelf = shelves_own();
    if (!shelf)
        return;
    shelf += size;
    struct base_magazine *spare = shelf->spare;
    if (!spare || spare->n) {
        store_give(block, size);
        return;
    }
    shelf->spare = shelf->loaded;
    shelf->loaded = spare;
    spare->block[spare->n++] = block;
}

/* ---- Threads and runtimes ---- */

/* The calling thread holds the lock. */
static void magazine_put_away(struct base_magazine *magazine, size_t size)
{
    if (!magazine)
        return;
    if (magazine->n) {
        magazine->next = atomic_load_explicit(&store[size], memory_order_relaxed);
        atomic_store_explicit(&store[size], magazine, memory_order_relaxed);
    } else {
        magazine->next = empties;
        empties = magazine;
    }
}

void base_pool_enter(void)
{
    pool_lock();
    runtimes++;
    pool_unlock();
}

void base_pool_thread_end(void)
{
    struct base_shelf *own = base_shelves;
    base_shelves = no_shelves;
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
            atomic_store_explicit(&store[size], NULL, memory_order_relaxed);
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
