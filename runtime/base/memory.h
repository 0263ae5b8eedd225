#ifndef DUITE_BASE_MEMORY_H
#define DUITE_BASE_MEMORY_H

#include <stddef.h>

#pragma GCC visibility push(hidden) /* called directly: no program can come in between */

/* All memory of the runtime: large blocks, growing arrays, and a pool of small blocks. */

enum { BASE_LINE = 64 }; /* bytes of a cache line: the alignment of everything allocated here */

/* size bytes, aligned to a cache line; NULL if there are none. Freed by base_free from any thread.
 * From 2 MiB on in large pages, where the system has them. */
void *base_alloc(size_t size);
/* As base_alloc, all zero. */
void *base_alloc_zero(size_t size);
void base_free(void *memory);

/* Makes room for `needed` elements in a growing array: doubles *capacity. Returns the array, which
 * may have moved; NULL without memory, and then nothing has changed. Freed by free. */
void *base_grow(void *array, size_t *capacity, size_t needed, size_t element);

/* Prefetches a line that is written soon: it comes here as this core's own, so that the first
 * write, or an atomic operation behind it, need not wait. */
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
 * between threads. (The general allocator would lock, and a futex costs more than a task.) */

/* size bytes, not cleared, aligned to a cache line if they are whole lines, to 16 bytes if they are
 * a multiple of that, else to 8. NULL without memory. */
void *base_pool_take(size_t size);
/* Gives back what was taken with the same size, on any thread. NULL is fine. */
void base_pool_give(void *memory, size_t size);

/* A runtime begins, and ends; with the last one all memory goes back. */
void base_pool_enter(void);
void base_pool_leave(void);

/* The calling thread ends: what it has at hand goes to the others. */
void base_pool_thread_end(void);

#pragma GCC visibility pop

#endif
