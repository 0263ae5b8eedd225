/* A free block is in one place: the list of one thread, or a batch in the common store of its size.
 * Batches and chunks are moved under `lock`; it is held for a few instructions, once per BATCH
 * blocks. */
#include "runtime/base/pool.h"

#include "runtime/base/memory.h"

#include <sched.h>
#include <stdatomic.h>

/* The sanitizers must see each block's birth and death. */
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

enum { LARGEST = 24, BATCH = 32, CHUNK_BYTES = 1 << 16 }; /* LARGEST: cache lines of a block */

struct block {
    struct block *next;  /* in a list or batch */
    struct block *batch; /* the next batch; in the first block of a batch */
};

struct chunk {
    struct chunk *next;
};

static atomic_flag lock = ATOMIC_FLAG_INIT;
static struct block *store[LARGEST + 1]; /* batches of BATCH blocks */
static struct chunk *chunks;
static unsigned runtimes;

struct list {
    struct block *first;
    unsigned n;
};
static _Thread_local struct list own[LARGEST + 1];

static void acquire(void)
{
    for (unsigned tries = 1; atomic_flag_test_and_set_explicit(&lock, memory_order_acquire);
         tries++)
        if (tries % 128 == 0)
            sched_yield();
}

static void release(void)
{
    atomic_flag_clear_explicit(&lock, memory_order_release);
}

static size_t lines_of(size_t size)
{
    return size ? (size - 1) / BASE_LINE + 1 : 1;
}

/* Cuts a new chunk into blocks of the calling thread. */
static void cut_chunk(struct list *list, size_t lines)
{
    struct chunk *chunk = base_alloc(CHUNK_BYTES);
    if (!chunk)
        return;
    acquire();
    chunk->next = chunks;
    chunks = chunk;
    release();
    size_t bytes = lines * BASE_LINE;
    char *at = (char *)chunk + BASE_LINE;
    for (; at + bytes <= (char *)chunk + CHUNK_BYTES; at += bytes) {
        struct block *block = (struct block *)(void *)at;
        block->next = list->first;
        list->first = block;
        list->n++;
    }
}

static void refill(struct list *list, size_t lines)
{
    acquire();
    struct block *batch = store[lines];
    if (batch)
        store[lines] = batch->batch;
    release();
    if (!batch) {
        cut_chunk(list, lines);
        return;
    }
    list->first = batch;
    for (list->n = 0; batch; batch = batch->next)
        list->n++;
}

/* Moves up to `n` blocks into the store. */
static void hand_over(struct list *list, size_t lines, unsigned n)
{
    struct block *first = list->first, *last = first;
    if (!first)
        return;
    unsigned moved = 1;
    for (; moved < n && last->next; moved++)
        last = last->next;
    list->first = last->next;
    list->n -= moved;
    last->next = NULL;
    acquire();
    first->batch = store[lines];
    store[lines] = first;
    release();
}

void *base_pool_take(size_t size)
{
    size_t lines = lines_of(size);
    if (DIRECT || lines > LARGEST)
        return base_alloc(size);
    struct list *list = &own[lines];
    if (!list->first)
        refill(list, lines);
    struct block *block = list->first;
    if (!block)
        return NULL;
    list->first = block->next;
    list->n--;
    return block;
}

void base_pool_give(void *memory, size_t size)
{
    size_t lines = lines_of(size);
    if (DIRECT || lines > LARGEST || !memory) {
        base_free(memory);
        return;
    }
    struct list *list = &own[lines];
    struct block *block = memory;
    block->next = list->first;
    list->first = block;
    if (++list->n >= 2 * BATCH)
        hand_over(list, lines, BATCH);
}

void base_pool_enter(void)
{
    acquire();
    runtimes++;
    release();
}

void base_pool_thread_end(void)
{
    for (size_t lines = 1; lines <= LARGEST; lines++)
        while (own[lines].first)
            hand_over(&own[lines], lines, BATCH);
}

void base_pool_leave(void)
{
    base_pool_thread_end();
    acquire();
    struct chunk *chunk = NULL;
    if (--runtimes == 0) {
        chunk = chunks;
        chunks = NULL;
        for (size_t lines = 1; lines <= LARGEST; lines++)
            store[lines] = NULL;
    }
    release();
    while (chunk) {
        struct chunk *next = chunk->next;
        base_free(chunk);
        chunk = next;
    }
}
