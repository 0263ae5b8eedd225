#ifndef DUITE_BASE_MEMORY_H
#define DUITE_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#pragma GCC visibility push(hidden) /* called directly: no other library can replace them */

/* All memory of the runtime: large blocks, growing arrays, and a pool of small blocks. */

enum { BASE_LINE = 64 }; /* bytes of a cache line: the alignment of everything allocated here */

/* size bytes, aligned to a cache line; NULL if there are none. Freed by base_free from any thread.
 * From 2 MiB on in large pages, where the system has them. */
void *base_alloc(size_t size);
/* As base_alloc, all zero. */
void *base_alloc_zero(size_t size);
void base_free(void *memory);

/* Makes room for `needed` elements in a growing array: at least doubles *capacity. Returns the
 * array, which may have moved; NULL without memory, and then nothing has changed. Freed by free. */
void *base_grow_more(void *array, size_t *capacity, size_t needed, size_t element);
static inline void *base_grow(void *array, size_t *capacity, size_t needed, size_t element)
{
    return needed <= *capacity ? array : base_grow_more(array, capacity, needed, element);
}
/* The same for an array that begins at a cache line. Freed by base_free. */
void *base_grow_lines(void *array, size_t *capacity, size_t needed, size_t element);

/* The same for the array that a pointer points at. False without memory: nothing has changed. */
#define BASE_GROW(array, capacity, needed)                                                         \
    base_grow_pointer(&(array), &(capacity), needed, sizeof *(array))
static inline bool base_grow_pointer(void *pointer, size_t *capacity, size_t needed, size_t element)
{
    void *array;
    memcpy(&array, pointer, sizeof array);
    array = base_grow(array, capacity, needed, element);
    if (array)
        memcpy(pointer, &array, sizeof array);
    return array;
}

/* Arrays that come and go together, in one block: so most of them lie in large pages. The list ends
 * with a row without a pointer. Sets each pointer; returns the block, which base_free frees, or
 * NULL without memory. */
struct base_array {
    void *pointer; /* to a pointer */
    size_t bytes;
    bool zero;
};
#define BASE_ARRAY(pointer, n)                                                                     \
    {                                                                                              \
        &(pointer), (n) * sizeof *(pointer), false                                                 \
    }
#define BASE_ZEROS(pointer, n)                                                                     \
    {                                                                                              \
        &(pointer), (n) * sizeof *(pointer), true                                                  \
    }
void *base_arrays(const struct base_array *list);

/* Prefetches a line that will soon be written: it becomes this core's own, so the first write, or
 * an atomic operation behind it, need not wait. */
static inline void base_prefetch(const void *line)
{
#if defined(__x86_64__)
    /* __builtin_prefetch emits this for the newest processors only; older ones skip it. */
    __asm__ volatile("prefetchw %0" : : "m"(*(const char *)line));
#else
    __builtin_prefetch(line, 1);
#endif
}

/* ---- Small blocks ---- */

/* Small blocks that live briefly and are often freed on another thread than the one that took them:
 * tasks, versions, messages. Each thread keeps some of each size at hand, and whole batches move
 * between threads. The general allocator would lock, and a futex costs more than a task.
 *
 * Taking and giving are inline where the thread's own blocks suffice: most sizes are constants, so
 * little code is left. */

/* Sanitizers must see when each block is taken and given back. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BASE_POOL_DIRECT 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BASE_POOL_DIRECT 1
#endif
#endif
#ifndef BASE_POOL_DIRECT /* the tests in tests/model set it, too */
#define BASE_POOL_DIRECT 0
#endif

enum {
    BASE_POOL_GRAIN = 8,
    BASE_POOL_LARGEST = 1536, /* bytes of a block */
    BASE_POOL_AHEAD = 2,
    BASE_POOL_AHEAD_LINES = 4, /* of a block: usually all written at once */
    BASE_POOL_MAGAZINE = 30    /* blocks: a magazine takes four cache lines */
};

struct base_magazine {
    struct base_magazine *next; /* in the store */
    size_t n;
    void *block[BASE_POOL_MAGAZINE];
};

/* The magazines of one size that a thread holds. Blocks are taken from and given to `loaded`;
 * `spare` is full or empty. */
struct base_shelf {
    struct base_magazine *loaded, *spare;
};

/* By size, in grains. The initial-exec model reaches them without a call. */
extern _Thread_local struct base_shelf *base_shelves __attribute__((tls_model("initial-exec")));

/* The slow paths, when the thread's magazines do not suffice; sizes in grains. */
void *base_pool_take_more(size_t size);
void base_pool_give_more(void *memory, size_t size);

#if !BASE_POOL_DIRECT
/* Variable sizes, those of tasks, are mostly two lines. */
static inline void pool_prefetch(char *block, size_t bytes)
{
    enum { MOST = BASE_POOL_AHEAD_LINES * BASE_LINE };
    if (!__builtin_constant_p(bytes)) {
        base_prefetch(block);
        base_prefetch(block + bytes - 1);
        return;
    }
    for (size_t line = 0; line < bytes && line < MOST; line += BASE_LINE)
        base_prefetch(block + line);
}

static inline void *pool_take_size(size_t size)
{
    struct base_magazine *loaded = base_shelves[size].loaded;
    if (!loaded || !loaded->n)
        return base_pool_take_more(size);
    /* A block that will be taken soon may lie in another core's cache: fetch it. */
    if (loaded->n > BASE_POOL_AHEAD)
        pool_prefetch(loaded->block[loaded->n - 1 - BASE_POOL_AHEAD], size * BASE_POOL_GRAIN);
    return loaded->block[--loaded->n];
}

static inline void pool_give_size(void *block, size_t size)
{
    struct base_magazine *loaded = base_shelves[size].loaded;
    if (loaded && loaded->n < BASE_POOL_MAGAZINE)
        loaded->block[loaded->n++] = block;
    else
        base_pool_give_more(block, size);
}
#endif

/* size bytes, not cleared, aligned to a cache line if they are whole lines, to 16 bytes if they are
 * a multiple of that, else to 8. NULL without memory. */
static inline void *base_pool_take(size_t bytes)
{
#if !BASE_POOL_DIRECT
    if (bytes <= BASE_POOL_LARGEST)
        return pool_take_size((bytes + BASE_POOL_GRAIN - 1) / BASE_POOL_GRAIN);
#endif
    return base_alloc(bytes);
}

/* Gives back a block that was taken with the same size, on any thread. NULL is fine. */
static inline void base_pool_give(void *block, size_t bytes)
{
#if !BASE_POOL_DIRECT
    if (block && bytes <= BASE_POOL_LARGEST) {
        pool_give_size(block, (bytes + BASE_POOL_GRAIN - 1) / BASE_POOL_GRAIN);
        return;
    }
#else
    (void)bytes;
#endif
    base_free(block);
}

/* A runtime begins, or ends; with the last one all memory goes back. */
void base_pool_enter(void);
void base_pool_leave(void);

/* The calling thread ends: its blocks go to the others. */
void base_pool_thread_end(void);

#pragma GCC visibility pop

#endif
