#ifndef DUITE_BASE_MEMORY_H
#define DUITE_BASE_MEMORY_H

#include <stddef.h>

enum { BASE_LINE = 64 }; /* bytes of a cache line: the alignment of everything allocated here */

/* size bytes, aligned to a cache line; NULL if there are none. Freed by base_free from any thread.
 * From 2 MiB on in large pages, where the system has them. */
void *base_alloc(size_t size);
/* As base_alloc, all zero. */
void *base_alloc_zero(size_t size);
void base_free(void *memory);

/* Makes room for `needed` elements in a growing array: doubles *capacity. Returns the array, maybe
 * moved, or NULL and leaves everything as it was. */
void *base_grow(void *array, size_t *capacity, size_t needed, size_t element);

/* Has the line brought to be written soon: taken from another core's cache, where only a read line
 * would be left to it, and the first write, or an atomic operation behind it, would wait. */
static inline void base_prefetch(const void *line)
{
#if defined(__x86_64__)
    /* What __builtin_prefetch makes of it only for the newest processors; others skip it. */
    __asm__ volatile("prefetchw %0" : : "m"(*(const char *)line));
#else
    __builtin_prefetch(line, 1);
#endif
}

#endif
